// Cells that deform, in scenes and states.
#include "io/state_layout.hpp"
#include "unit/io_state_support.hpp"
#include "unit/io_support.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace eigengrain::io {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::string scene_with(std::string_view periodic, std::string_view rest = "") {
  return fmt::format(R"(
materials: [{{name: grain, density: 2500}}]
contacts: [{{between: [any, any], law: linear, kn: 1e5}}]
balls: [{{position: [0.1, 0.1, 0.1], radius: 5 mm, material: grain}}]
periodic: {}
{}
)",
                     periodic, rest);
}

std::vector<std::string> reported(std::string_view periodic, std::string_view rest = "") {
  return texts_of(mistakes_in(scene_with(periodic, rest)));
}

TEST(VelocityGradient, IsThreeRows) {
  const model::Scene scene = read_scene_text(
      scene_with("{box: [1, 1, 1], velocity_gradient: [[1, 2 1/s, 3], [4, 5, 6], [7, 8, -9]]}"), ".");
  EXPECT_EQ(scene.cell.velocity_gradient, (Mat3() << 1, 2, 3, 4, 5, 6, 7, 8, -9).finished());
  EXPECT_TRUE(scene.cell.rate.isZero(0));
  EXPECT_TRUE(scene.cell.orthogonal());
  EXPECT_TRUE(read_scene_text(scene_with("{box: [1, 1, 1]}"), ".").cell.velocity_gradient.isZero(0));
}

TEST(VelocityGradient, MistakesSayWhatToWrite) {
  EXPECT_THAT(
      reported("{box: [1, 1, 1], axes: [x, y], velocity_gradient: [[0, 1, 0], [0, 0, 0], [0, 0, 0]]}"),
      IsEmpty());
  EXPECT_THAT(
      reported("{box: [1, 1, 1], axes: [x, y], velocity_gradient: [[0, 0, 2], [0, 0, 0], [0, 0, 3]]}"),
      ElementsAre(
          AllOf(HasSubstr("scene.yaml:5: periodic.velocity_gradient: 2 /s in row 1, column 3, and the "
                          "cell does not repeat along z; write 0 there, or add z to axes")),
          HasSubstr("3 /s in row 3, column 3")));
  EXPECT_THAT(reported("{box: [1, 1, 1], velocity_gradient: [[0, 0, 2], [0, 0, 0]]}"),
              ElementsAre(HasSubstr("2 rows; three are wanted")));
  EXPECT_THAT(reported("{box: [1, 1, 1], velocity_gradient: [[0, 0, 2 m], [0, 0, 0], [0, 0, 0]]}"),
              ElementsAre(HasSubstr("a length")));
}

TEST(VelocityGradient, DoesNotGoWithWhatCannotDeform) {
  constexpr std::string_view sheared =
      "{box: [1, 1, 1], velocity_gradient: [[0, 0, 2], [0, 0, 0], [0, 0, 0]]}";
  constexpr std::string_view flat =
      "{box: [1, 1, 1], axes: [x, y], velocity_gradient: [[0, 1, 0], [0, 0, 0], [0, 0, 0]]}";
  EXPECT_THAT(reported(sheared), IsEmpty());
  EXPECT_THAT(reported(sheared, "histories: [{file: energy.csv, every: 1, of: [ledger]}]"),
              ElementsAre(AllOf(HasSubstr("periodic: a cell that deforms"), HasSubstr("energy.csv"),
                                HasSubstr("take out its velocity_gradient"))));
  EXPECT_THAT(reported(sheared, "histories: [{file: energy.csv, every: 1, of: [energies]}]"), IsEmpty());
  EXPECT_THAT(
      reported(flat, "walls: [{polygon: {corners: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}, material: grain}]"),
      ElementsAre(AllOf(HasSubstr("a cell that deforms"), HasSubstr("take planes instead"))));
  EXPECT_THAT(reported(flat, "walls: [{plane: {point: [0, 0, 0], normal: [0, 0, 1]}, material: grain}]"),
              IsEmpty());
  EXPECT_THAT(reported(sheared, "planar: {normal: z}"),
              ElementsAre(HasSubstr("a velocity_gradient along z, across the plane")));
  EXPECT_THAT(reported(flat, "planar: {normal: z}"), IsEmpty());
}

TEST(StateFile, HasACellOnlyWhereItMoved) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  assembly::State state = arbitrary_state(
      read_scene_text(scene_with("{box: [1, 1, 1], velocity_gradient: [[0, 0, 2], [0, 0, 0], [0, 0, 0]]}"),
                      ".", "scene.yaml"));
  write_state(state, file);
  EXPECT_EQ(bits(read_state(file)), bits(state));
  EXPECT_EQ(layout::schema_of(state), 1);
  state.model.cell.edges(0, 2) = 0.125;
  state.model.cell.rate(0, 2) = 2;
  state.list.edges(0, 2) = 0.1;
  write_state(state, file);
  EXPECT_EQ(bits(read_state(file)), bits(state));
  EXPECT_EQ(layout::schema_of(state), 3);
  state.model.cell.edges(1, 1) = std::numeric_limits<double>::infinity();
  write_state(state, file);
  EXPECT_THAT(refusal(file), HasSubstr("/cell/edges is not finite"));
}

}  // namespace
}  // namespace eigengrain::io

#include "io/packing_reader.hpp"
#include "unit/io_support.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace eigengrain::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// Samples that the programs themselves have written (tests/data/imports/README.md).
Packing sample(const std::string& name) {
  return read_packing_file(std::filesystem::path(EIGENGRAIN_TEST_DATA) / "imports" / name);
}

/// The balls of lammps.in after 0.01 s, in the order of their ids: each has flown by (5, 2.5, 1.25) mm, and
/// the third and the fourth through a face of the cell of 0.1 m × 0.08 m.
const std::vector<Vec3> flown{{0.015, 0.0225, 0.03125},
                              {0.055, 0.0225, 0.03125},
                              {0.0035, 0.0425, 0.01125},
                              {0.035, 0, 0.02125},
                              {0.065, 0.0625, -0.00875}};
const std::vector<double> radii{0.005, 0.006, 0.004, 0.00375, 0.005};

void expect_flown(const Packing& packing, double tolerance) {
  ASSERT_EQ(packing.radius.size(), flown.size());
  for (std::size_t i = 0; i < flown.size(); ++i) {
    Vec3 d = packing.position[i] - flown[i];
    // The fourth ends on the face itself: it may stand on either side.
    if (i == 3) d.y() = std::min(std::abs(d.y()), std::abs(d.y() - 0.08));
    EXPECT_LT(d.norm(), tolerance) << i;
    EXPECT_NEAR(packing.radius[i], radii[i], tolerance) << i;
  }
}

TEST(Import, LammpsData) {
  // Ten steps of a sum, with coordinates below 0.1 m: ten roundings of 1e-17 m.
  expect_flown(sample("lammps.data"), 1e-15);
}

TEST(Import, LammpsDumpsEndWithTheirLastFrame) {
  expect_flown(sample("lammps.dump"), 1e-6);  // six digits
  expect_flown(sample("lammps_scaled.dump"), 1e-15);
}

TEST(Import, YadeText) {
  for (const char* name : {"yade_text.txt", "yade_matid.txt", "yade_attrs.txt", "yade_id.txt"}) {
    SCOPED_TRACE(name);
    const Packing packing = sample(name);
    EXPECT_THAT(packing.position,
                ElementsAre(Vec3(0.01, 0.02, 0.03), Vec3(-0.05, 0.333333, 0.03), Vec3(1e-7, 0, 2.5)));
    EXPECT_THAT(packing.radius, ElementsAre(0.005, 0.00625, 0.25));
  }
}

TEST(Import, AnEntryOfBallsTakesThem) {
  const auto balls = [](const std::string& entry) {
    return read_scene_text(
               "materials: [{name: grain, density: 2500}]\n"
               "contacts: [{between: [any, any], law: none}]\n"
               "balls: [{material: grain, " +
                   entry + "}]\n",
               std::filesystem::path(EIGENGRAIN_TEST_DATA) / "imports")
        .bodies.size();
  };
  EXPECT_EQ(balls("file: lammps.data"), 5);
  EXPECT_EQ(balls("file: lammps.data, format: lammps-data"), 5);
  EXPECT_EQ(balls("file: lammps.dump, format: lammps-dump"), 5);
  EXPECT_EQ(balls("file: yade_id.txt, format: yade-text"), 3);
  EXPECT_EQ(balls("file: yade_text.txt, format: packing"), 3);
  EXPECT_THROW(balls("file: lammps.data, format: lammps-dump"), InputError);
}

/// The mistakes in a text, read as the format that it looks like.
std::vector<std::string> mistakes_of(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.write("f", text);
  Diagnostics diagnostics;
  read_packing_file(file, {"scene.yaml", 1}, diagnostics);
  std::vector<std::string> texts = texts_of(diagnostics.mistakes());
  for (std::string& each : texts)
    if (each.starts_with(file.string())) each.replace(0, file.string().size(), "f");
  return texts;
}

std::string data_of(const std::string& atoms, const std::string& style = " # sphere",
                    const std::string& title = "") {
  return "LAMMPS data file" + title +
         "\n\n2 atoms\n1 atom types\n\n0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\nAtoms" + style + "\n\n" +
         atoms + "\nVelocities\n\n1 0 0 0 0 0 0\n2 0 0 0 0 0 0\n";
}

TEST(Import, MistakesInLammpsData) {
  const std::string two = "2 1 0.1 2500 0.5 0.5 0.5\n1 1 0.1 2500 0.2 0.5 0.5 0 1 -1\n";
  EXPECT_THAT(mistakes_of(data_of(two)), ElementsAre());
  EXPECT_THAT(mistakes_of(data_of(two, "")), ElementsAre());
  EXPECT_THAT(mistakes_of(data_of(two, "", ", units = si")), ElementsAre());
  EXPECT_THAT(mistakes_of(data_of("1 1 0.1 2500 0 zero 0\n2 1 0 2500 0 0 0\n")),
              ElementsAre(StartsWith("f:12: y = \"zero\" is not a number"),
                          "f:13: atom 2 has diameter 0, a point without a radius"));
  EXPECT_THAT(mistakes_of(data_of("1 1 -0.1 2500 0 0 0\n1.5 1 0.1 2500 0 0 0\n")),
              ElementsAre("f:12: radius -0.05 m is not positive", StartsWith("f:13: id: ")));
  EXPECT_THAT(mistakes_of(data_of("1 1 0.1 2500 0 0 0\n1 1 0.1 2500 0.5 0 0\n")),
              ElementsAre("f:13: id 1 stands twice, first on line 12"));
  EXPECT_THAT(mistakes_of(data_of("1 1 0.5 0.5 0.5\n2 1 0.1 0.1 0.1\n")),
              ElementsAre(StartsWith("f:12: 5 columns; an atom of style sphere has seven"),
                          StartsWith("f:13: 5 columns")));
  EXPECT_THAT(mistakes_of(data_of("1 1 0.1 2500 0 0 0\n")),
              ElementsAre("f:13: the section Atoms ends after 1 of the 2 atoms that the header counts"));
  EXPECT_THAT(mistakes_of(data_of(two, " # atomic")),
              ElementsAre(StartsWith("f:10: atoms of style \"atomic\", of which no radii can be read")));
  EXPECT_THAT(
      mistakes_of(data_of(two, "", ", units = cgs")),
      ElementsAre("f:1: the file is in units cgs, and lengths are read in m; write it with units si"));
  EXPECT_THAT(mistakes_of("title\n\n2 atoms\n"), ElementsAre("f:3: the file ends without a section Atoms"));
}

std::string dump_of(const std::string& columns, const std::string& atoms, const std::string& start = "") {
  const std::string frame =
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n";
  return start + frame + "ITEM: ATOMS x y z radius\nnot read\n" + frame + "ITEM: ATOMS " + columns + "\n" +
         atoms;
}

TEST(Import, MistakesInLammpsDumps) {
  const std::string two = "0.1 0.1 0.1 0.05\n0.5 0.5 0.5 0.05\n";
  EXPECT_THAT(mistakes_of(dump_of("x y z radius", two)), ElementsAre());
  EXPECT_THAT(mistakes_of(dump_of("xu y zs diameter", two, "ITEM: UNITS\nsi\n")), ElementsAre());
  EXPECT_THAT(
      mistakes_of(dump_of("x y vz mass", two)),
      ElementsAre(
          "f:19: no column z, radius; write the dump as \"dump ID GROUP custom N FILE id x y z radius\""));
  EXPECT_THAT(mistakes_of(dump_of("x y z radius", "0.1 0.1 0.1 0.05\n")),
              ElementsAre("f:20: the last frame ends after 1 of its 2 atoms; was it still being written?"));
  EXPECT_THAT(
      mistakes_of(dump_of("x y z radius", "0.1 0.1 0.1 0\n0.5 0.5 0.5\n")),
      ElementsAre("f:20: radius 0 m is not positive", "f:21: 3 columns, and \"ITEM: ATOMS\" names 4"));
  EXPECT_THAT(mistakes_of(dump_of("id x y z radius", "7 0 0 0 0.1\n7 1 0 0 0.1\n")),
              ElementsAre("f:21: id 7 stands twice, first on line 20"));
  EXPECT_THAT(
      mistakes_of(dump_of("x y z radius", two, "ITEM: UNITS\ncgs\n")),
      ElementsAre("f:2: the file is in units cgs, and lengths are read in m; write it with units si"));
  EXPECT_THAT(mistakes_of("ITEM: NUMBER OF ATOMS\n1\n"),
              ElementsAre("f:1: no frame; a frame begins with \"ITEM: TIMESTEP\""));
  EXPECT_THAT(mistakes_of("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\n"),
              ElementsAre(StartsWith("f:4: the last frame ends without \"ITEM: ATOMS\"")));
  EXPECT_THAT(
      mistakes_of("ITEM: TIMESTEP\n0\nITEM: ATOMS x y z radius\n0 0 0 1\n"),
      ElementsAre(HasSubstr("f:3: the atoms begin, but \"ITEM: NUMBER OF ATOMS\" does not stand before")));
  const std::string tilted =
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp pp pp\n0 1 0\n0 1 0\n0 1 "
      "0\n";
  EXPECT_THAT(mistakes_of(tilted + "ITEM: ATOMS x y z radius\n0 0 0 1\n"), ElementsAre());
  EXPECT_THAT(
      mistakes_of(tilted + "ITEM: ATOMS xs y z radius\n0 0 0 1\n"),
      ElementsAre("f:9: coordinates scaled by a tilted box, which cannot be read; write x y z instead"));
}

TEST(Import, MistakesInYadeText) {
  EXPECT_THAT(mistakes_of("#format x_y_z_r\n0 0 0 1 2\n0 0 0 0\n"),
              ElementsAre("f:2: 5 columns; format x_y_z_r has 4", "f:3: radius 0 m is not positive"));
  EXPECT_THAT(mistakes_of("#format x_y_z_r_attrs\n0 0 0\n0 0 0 1 2 3\n"),
              ElementsAre("f:2: 3 columns; format x_y_z_r_attrs has 4 or more"));
  EXPECT_THAT(mistakes_of("#format id_x_y_z_r_matId\n0 0 a 0 1 0\n"),
              ElementsAre(StartsWith("f:2: y = \"a\" is not")));
  EXPECT_THAT(mistakes_of("#format x_y_z_r_clumpId\n0 0 0 1 0\n"),
              ElementsAre(StartsWith("f:1: format \"x_y_z_r_clumpId\" cannot be read")));
  EXPECT_THAT(mistakes_of("#format x_y_z_r\n"),
              ElementsAre(HasSubstr("holds no balls; a line is x y z r, behind a first line")));
  Diagnostics diagnostics;
  const TemporaryFolder folder;
  const auto file = folder.write("f", "0 0 0 1\n");
  read_packing_file(file, {"scene.yaml", 1}, diagnostics, PackingFormat::yade_text);
  EXPECT_THAT(texts_of(diagnostics.mistakes()),
              ElementsAre(HasSubstr("f:1: the first line is not the name of a format")));
}

}  // namespace
}  // namespace eigengrain::io

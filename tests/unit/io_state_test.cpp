#include "unit/io_state_support.hpp"

#include <fmt/format.h>
#include <mpi.h>
#include <sys/resource.h>

#include <csignal>
#include <set>
#include <variant>

namespace eigengrain::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> names_in(const TemporaryFolder& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    names.push_back(entry.path().filename().string());
  return names;
}

TEST(StateFile, EveryBitComesBack) {
  const TemporaryFolder folder;
  for (const bool turns : {true, false}) {
    const assembly::State state = arbitrary_state(busy(), turns);
    const auto file = folder.path() / "state.h5";
    write_state(state, file);
    EXPECT_TRUE(is_state_file(file));
    const assembly::State back = read_state(file);
    EXPECT_EQ(bits(back), bits(state));
    EXPECT_EQ(back.turns(), turns);
    EXPECT_EQ(back.settings.bodies.size(), 0);
    EXPECT_EQ(names_in(folder), std::vector<std::string>{"state.h5"});
  }
}

/// The scene is there to have several kinds; if it had not, the test above would prove less than it says.
TEST(StateFile, TheSceneOfTheseTestsHasContactsWithHistoryAndWithout) {
  const assembly::State state = arbitrary_state(busy());
  std::set<std::size_t> kinds;
  std::set<std::int32_t> rules;
  bool images = false;
  for (const contact::AnyGroup& group : state.model.contacts.groups) {
    kinds.insert(group.index());
    std::visit(
        [&](const auto& concrete) {
          rules.insert(concrete.rule);
          for (const contact::Pair& pair : concrete.pairs) images = images || pair.image != model::Image{};
        },
        group);
  }
  // With history and without, each of balls, planes and facets; io_state_laws_test.cpp has all laws.
  EXPECT_EQ(kinds.size(), 6U);
  EXPECT_EQ(rules, (std::set<std::int32_t>{0, 2, 3}));
  EXPECT_TRUE(images);
}

TEST(StateFile, WrittenAgainIsTheSameFile) {
  const TemporaryFolder folder;
  write_state(arbitrary_state(busy()), folder.path() / "first.h5");
  write_state(read_state(folder.path() / "first.h5"), folder.path() / "second.h5");
  std::string first = contents(folder.path() / "first.h5");
  std::string second = contents(folder.path() / "second.h5");
  ASSERT_EQ(first.size(), second.size());
  // The date, and the checksum with it.
  std::size_t differing = 0;
  for (std::size_t k = 0; k + 20 < first.size(); ++k) differing += first[k] != second[k] ? 1 : 0;
  EXPECT_LE(differing, 4U);
}

TEST(StateFile, SettingsTravelAsTheDocument) {
  const model::Scene scene = busy({"run.steps=7", "gravity=[0, 0, 0]"});
  EXPECT_THAT(scene.document, AllOf(HasSubstr(R"("steps": "7")"), testing::Not(HasSubstr("balls"))));
  const TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  write_state(arbitrary_state(scene), file);
  const model::Scene back = read_state(file).settings;
  EXPECT_EQ(back.document, scene.document);
  EXPECT_EQ(back.name, "busy.yaml");
  EXPECT_EQ(back.run.steps, 7);
  EXPECT_EQ(back.gravity, Vec3::Zero());
  EXPECT_EQ(back.materials.at(2).name, "glue \"°\" \\");
  EXPECT_EQ(back.materials.at(0).density, 2650);
  EXPECT_EQ(back.timestep.dt, 1e-5);
  EXPECT_EQ(back.run.unbalanced, 1e-5);
}

TEST(StateFile, OverridesAct) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  const assembly::State state = arbitrary_state(busy());
  write_state(state, file);
  const std::vector<std::string> overrides{"run.steps=20000", "contacts.0.kn=3e5", "damping.local=0",
                                           "gravity=[0, 0, 0]"};
  const assembly::State changed = read_state(file, overrides);
  EXPECT_EQ(changed.settings.run.steps, 20000);
  EXPECT_EQ(changed.settings.contacts[0].parameters[0], 3e5);
  EXPECT_EQ(changed.model.gravity, Vec3::Zero());
  EXPECT_EQ(changed.model.local_damping, 0);
  EXPECT_EQ(bytes_of(changed.model.bodies.position), bytes_of(state.model.bodies.position));
  bool found = false;
  for (const contact::AnyGroup& group : changed.model.contacts.groups)
    if (const auto* sand = std::get_if<contact::ContactGroup<contact::BallBall, contact::Linear>>(&group);
        sand != nullptr && sand->rule == 0) {
      found = true;
      EXPECT_EQ(sand->law.stiffness(contact::ContactMotion{}, contact::Linear::State{}).normal, 3e5);
      EXPECT_EQ(sand->states.at(0).shear, Vec3(1.0 / 3, -0.0, 1e-310));
    }
  EXPECT_TRUE(found);
  // They are a part of what the next state says.
  write_state(changed, file);
  EXPECT_EQ(read_state(file).settings.run.steps, 20000);
}

template <class Group>
const Group& group_of_rule(const assembly::State& state, std::int32_t rule) {
  for (const contact::AnyGroup& group : state.model.contacts.groups)
    if (const auto* found = std::get_if<Group>(&group); found != nullptr && found->rule == rule)
      return *found;
  throw std::runtime_error("no such group");
}

/// Packings are often made without friction, which then comes on.
TEST(StateFile, FrictionMayBeSwitchedOnAndOff) {
  using Frictional = contact::ContactGroup<contact::BallBall, contact::Linear>;
  using Frictionless = contact::ContactGroup<contact::BallBall, contact::LinearFrictionless>;
  const TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  write_state(arbitrary_state(busy()), file);
  const std::vector<std::string> off{"contacts.0.friction=0"};
  const std::size_t contacts = group_of_rule<Frictional>(read_state(file), 0).pairs.size();
  EXPECT_EQ(group_of_rule<Frictionless>(read_state(file, off), 0).pairs.size(), contacts);

  const std::vector<std::string> on{"contacts.3.friction=0.5", "contacts.3.ks=1e5"};
  const assembly::State rough = read_state(file, on);
  const auto& group = group_of_rule<Frictional>(rough, 3);
  const contact::Placement placement = rough.model.placement();
  ASSERT_FALSE(group.pairs.empty());
  for (std::size_t c = 0; c < group.pairs.size(); ++c) {
    const contact::ContactGeometry geometry = contact::BallBall::geometry(placement, group.pairs[c]);
    EXPECT_EQ(group.states[c].shear, Vec3::Zero());
    EXPECT_EQ(group.states[c].normal, geometry.overlap > 0 ? geometry.normal : Vec3::Zero().eval());
  }
}

/// Dashpots come and go without the shear forces that hold a packing.
TEST(StateFile, DashpotsAndRollingMayBeSwitchedOnAndOff) {
  using Plain = contact::ContactGroup<contact::BallBall, contact::Linear>;
  using WithDashpots = contact::ContactGroup<contact::BallBall, contact::DampedLinear>;
  using WithRolling = contact::ContactGroup<contact::BallBall, contact::RollingLinear>;
  const TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  write_state(arbitrary_state(busy()), file);
  const Plain written = group_of_rule<Plain>(read_state(file), 0);
  ASSERT_FALSE(written.pairs.empty());
  const auto expect_kept = [&](const auto& group) {
    ASSERT_EQ(group.states.size(), written.states.size());
    for (std::size_t c = 0; c < group.states.size(); ++c) {
      EXPECT_EQ(group.states[c].shear, written.states[c].shear);
      EXPECT_EQ(group.states[c].normal, written.states[c].normal);
    }
  };
  const std::vector<std::string> dashpots{"contacts.0.beta_n=0.2"};
  const assembly::State damped = read_state(file, dashpots);
  expect_kept(group_of_rule<WithDashpots>(damped, 0));
  for (const auto& state : group_of_rule<WithDashpots>(damped, 0).states)
    EXPECT_EQ(state.viscous, Vec3::Zero());
  const std::vector<std::string> rolling{"contacts.0.kr=1e-3", "contacts.0.rolling_friction=0.1"};
  expect_kept(group_of_rule<WithRolling>(read_state(file, rolling), 0));

  const auto second = folder.path() / "damped.h5";
  write_state(damped, second);
  const std::vector<std::string> off{"contacts.0.beta_n=0"};
  expect_kept(group_of_rule<Plain>(read_state(second, off), 0));
}

/// Contacts with a wall that comes near are not in the list that was made before.
TEST(StateFile, AWallThatMovesMeetsItsBalls) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  assembly::State state = arbitrary_state(busy());
  state.list.skin = 1e-4;
  write_state(state, file);
  const std::vector<std::string> same{"walls.1.plane.point=[5, 0, 1]"};
  const std::vector<std::string> nearer{"walls.1.plane.point=[0, 6 mm, 0]"};
  const assembly::State moved = read_state(file, nearer);
  EXPECT_EQ(moved.list.rebuilds, state.list.rebuilds + 1);
  EXPECT_GT(moved.model.contacts.size(), 0);
  EXPECT_EQ(bytes_of(moved.list.position), bytes_of(moved.model.bodies.position));
  EXPECT_EQ(read_state(file).list.rebuilds, state.list.rebuilds);
}

TEST(StateFile, OverridesThatPullTheGroundAway) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  write_state(arbitrary_state(busy()), file);
  const auto says = [&](std::string override) { return refusal(file, {std::move(override)}); };
  EXPECT_THAT(says("balls.0.radius=1"),
              AllOf(HasSubstr("--set balls.0.radius=1: "), HasSubstr("a state has its balls already")));
  EXPECT_THAT(says("balls=[]"), HasSubstr("a state has its balls already"));
  EXPECT_THAT(says("materials=[{name: sand, density: 2650}]"), HasSubstr("keep their number"));
  EXPECT_THAT(says("materials=[{name: sand, density: 2650}, {name: ice, density: 917}, {name: \"glue "
                   "\\\"°\\\" \\\\\", density: 1200}, {name: steel}, {name: more}]"),
              HasSubstr("keep their number"));
  EXPECT_THAT(says("materials.0.density=1000"),
              AllOf(HasSubstr("materials[0].density"), HasSubstr("masses")));
  EXPECT_THAT(says("contacts.0.law=none"), HasSubstr("contacts"));
  EXPECT_THAT(says("contacts.0={between: [sand, sand], law: none}"),
              AllOf(HasSubstr("state.h5: contacts[0]: law none"), HasSubstr("law linear")));
  EXPECT_THAT(says("contacts=[{between: [any, any], law: linear, kn: 1e5}]"),
              AllOf(HasSubstr("contacts[2]"), HasSubstr("only 1 entries")));
  EXPECT_THAT(says("contacts.0.between=[steel, steel]"), HasSubstr("keep the entries of contacts"));
  EXPECT_THAT(says("walls=[]"), HasSubstr("walls: 0 planes"));
  EXPECT_THAT(refusal(file, {"periodic.axes=[x, y]", "walls.1.plane.normal=[0, 0, 1]"}),
              HasSubstr("other axes"));
  EXPECT_THAT(says("run.stepz=3"), AllOf(HasSubstr("--set run.stepz=3: run.stepz: unknown key")));
  EXPECT_THAT(says("timestep.dt=-1"), HasSubstr("out of range"));
}

TEST(StateFile, BallsMayHavePassedAWallOrMetEachOther) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  assembly::State state = arbitrary_state(busy());
  state.model.bodies.position[0].z() = -1;
  state.model.bodies.position[1] = state.model.bodies.position[2];
  write_state(state, file);
  EXPECT_EQ(bits(read_state(file)), bits(state));
}

TEST(StateFile, AFailedWriteLeavesTheOldFile) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  const assembly::State state = arbitrary_state(busy());
  write_state(state, file);
  const std::string before = contents(file);

  // As a full disk would, a limit on the size of files makes writing fail.
  rlimit old{};
  ::getrlimit(RLIMIT_FSIZE, &old);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const rlim_t limit : {std::size_t{0}, before.size() / 2, before.size() - 5}) {
    const rlimit low{limit, old.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &low);
    EXPECT_ANY_THROW(write_state(state, file)) << limit;
    ::setrlimit(RLIMIT_FSIZE, &old);
    EXPECT_EQ(contents(file), before);
    EXPECT_EQ(names_in(folder).size(), 1U);
  }
  std::signal(SIGXFSZ, handler);
  write_state(state, file);
  EXPECT_EQ(bits(read_state(file)), bits(state));
}

std::string write_refusal(const assembly::State& state, const std::filesystem::path& file) {
  try {
    write_state(state, file);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(StateFile, PlacesThatCannotBeWritten) {
  const TemporaryFolder folder;
  const assembly::State state = arbitrary_state(busy());
  EXPECT_THAT(write_refusal(state, folder.path() / "nowhere" / "state.h5"),
              AllOf(HasSubstr("nowhere/state.h5: cannot be written"), HasSubstr("make it first")));
  EXPECT_THAT(write_refusal(state, folder.path()), HasSubstr("Is a directory"));
  assembly::State without_document = state;
  without_document.settings.document.clear();
  EXPECT_THAT(write_refusal(without_document, folder.path() / "state.h5"), HasSubstr("no settings to write"));
  EXPECT_THAT(names_in(folder), IsEmpty());
}

TEST(StateFile, NextToMpi) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "MPI's own memory is not ours to judge";
#endif
  const TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  const assembly::State state = arbitrary_state(busy());
  int started = 0;
  MPI_Initialized(&started);
  write_state(state, file);
  if (started == 0) MPI_Init(nullptr, nullptr);
  EXPECT_EQ(bits(read_state(file)), bits(state));
  write_state(state, file);
  if (started == 0) MPI_Finalize();
  EXPECT_EQ(bits(read_state(file)), bits(state));
}

/// Texts that need care in JSON or in YAML, as names of materials.
TEST(SceneDocument, IsReadAgainAsTheSameDocument) {
  for (const std::string_view name :
       {"a\\tb", "a\\nb", "a\\x01b", "a\\x7Fb",     "a\\\\",   "\\\"",    "null",    "~",   "true", "1e5",
        "{",     "[a]",   "#",       "a: b",        "a, b",    "- a",     "&a",      "*a",  "!x",   "%",
        "@",     "`",     "\\u00e9", "\\U0001F600", "\\u0085", "\\u2028", "\\ufeff", " a ", "a\\0b"}) {
    const std::string yaml = fmt::format(
        "materials: [{{name: \"{0}\", density: 1}}]\n"
        "contacts: [{{between: [any, any], law: linear, kn: 1, tension: true}}]\n"
        "balls: [{{position: [0, 0, 0], radius: 1, material: \"{0}\"}}]\n",
        name);
    SCOPED_TRACE(yaml);
    const model::Scene scene = read_scene_text(yaml, ".");
    const std::vector<std::string> balls{R"(balls=[{position: [0, 0, 0], radius: 1, material: ")" +
                                         std::string(name) + "\"}]"};
    const model::Scene again = read_scene_text(scene.document, ".", "again", balls);
    EXPECT_EQ(again.document, scene.document);
    EXPECT_EQ(again.materials[0].name, scene.materials[0].name);
    EXPECT_EQ(again.contacts[0].parameters, scene.contacts[0].parameters);
  }
}

}  // namespace
}  // namespace eigengrain::io

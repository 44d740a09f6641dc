// States of every law: what its contacts remember comes back to the bit.
#include "eigengrain/contact/laws.hpp"

#include "unit/io_state_support.hpp"

#include <set>

namespace eigengrain::io {
namespace {

/// A ball on a floor and one on top of it, with a law.
model::Scene stack(const std::string& law) {
  return read_scene_text(fmt::format(R"(materials: [{{name: grain, density: 2500}}]
contacts: [{{between: [any, any], law: {}}}]
balls:
  - {{position: [0, 0, 4.99 mm], radius: 5 mm, material: grain}}
  - {{position: [0, 0, 14.97 mm], radius: 5 mm, material: grain}}
walls: [{{plane: {{point: [0, 0, 0], normal: [0, 0, 1]}}, material: grain}}]
)",
                                     law),
                         ".", "stack.yaml");
}

/// Numbers that no law would come to, in every part of every contact's state.
void scramble(assembly::State& state) {
  double value = 1.0 / 3;
  state.model.contacts.for_each_group([&](auto& group) {
    using Group = std::decay_t<decltype(group)>;
    if constexpr (!std::is_empty_v<typename Group::State>)
      for (auto& contact : group.states) {
        std::vector<double> numbers(contact::state_numbers(Group::LawType::state_fields));
        for (double& number : numbers) number = value = 1.1 * value + 1e-3;
        std::memcpy(std::as_writable_bytes(std::span(&contact, 1)).data(), numbers.data(), sizeof contact);
      }
  });
}

template <class... Laws>
constexpr std::size_t count_of(TypeList<Laws...> /*laws*/) {
  return sizeof...(Laws);
}

TEST(StateFile, HoldsTheHistoryOfEveryLaw) {
  const TemporaryFolder folder;
  std::set<std::size_t> kinds;
  for (const std::string law :
       {"linear, kn: 1e5", "linear, kn: 1e5, ks: 5e4, friction: 0.5",
        "linear, kn: 1e5, ks: 5e4, friction: 0.5, beta_n: 0.2",
        "linear, kn: 1e5, ks: 5e4, friction: 0.5, kr: 1e-3, rolling_friction: 0.1",
        "hertz, effective_young: 1 MPa, effective_shear: 0.3 MPa, friction: 0.5, restitution: 0.8",
        "hertz, effective_young: 1 MPa, effective_shear: 0.3 MPa, friction: 0.5, kr: 1e-3, rolling_friction: "
        "0.1",
        "hysteretic, kn: 1e5, restitution: 0.5, ks: 1e5, friction: 0.4"}) {
    assembly::State state = arbitrary_state(stack(law));
    scramble(state);
    const auto file = folder.path() / "state.h5";
    write_state(state, file);
    EXPECT_EQ(bits(read_state(file)), bits(state)) << law;
    EXPECT_EQ(state.model.contacts.size(), 2) << law;
    for (const contact::AnyGroup& group : state.model.contacts.groups) kinds.insert(group.index());
  }
  EXPECT_EQ(kinds.size(), 2 * count_of(contact::LawTypes{}));  // at a ball and at a wall
}

}  // namespace
}  // namespace eigengrain::io

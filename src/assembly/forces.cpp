#include "eigengrain/assembly/forces.hpp"

#include "eigengrain/assembly/dissipation.hpp"
#include "eigengrain/assembly/state.hpp"
#include "eigengrain/assembly/surroundings.hpp"
#include "eigengrain/base/assert.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/contact/facet_choice.hpp"
#include "eigengrain/contact/orientation.hpp"

#include "flat.hpp"
#include "force_kernel.hpp"
#include "processor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>

namespace eigengrain::assembly {
namespace {

/// A trial state with vectors of its own.
struct TrialState {
  TrialState(const Model& model, const Displacement& displacement) : moved(displacement) {
    position.reserve(model.bodies.position.size());
    for (std::size_t i = 0; i < model.bodies.position.size(); ++i)
      position.emplace_back(model.bodies.position[i] + displacement.translation[i]);
    orientation = turned_orientations(model.bodies, displacement.rotation);
  }
  Trial trial() const { return {position, moved.translation, moved.rotation, 1.0, orientation}; }

  const Displacement& moved;
  std::vector<Vec3> position;
  std::vector<Quat> orientation;
};

Displacement no_displacement(const Model& model) {
  return {std::vector<Vec3>(model.bodies.position.size(), Vec3::Zero()), {}};
}

template <class Group>
BondBreak break_of(const Group& group, std::size_t c, const model::Bodies& bodies,
                   const contact::Placement& placement, const contact::ContactGeometry& geometry,
                   std::optional<contact::BreakMode> mode) {
  EIGENGRAIN_ASSERT(mode.has_value());
  const auto a = static_cast<std::size_t>(group.pairs[c].a);
  const auto b = static_cast<std::size_t>(group.pairs[c].b);
  BondBreak found{.first = bodies.identity[a],
                  .second = bodies.identity[b],
                  .place = placement.position[a] + geometry.lever_a,
                  .normal = geometry.normal,
                  .mode = mode.value_or(contact::BreakMode::tension),
                  .rule = group.rule};
  return found;
}

/// Bodies of a chunk: few enough for the caches and for several threads, many enough that most contacts stay
/// inside. A function of the number of bodies alone.
std::int64_t chunk_of_bodies(std::int64_t bodies) {
  return std::clamp<std::int64_t>(bodies / 16, 128, 2048);
}

/// Whether a kernel evaluates the contacts of a group (force_kernel.hpp).
template <class Group>
inline constexpr bool in_packs = std::is_same_v<typename Group::KinematicsType, contact::BallBall>&&
                                     contact::takes_packs<typename Group::LawType> &&
                                 !contact::BondLaw<typename Group::LawType>;

/// Of the mean radius: gap up to which contacts are evaluated with those that touch. A tenth of the usual
/// skin: then gaps are measured ten times in the life of a list, and a tenth of the pairs that are apart is
/// evaluated in vain.
constexpr double margin_of_radius = 0.005;

constexpr std::int64_t chunk_of_packing = 1024;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Whether a state is another than that of surfaces which never touched, bit by bit. Written out: as a call
/// of memcmp it took as long as all the rest of a selection.
template <class State>
bool remembers(const State& state) {
  if constexpr (std::is_empty_v<State>) return false;
  static_assert(sizeof(State) % sizeof(std::uint64_t) == 0 || std::is_empty_v<State>);
  using Words = std::array<std::uint64_t, std::max<std::size_t>(1, sizeof(State) / sizeof(std::uint64_t))>;
  const State never{};
  Words of_state{};
  Words of_never{};
  std::memcpy(of_state.data(), &state, sizeof(State));
  std::memcpy(of_never.data(), &never, sizeof(State));
  std::uint64_t differs = 0;
  for (std::size_t k = 0; k < of_state.size(); ++k) differs |= of_state[k] ^ of_never[k];
  return differs != 0;
}

/// Largest number of edges along one axis between a body and an image that it may touch.
double farthest_image(const Model& model) {
  int farthest = 0;
  model.contacts.for_each_group([&](const auto& group) {
    if constexpr (std::decay_t<decltype(group)>::KinematicsType::second_is_body)
      for (const contact::Pair& pair : group.pairs)
        for (const std::int8_t edges : pair.image) farthest = std::max(farthest, std::abs(int{edges}));
  });
  return farthest;
}

/// Calls visit(c, corner, body) for the corners of all triangles in a group that are bodies.
template <class Group, class Visit>
void for_each_skin_corner(const Model& model, const Group& group, const Visit& visit) {
  if constexpr (std::is_same_v<typename Group::KinematicsType, contact::BallFacet>)
    for (std::size_t c = 0; c < group.pairs.size(); ++c) {
      const std::int32_t facet = group.pairs[c].b;
      if (!model.facets.deforms(facet)) continue;
      const auto& vertex = model.facets.facet[static_cast<std::size_t>(facet)].vertex;
      for (std::size_t k = 0; k < 3; ++k) visit(c, k, model.facets.body[static_cast<std::size_t>(vertex[k])]);
    }
}

/// A thread's sums of the chunk that it works on: they stay in the processor's cache from one chunk to the
/// next.
kernel::BodySum* zeroed_sums(std::int64_t bodies) {
  thread_local std::vector<kernel::BodySum> sums;
  sums.assign(static_cast<std::size_t>(bodies), {});
  return sums.data();
}

}  // namespace

namespace kernel {

extern const ForceKernel force_kernel_baseline;
#ifdef EIGENGRAIN_KERNEL_AVX2
extern const ForceKernel force_kernel_avx2;
#endif

const ForceKernel& best_force_kernel() {
#ifdef EIGENGRAIN_KERNEL_AVX2
  if (runs_avx2_kernels()) return force_kernel_avx2;
#endif
  return force_kernel_baseline;
}

}  // namespace kernel

std::vector<Quat> turned_orientations(const model::Bodies& bodies, std::span<const Vec3> rotation) {
  std::vector<Quat> result = bodies.orientation;
  if (!rotation.empty())
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = contact::turned(result[i], rotation[i]);
  return result;
}

ContactForceSum::ContactForceSum(const Model& model, bool turns) : turns_(turns) {
  const std::int64_t bodies = model.bodies.size();
  chunk_size_ = chunk_of_bodies(bodies);
  const std::int64_t chunks = (bodies + chunk_size_ - 1) / chunk_size_;
  const auto elsewhere = [&](const contact::Pair& pair) {
    return pair.a / chunk_size_ != pair.b / chunk_size_;
  };

  foreign_starts_.assign(static_cast<std::size_t>(bodies) + 1, 0);
  model.contacts.for_each_group([&](const auto& group) {
    if constexpr (std::decay_t<decltype(group)>::KinematicsType::second_is_body)
      for (const contact::Pair& pair : group.pairs)
        if (elsewhere(pair)) ++foreign_starts_[static_cast<std::size_t>(pair.b) + 1];
    for_each_skin_corner(model, group, [&](std::size_t, std::size_t, std::int32_t body) {
      ++foreign_starts_[static_cast<std::size_t>(body) + 1];
    });
  });
  for (std::size_t i = 0; i < static_cast<std::size_t>(bodies); ++i)
    foreign_starts_[i + 1] += foreign_starts_[i];
  foreign_.resize(static_cast<std::size_t>(foreign_starts_.back()));

  std::vector<std::int32_t> next(foreign_starts_.begin(), foreign_starts_.end() - 1);
  model.contacts.for_each_group([&](const auto& group) {
    using Group = std::decay_t<decltype(group)>;
    GroupPlan& plan = plans_.emplace_back();
    const auto& pairs = group.pairs;
    EIGENGRAIN_ASSERT(std::is_sorted(pairs.begin(), pairs.end(), [](auto l, auto r) { return l.a < r.a; }));
    for (std::int64_t chunk = 0; chunk <= chunks; ++chunk) {
      const auto first = std::partition_point(pairs.begin(), pairs.end(),
                                              [&](const auto& pair) { return pair.a < chunk * chunk_size_; });
      plan.starts.push_back(first - pairs.begin());
    }
    if constexpr (Group::KinematicsType::second_is_body)
      for (const contact::Pair& pair : pairs)
        plan.slot.push_back(elsewhere(pair) ? next[pair.b]++ : kernel::own_chunk);
    for_each_skin_corner(model, group, [&](std::size_t c, std::size_t corner, std::int32_t body) {
      plan.skin_slot.resize(pairs.size());
      plan.skin_slot[c][corner] = next[static_cast<std::size_t>(body)]++;
    });
    if constexpr (contact::BondLaw<typename Group::LawType>)
      plan.broken.resize(static_cast<std::size_t>(chunks));
    if constexpr (in_packs<Group>) {
      plan.candidates.resize(static_cast<std::size_t>(chunks));
      places_.resize(static_cast<std::size_t>(bodies));
      if (!std::is_empty_v<typename Group::State>) motions_.resize(static_cast<std::size_t>(bodies));
    }
  });
  const std::vector<double>& radius = model.bodies.radius;
  if (!places_.empty()) {
    const auto balls = std::ssize(radius) - std::ranges::count(radius, 0.0);  // nodes have no radius
    margin_ =
        margin_of_radius * std::accumulate(radius.begin(), radius.end(), 0.0) / static_cast<double>(balls);
  }
}

ContactForceSum::~ContactForceSum() = default;
ContactForceSum::ContactForceSum(ContactForceSum&&) noexcept = default;
ContactForceSum& ContactForceSum::operator=(ContactForceSum&&) noexcept = default;

void ContactForceSum::pack_bodies(const Model& model, const Trial& trial) {
  if (places_.empty()) return;
  const bool moves = !motions_.empty();
  const bool spins = !trial.spin.empty();
  const std::int64_t bodies = model.bodies.size();
  ways_.resize(static_cast<std::size_t>((bodies + chunk_of_packing - 1) / chunk_of_packing));
  for_chunks(bodies, chunk_of_packing, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
    double farthest = 0;
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
      const Vec3& x = trial.position[i];
      kernel::BodyPlace& place = places_[i];
      const Vec3 step = x - Eigen::Map<const Vec3>(place.x);
      const double growth = model.bodies.radius[i] - place.radius;
      const double squared = step.squaredNorm() + growth * growth;
      if (!(squared <= farthest)) farthest = std::isnan(squared) ? infinity : squared;
      place = {{x.x(), x.y(), x.z()}, model.bodies.radius[i]};
      if (!moves) continue;
      const Vec3& v = trial.velocity[i];
      const Vec3 w = spins ? trial.spin[i] : Vec3(Vec3::Zero());
      motions_[i] = {{v.x(), v.y(), v.z()}, model.bodies.mass[i], {w.x(), w.y(), w.z()}, 0};
    }
    ways_[static_cast<std::size_t>(chunk)] = std::sqrt(farthest);
  });
  // A step and a growth of the radius each bring two bodies nearer; both are at most √2 of the root of
  // squares.
  way_ += 2 * std::numbers::sqrt2 * *std::ranges::max_element(ways_);
  if (trial.cell_step != nullptr)  // the edges carry images along
    way_ += farthest_image(model) * trial.cell_step->colwise().norm().sum();
  selects_ = !(way_ < margin_);
  if (selects_) way_ = infinity;  // until it is done
}

template <class Group>
void ContactForceSum::select_candidates(GroupPlan& plan, const Group& group, const Model& model,
                                        const Chunk& chunk) {
  const auto at = static_cast<std::size_t>(chunk.index);
  std::vector<kernel::Candidate>& candidates = plan.candidates[at];
  candidates.clear();
  // What is added in a while, and what rounding adds to that.
  const double reach = (1 + 1e-6) * margin_;
  for (auto c = static_cast<std::size_t>(plan.starts[at]); c < static_cast<std::size_t>(plan.starts[at + 1]);
       ++c) {
    const contact::Pair& pair = group.pairs[c];
    const kernel::BodyPlace& a = places_[static_cast<std::size_t>(pair.a)];
    const kernel::BodyPlace& b = places_[static_cast<std::size_t>(pair.b)];
    const Vec3 branch =
        Eigen::Map<const Vec3>(b.x) - Eigen::Map<const Vec3>(a.x) + model.cell.shift(pair.image);
    const double far = a.radius + b.radius + reach;
    if (branch.squaredNorm() > far * far && !remembers(group.states[c])) {
      if (plan.slot[c] != kernel::own_chunk) foreign_[static_cast<std::size_t>(plan.slot[c])] = {};
      continue;
    }
    candidates.push_back({static_cast<std::int32_t>(c), pair.a, pair.b, plan.slot[c]});
  }
}

template <bool commit, class Group>
void ContactForceSum::sum_group(GroupPlan& plan, Group& group, const Model& model,
                                const contact::Placement& placement, const Trial& trial, const Chunk& chunk) {
  if constexpr (commit && in_packs<Group>) {
    if (selects_) select_candidates(plan, group, model, chunk);
    const model::PeriodicCell& cell = model.cell;
    const bool repeats = cell.periodic[0] || cell.periodic[1] || cell.periodic[2];
    const kernel::Work work{.places = places_.data(),
                            .motions = motions_.data(),
                            .cell = repeats ? &cell : nullptr,
                            .cell_step = trial.cell_step,
                            .duration = trial.duration,
                            .per_second = trial.per_second,
                            .lever_cut = placement.lever_cut,
                            .turns = turns_,
                            .candidates = plan.candidates[static_cast<std::size_t>(chunk.index)],
                            .first_body = static_cast<std::int32_t>(chunk.first_body),
                            .sums = chunk.sums,
                            .foreign = foreign_.data()};
    std::get<kernel::Advance<typename Group::LawType>>(kernel::best_force_kernel())(group, work);
  } else if constexpr (commit && !std::is_same_v<typename Group::KinematicsType, contact::BallFacet>) {
    // In one flat piece: the cycle spends its time here.
    [&]() EIGENGRAIN_FLAT { sum_one_by_one<commit>(plan, group, model.bodies, placement, trial, chunk); }();
  } else {
    sum_one_by_one<commit>(plan, group, model.bodies, placement, trial, chunk);
  }
}

template <bool commit, class Group>
void ContactForceSum::sum_one_by_one(GroupPlan& plan, Group& group, const model::Bodies& bodies,
                                     const contact::Placement& placement, const Trial& trial,
                                     const Chunk& chunk) {
  using Kinematics = typename std::decay_t<Group>::KinematicsType;
  using ContactState = typename std::decay_t<Group>::State;
  using Law = typename std::decay_t<Group>::LawType;
  const auto at = static_cast<std::size_t>(chunk.index);
  const auto add = [this](kernel::BodySum& sum, const Vec3& force, const Vec3& moment) {
    Eigen::Map<Vec3>(sum.force) += force;
    if (turns_) Eigen::Map<Vec3>(sum.moment) += moment;
  };
  for (std::int64_t index = plan.starts[at]; index < plan.starts[at + 1]; ++index) {
    const auto c = static_cast<std::size_t>(index);
    const contact::Pair& pair = group.pairs[c];
    const auto& old = group.states[c];
    if constexpr (Kinematics::second_is_body)
      if (const std::int32_t slot = plan.slot[c]; slot != kernel::own_chunk)
        foreign_[static_cast<std::size_t>(slot)] = {};
    const bool on_skin = contact::on_skin<Kinematics>(placement, pair);
    if (on_skin)
      for (const std::int32_t slot : plan.skin_slot[c]) foreign_[static_cast<std::size_t>(slot)] = {};
    const contact::ContactGeometry geometry = Kinematics::geometry(placement, pair);
    if (!group.law.acts(contact::at_rest(geometry), old)) {
      if constexpr (commit) group.states[c] = ContactState{};
      continue;
    }
    ContactState next;
    const auto motion = motion_in<Kinematics>(group.law, placement, trial, pair, geometry);
    const contact::ContactForce f = group.law.evaluate(motion, old, next);
    if constexpr (commit && contact::BondLaw<Law>)
      if (old.bonded() && !next.bonded())
        plan.broken[at].push_back(
            break_of(group, c, bodies, placement, geometry, group.law.failure(motion, old)));
    if constexpr (commit) group.states[c] = next;
    const contact::EndForces ends = contact::end_forces(geometry, f);
    add(chunk.sums[pair.a - chunk.first_body], ends.force_a, ends.moment_a);
    if constexpr (Kinematics::second_is_body) {
      const std::int32_t slot = plan.slot[c];
      add(slot == kernel::own_chunk ? chunk.sums[pair.b - chunk.first_body]
                                    : foreign_[static_cast<std::size_t>(slot)],
          ends.force_b, ends.moment_b);
    }
    if (on_skin) {
      const contact::SkinPoint point = contact::skin_point(placement, pair);
      for (std::size_t i = 0; i < 3; ++i)
        Eigen::Map<Vec3>(foreign_[static_cast<std::size_t>(plan.skin_slot[c][i])].force) +=
            point.share(i, ends.force_b, ends.moment_b);
    }
  }
}

contact::Placement ContactForceSum::placement(const Model& model, const Trial& trial,
                                              const model::Facets& facets) {
  contact::Placement placement = placement_in(model, trial);
  if (model.solids.empty()) return placement;
  placement.facets = &facets;
  std::vector<Vec3> middle(trial.position.begin(), trial.position.end());
  for (std::size_t i = 0; i < middle.size(); ++i) middle[i] -= 0.5 * trial.duration * trial.velocity[i];
  if (middle_facets_.empty()) middle_facets_ = model.facets;
  place_skins(model.solids, middle, middle_facets_);
  placement.middle_facets = &middle_facets_;
  return placement;
}

template <bool commit, class ModelRef>
void ContactForceSum::sum_groups(ModelRef& model, const contact::Placement& placement, const Trial& trial,
                                 BodyForces& sum) {
  EIGENGRAIN_ASSERT(plans_.size() == model.contacts.groups.size(), plans_.size());
  const auto bodies = static_cast<std::size_t>(model.bodies.size());
  sum.force.resize(bodies);
  sum.moment.resize(turns_ ? bodies : 0);
  if constexpr (commit) {
    broken_.clear();
    for (GroupPlan& plan : plans_)
      for (std::vector<BondBreak>& found : plan.broken) found.clear();
    pack_bodies(model, trial);
  }
  for_chunks(std::ssize(sum.force), chunk_size_,
             [&](std::int64_t begin, std::int64_t end, std::int64_t index) {
               const Chunk chunk{index, begin, zeroed_sums(chunk_size_)};
               auto plan = plans_.begin();
               model.contacts.for_each_group(
                   [&](auto& group) { sum_group<commit>(*plan++, group, model, placement, trial, chunk); });
               for (std::int64_t i = begin; i < end; ++i) {
                 const kernel::BodySum& of_body = chunk.sums[i - begin];
                 sum.force[static_cast<std::size_t>(i)] = Eigen::Map<const Vec3>(of_body.force);
                 if (turns_) sum.moment[static_cast<std::size_t>(i)] = Eigen::Map<const Vec3>(of_body.moment);
               }
             });
  add_foreign(sum);
  of_elements_.add(model.solids, trial.position, sum.force);
  if constexpr (commit) {
    check_solids(model.solids, trial.position, sum.force);
    if (selects_) way_ = 0;
    for (const GroupPlan& plan : plans_)
      for (const std::vector<BondBreak>& found : plan.broken)
        broken_.insert(broken_.end(), found.begin(), found.end());
  }
}

void ContactForceSum::add_foreign(BodyForces& sum) const {
  for_each_index(std::ssize(sum.force), [&](std::int64_t index) {
    const auto body = static_cast<std::size_t>(index);
    for (std::int32_t slot = foreign_starts_[body]; slot < foreign_starts_[body + 1]; ++slot) {
      const kernel::BodySum& there = foreign_[static_cast<std::size_t>(slot)];
      sum.force[body] += Eigen::Map<const Vec3>(there.force);
      if (turns_) sum.moment[body] += Eigen::Map<const Vec3>(there.moment);
    }
  });
}

void ContactForceSum::evaluate(const Model& model, const Trial& trial, BodyForces& sum) {
  way_ = infinity;  // it writes what candidates alone write in advance()
  if (!model.solids.empty()) {
    if (trial_facets_.empty()) trial_facets_ = model.facets;
    place_skins(model.solids, trial.position, trial_facets_);
  }
  sum_groups<false>(model, placement(model, trial, trial_facets_), trial, sum);
}

void ContactForceSum::follow_facets(Model& model, const contact::Placement& placement) const {
  auto plan = plans_.begin();
  model.contacts.for_each_group([&](auto& group) {
    const GroupPlan& of_group = *plan++;
    if constexpr (std::is_same_v<typename std::decay_t<decltype(group)>::KinematicsType, contact::BallFacet>)
      for_chunks(model.bodies.size(), chunk_size_, [&](std::int64_t, std::int64_t, std::int64_t chunk) {
        contact::follow_facets(placement, group, static_cast<std::size_t>(of_group.starts[chunk]),
                               static_cast<std::size_t>(of_group.starts[chunk + 1]));
      });
  });
}

void ContactForceSum::advance(Model& model, const Trial& trial, BodyForces& sum,
                              contact::Dissipation* dissipated) {
  try {
    place_skins(model.solids, trial.position, model.facets);
    const contact::Placement where = placement(model, trial, model.facets);
    follow_facets(model, where);
    if (dissipated != nullptr) *dissipated += dissipation_in(model, where, trial);
    sum_groups<true>(model, where, trial, sum);
  } catch (const contact::CentreOnFacet& found) {
    throw centre_on_facet(model, found);
  }
}

void renew_forces(State& state) {
  const model::Bodies& bodies = state.model.bodies;
  BodyForces sum;
  ContactForceSum contacts(state.model, state.turns());
  contacts.advance(state.model, {bodies.position, bodies.velocity, bodies.spin, 0.0, bodies.orientation},
                   sum);
  note_breaks(state, contacts.broken());
  state.force = std::move(sum.force);
  state.moment = std::move(sum.moment);
}

BodyForces contact_forces(const Model& model, const Displacement& displacement) {
  const TrialState state(model, displacement);
  BodyForces sum;
  ContactForceSum(model, true).evaluate(model, state.trial(), sum);
  return sum;
}

BodyForces contact_forces(const Model& model) {
  return contact_forces(model, no_displacement(model));
}

double elastic_energy(const Model& model, const Displacement& displacement) {
  constexpr std::int64_t chunk_size = 4096;
  const TrialState state(model, displacement);
  const Trial trial = state.trial();
  contact::Placement placement = model.placement(trial.position, trial.orientation);
  model::Facets facets;
  if (!model.solids.empty()) {
    facets = model.facets;
    place_skins(model.solids, trial.position, facets);
    placement.facets = &facets;
  }
  double energy = elastic_energy_of(model.solids, trial.position);
  model.contacts.for_each_group([&](const auto& group) {
    using Kinematics = typename std::decay_t<decltype(group)>::KinematicsType;
    std::vector<double> parts(static_cast<std::size_t>((group.size() + chunk_size - 1) / chunk_size), 0.0);
    for_chunks(group.size(), chunk_size, [&](std::int64_t begin, std::int64_t end, std::int64_t chunk) {
      for (auto c = static_cast<std::size_t>(begin); c < static_cast<std::size_t>(end); ++c) {
        const contact::Pair& pair = group.pairs[c];
        const contact::ContactGeometry geometry = Kinematics::geometry(placement, pair);
        parts[chunk] += group.law.energy(motion_in<Kinematics>(group.law, placement, trial, pair, geometry),
                                         group.states[c]);
      }
    });
    for (const double part : parts) energy += part;
  });
  return energy;
}

double elastic_energy(const Model& model) {
  return elastic_energy(model, no_displacement(model));
}

std::vector<WallLoad> wall_loads(const Model& model) {
  std::vector<WallLoad> loads(model.wall_count());
  const contact::Placement placement = model.placement();
  model.contacts.for_each_group([&](const auto& group) {
    using Group = std::decay_t<decltype(group)>;
    using Kinematics = typename Group::KinematicsType;
    if constexpr (!Kinematics::second_is_body) {
      for (std::size_t c = 0; c < group.pairs.size(); ++c) {
        const contact::Pair& pair = group.pairs[c];
        const contact::ContactGeometry geometry = Kinematics::geometry(placement, pair);
        const contact::EndForces ends = contact::end_forces(
            geometry, contact::force_now(group.law, placement, pair, geometry, group.states[c]));
        WallLoad& load = loads[static_cast<std::size_t>(Kinematics::wall(placement, pair))];
        load.force += ends.force_b;
        load.moment += ends.moment_b;
      }
    }
  });
  return loads;
}

std::vector<Vec3> wall_forces(const Model& model) {
  std::vector<Vec3> forces;
  for (const WallLoad& load : wall_loads(model)) forces.push_back(load.force);
  return forces;
}

}  // namespace eigengrain::assembly

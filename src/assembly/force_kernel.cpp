// The contacts of balls, several at a time. This file is compiled once for each instruction set
// (CMakeLists.txt); EIGENGRAIN_KERNEL is the name of what it offers there.
#include "force_kernel.hpp"

#include "eigengrain/base/pack.hpp"

#include "flat.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

namespace eigengrain::assembly::kernel {
namespace {

constexpr int lanes = 4;
constexpr int row = 4;  // numbers that are moved between memory and registers at a time
static_assert(lanes == row);

using Real = Pack<lanes>;
using Vector = Vec3Of<Real>;
using Row = Real::Vector;
using UnalignedRow = double __attribute__((vector_size(32), aligned(8)));
using Rows = std::array<const double*, lanes>;

inline Row load(const double* from) {
  return *reinterpret_cast<const UnalignedRow*>(from);
}
inline void store(double* to, Row v) {
  *reinterpret_cast<UnalignedRow*>(to) = v;
}
inline void add_to(double* to, Row v) {
  *reinterpret_cast<Row*>(to) += v;
}

/// Rows become columns.
inline void transpose(Row& a, Row& b, Row& c, Row& d) {
  const Row ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Row ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Row cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Row cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

/// The first `count` numbers of each row, lane by lane. The last ones are read again rather than those behind
/// the end.
template <std::size_t count>
void gather(const Rows& rows, Real* numbers) {
  if constexpr (count < row) {
    for (std::size_t k = 0; k < count; ++k)
      numbers[k] = Real(Row{rows[0][k], rows[1][k], rows[2][k], rows[3][k]});
  } else {
    for (std::size_t k = 0; k < count; k += row) {
      const std::size_t from = std::min(k, count - row);
      Row a = load(rows[0] + from);
      Row b = load(rows[1] + from);
      Row c = load(rows[2] + from);
      Row d = load(rows[3] + from);
      transpose(a, b, c, d);
      numbers[from] = Real(a);
      numbers[from + 1] = Real(b);
      numbers[from + 2] = Real(c);
      numbers[from + 3] = Real(d);
    }
  }
}

/// Back to the first `used` rows.
template <std::size_t count>
void scatter(const Real* numbers, const std::array<double*, lanes>& rows, int used) {
  if constexpr (count < row) {
    for (int lane = 0; lane < used; ++lane)
      for (std::size_t k = 0; k < count; ++k) rows[lane][k] = numbers[k][lane];
  } else {
    for (std::size_t k = 0; k < count; k += row) {
      const std::size_t from = std::min(k, count - row);
      std::array<Row, lanes> r{numbers[from].v, numbers[from + 1].v, numbers[from + 2].v,
                               numbers[from + 3].v};
      transpose(r[0], r[1], r[2], r[3]);
      for (int lane = 0; lane < used; ++lane) store(rows[lane] + from, r[lane]);
    }
  }
}

/// Three components as one row for each lane, with a zero behind them.
inline std::array<Row, lanes> rows_of(const Vector& v) {
  std::array<Row, lanes> r{v.x().v, v.y().v, v.z().v, Row{}};
  transpose(r[0], r[1], r[2], r[3]);
  return r;
}

/// The contacts of a chunk of bodies that bear one law.
template <class Law, bool turns>
class BallSums {
 public:
  BallSums(BallContacts<Law>& group, const Work& work) : group_(group), work_(work), law_(group.law) {}

  void run() {
    const std::span<const Candidate> all = work_.candidates;
    const auto count = static_cast<std::int32_t>(all.size());
    // In one place, so that the arithmetic of a contact is the same wherever in the list it stands. Lanes
    // beyond the last contact repeat it, and nothing is stored of them.
    std::array<Candidate, lanes> chosen;
    for (std::int32_t k = 0; k < count; k += lanes) {
      for (int lane = 0; lane < lanes; ++lane) {
        fetch(all[std::min(k + ahead + lane, count - 1)]);
        chosen[lane] = all[std::min(k + lane, count - 1)];
      }
      advance(chosen.data(), std::min(lanes, count - k));
    }
  }

 private:
  using State = typename Law::State;
  static constexpr std::size_t numbers = contact::state_numbers(Law::state_fields);
  /// A law without history means none of the increments.
  static constexpr bool moves = numbers > 0;
  static_assert(moves || !contact::asks_rate<Law>);

  const model::Image& image(const Candidate& candidate) const {
    return group_.pairs[static_cast<std::size_t>(candidate.contact)].image;
  }

  /// So many contacts later, what they ask for is on its way into the first cache.
  static constexpr std::int32_t ahead = 32;

  /// Asks for what a contact will need.
  void fetch(const Candidate& candidate) {
    __builtin_prefetch(&work_.places[candidate.b]);
    if constexpr (moves) {
      __builtin_prefetch(&work_.motions[candidate.b]);
      const auto* state = reinterpret_cast<const char*>(&group_.states[candidate.contact]);
      __builtin_prefetch(state, 1);
      __builtin_prefetch(state + sizeof(State) - 1, 1);
    }
  }

  void advance(const Candidate* chosen, int used) {
    const contact::GeometryOf<Real> geometry = find_geometry(chosen);
    const contact::MotionIn<Real> motion = find_motion(chosen, geometry);
    contact::ForceIn<Real> force;
    const MaskOf<Real> acts = commit(chosen, used, motion, force);
    add(chosen, used, acts, contact::end_forces(geometry, force));
  }

  contact::GeometryOf<Real> find_geometry(const Candidate* chosen) {
    Rows rows_a;
    Rows rows_b;
    for (int lane = 0; lane < lanes; ++lane) {
      rows_a[lane] = work_.places[chosen[lane].a].x;
      rows_b[lane] = work_.places[chosen[lane].b].x;
    }
    std::array<Real, 4> a;
    std::array<Real, 4> b;
    gather<4>(rows_a, a.data());
    gather<4>(rows_b, b.data());
    branch_ = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    if (work_.cell != nullptr)
      for (int lane = 0; lane < lanes; ++lane) {
        const Vec3 shift = work_.cell->shift(image(chosen[lane]));
        for (int k = 0; k < 3; ++k) branch_[k].v[lane] += shift[k];
      }
    radius_a_ = a[3];
    radius_b_ = b[3];
    return contact::balls_apart(branch_, radius_a_, radius_b_, work_.lever_cut);
  }

  contact::MotionIn<Real> find_motion(const Candidate* chosen, const contact::GeometryOf<Real>& geometry) {
    if constexpr (!moves) return contact::contact_motion<Real>(geometry, {}, {});
    Rows rows_a;
    Rows rows_b;
    for (int lane = 0; lane < lanes; ++lane) {
      rows_a[lane] = work_.motions[chosen[lane].a].velocity;
      rows_b[lane] = work_.motions[chosen[lane].b].velocity;
    }
    std::array<Real, 8> a;
    std::array<Real, 8> b;
    gather<8>(rows_a, a.data());
    gather<8>(rows_b, b.data());
    const Real duration = work_.duration;
    const contact::SideMotionIn<Real> side_a{duration * Vector(a[0], a[1], a[2]),
                                             duration * Vector(a[4], a[5], a[6])};
    contact::SideMotionIn<Real> side_b{duration * Vector(b[0], b[1], b[2]),
                                       duration * Vector(b[4], b[5], b[6])};
    if (work_.cell_step != nullptr)
      for (int lane = 0; lane < lanes; ++lane) {
        const model::Image& of_b = image(chosen[lane]);
        const Vec3 step = *work_.cell_step * Vec3(of_b[0], of_b[1], of_b[2]);
        for (int k = 0; k < 3; ++k) side_b.translation[k].v[lane] += step[k];
      }
    contact::MotionIn<Real> motion =
        law_.mid_step()
            ? contact::mid_step_motion(
                  geometry,
                  contact::balls_apart<Real>(branch_ - 0.5 * (side_b.translation - side_a.translation),
                                             radius_a_, radius_b_, work_.lever_cut),
                  side_a, side_b)
            : contact::contact_motion<Real>(geometry, side_a, side_b);
    if constexpr (contact::asks_rate<Law>) {
      motion.velocity = Real(work_.per_second) * motion.displacement;
      motion.reduced_mass = a[3] * b[3] / (a[3] + b[3]);
    }
    return motion;
  }

  /// Forces after the motion, and states; which of the contacts act.
  MaskOf<Real> commit(const Candidate* chosen, int used, const contact::MotionIn<Real>& motion,
                      contact::ForceIn<Real>& force) {
    using Packed = typename Law::template StateIn<Real>;
    static_assert(std::is_empty_v<Packed> || sizeof(Packed) == numbers * sizeof(Real));
    std::array<double*, lanes> rows{};
    if constexpr (numbers > 0)
      for (int lane = 0; lane < lanes; ++lane)
        rows[lane] =
            reinterpret_cast<double*>(&group_.states[static_cast<std::size_t>(chosen[lane].contact)]);
    Packed old;
    Packed next;
    if constexpr (numbers > 0)
      gather<numbers>({rows[0], rows[1], rows[2], rows[3]}, reinterpret_cast<Real*>(&old));
    const MaskOf<Real> acts = law_.acts(motion, old);
    force = law_.evaluate(motion, old, next);
    if constexpr (numbers > 0) {
      const Packed never;  // touched
      auto* const number = reinterpret_cast<Real*>(&next);
      for (std::size_t k = 0; k < numbers; ++k)
        number[k] = select(acts, number[k], reinterpret_cast<const Real*>(&never)[k]);
      scatter<numbers>(number, rows, used);
    }
    return acts;
  }

  /// What does not act exerts nothing, not even where a body is nowhere (not a number).
  void add(const Candidate* chosen, int used, MaskOf<Real> acts, const contact::EndForcesIn<Real>& ends) {
    const Vector nothing = Vector::Zero();
    const std::array<Row, lanes> force = rows_of(select<Real>(acts, ends.force_b, nothing));
    const std::array<Row, lanes> moment_a = rows_of(select<Real>(acts, ends.moment_a, nothing));
    const std::array<Row, lanes> moment_b = rows_of(select<Real>(acts, ends.moment_b, nothing));
    for (int lane = 0; lane < used; ++lane) {
      const Candidate& p = chosen[lane];
      BodySum& a = work_.sums[p.a - work_.first_body];
      add_to(a.force, -force[lane]);
      if constexpr (turns) add_to(a.moment, moment_a[lane]);
      if (p.slot == own_chunk) {
        BodySum& b = work_.sums[p.b - work_.first_body];
        add_to(b.force, force[lane]);
        if constexpr (turns) add_to(b.moment, moment_b[lane]);
      } else {
        store(work_.foreign[p.slot].force, force[lane]);
        if constexpr (turns) store(work_.foreign[p.slot].moment, moment_b[lane]);
      }
    }
  }

  BallContacts<Law>& group_;
  const Work& work_;
  const Law law_;  // a copy, that nothing which is stored can change
  Vector branch_;
  Real radius_a_;
  Real radius_b_;
};

template <class Law>
EIGENGRAIN_FLAT void advance_balls(BallContacts<Law>& group, const Work& work) {
  if (work.turns)
    BallSums<Law, true>(group, work).run();
  else
    BallSums<Law, false>(group, work).run();
}

template <class... Laws>
constexpr ForceKernel functions(TypeList<Laws...> /*laws*/) {
  return {&advance_balls<Laws>...};
}

}  // namespace

extern const ForceKernel EIGENGRAIN_KERNEL;
const ForceKernel EIGENGRAIN_KERNEL = functions(contact::LawTypes{});

}  // namespace eigengrain::assembly::kernel

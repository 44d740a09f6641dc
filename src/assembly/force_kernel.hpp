#pragma once

#include "eigengrain/contact/group.hpp"

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

/// The inner loop of the explicit cycle: what the contacts of balls exert, several contacts at a time.
///
/// Data flows like this: pack_bodies() writes what contacts read of a body into two small records; a kernel
/// goes through those contacts of a chunk of bodies that could act soon, evaluates `lanes` of them at a time,
/// and adds what they exert to one record a body.
namespace eigengrain::assembly::kernel {

/// Half a cache line of what every contact asks of a body.
struct alignas(32) BodyPlace {
  double x[3];    ///< centre, m
  double radius;  ///< m
};

/// One cache line of what contacts with a history ask too.
struct alignas(64) BodyMotion {
  double velocity[3];  ///< m/s
  double mass;         ///< kg; for laws that ask for the rate
  double spin[3];      ///< rad/s
  double unused;
};

/// What contacts exert on a body.
struct alignas(64) BodySum {
  double force[4];   ///< N; the last is not used
  double moment[4];  ///< about the centre, N m
};

/// A contact that touches, or could before bodies have moved far.
struct Candidate {
  std::int32_t contact;  ///< of the group
  std::int32_t a;        ///< rows of the bodies
  std::int32_t b;
  std::int32_t slot;  ///< into `foreign`, or own_chunk
};

/// No other chunk: the body is one of those whose sums are at hand.
inline constexpr std::int32_t own_chunk = -1;

/// The contacts of one group in one chunk of bodies, and the step they are evaluated for.
struct Work {
  const BodyPlace* places = nullptr;          ///< [bodies]
  const BodyMotion* motions = nullptr;        ///< [bodies]; null where no contact has a history
  const model::PeriodicCell* cell = nullptr;  ///< null where nothing repeats
  const Mat3* cell_step = nullptr;            ///< change of its edges in the step, m; null: the cell rests
  double duration = 0;                        ///< from velocities to increments, s
  double per_second = 0;                      ///< from increments to velocities, 1/s
  double lever_cut = 0;
  bool turns = false;  ///< whether moments are wanted
  std::span<const Candidate> candidates;
  std::int32_t first_body = 0;  ///< of the chunk
  BodySum* sums = nullptr;      ///< [bodies of the chunk] added to
  BodySum* foreign = nullptr;   ///< [slots] what contacts do to bodies of other chunks
};

template <class Law>
using BallContacts = contact::ContactGroup<contact::BallBall, Law>;

/// Evaluates the contacts and commits their states.
template <class Law>
using Advance = void (*)(BallContacts<Law>& group, const Work& work);

template <class... Laws>
std::tuple<Advance<Laws>...> table_of(TypeList<Laws...>);

/// One function for each law of the table.
using ForceKernel = decltype(table_of(contact::LawTypes{}));

/// The kernel for the instruction set of this processor. Each gives the same bits from run to run and for any
/// number of threads; two of them agree to rounding.
const ForceKernel& best_force_kernel();

}  // namespace eigengrain::assembly::kernel

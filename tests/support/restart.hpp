#pragma once

#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/io/state_file.hpp"

#include "support/bits.hpp"
#include "unit/io_support.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>

namespace eigengrain::test {

/// A run that stops after so many steps, is written to a file, read again and continued ends as one that
/// never stopped, to the bit.
inline void expect_to_continue(const model::Scene& scene, std::int64_t steps,
                               std::initializer_list<std::int64_t> stops) {
  const io::TemporaryFolder folder;
  const auto file = folder.path() / "state.h5";
  const cycle::TimestepPolicy policy = cycle::policy_of(scene);
  cycle::Cycle whole(cycle::start(scene), policy);
  whole.run(steps);
  for (const std::int64_t stop : stops) {
    cycle::Cycle first(cycle::start(scene), policy);
    first.run(stop);
    io::write_state(first.state(), file);
    assembly::State read = io::read_state(file);
    EXPECT_EQ(bits_of(read), bits_of(first.state())) << stop;
    cycle::Cycle second(std::move(read), cycle::policy_of(scene));  // that has kept nothing
    second.run(steps - stop);
    EXPECT_EQ(bits_of(second.state()), bits_of(whole.state())) << stop;
  }
}

}  // namespace eigengrain::test

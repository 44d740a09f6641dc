#pragma once

#include "eigengrain/assembly/state.hpp"

#include <memory>
#include <utility>

namespace eigengrain::python {

/// What a script holds of a state. A state is never changed in place: work is done on a copy, which takes its
/// place when it is done, so arrays that show the earlier one stay as they are, and a failure leaves it.
class Handle {
 public:
  explicit Handle(assembly::State state)
      : state_(std::make_shared<const assembly::State>(std::move(state))) {}

  const std::shared_ptr<const assembly::State>& state() const { return state_; }
  void replace(assembly::State state) { state_ = std::make_shared<const assembly::State>(std::move(state)); }

 private:
  std::shared_ptr<const assembly::State> state_;
};

}  // namespace eigengrain::python

#pragma once

#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/assembly/product.hpp"
#include "eigengrain/assembly/state.hpp"

#include <memory>
#include <mutex>
#include <utility>

namespace eigengrain::python {

/// What a script holds of K, M, B and D: those of a state as it was when they were asked for.
struct System {
  System(std::shared_ptr<const assembly::State> of, assembly::LinearSystem system_of)
      : state(std::move(of)), system(std::move(system_of)) {}

  std::shared_ptr<const assembly::State> state;
  assembly::LinearSystem system;
};

/// y = S K S x for whoever asks, from several threads too.
class Product {
 public:
  Product(std::shared_ptr<const System> system, bool scaled)
      : system_(std::move(system)),
        product_(system_->system.unknowns, system_->system.parts(),
                 scaled ? system_->system.inverse_sqrt_mass() : std::vector<double>()) {}

  void apply(std::span<const double> x, std::span<double> y) {
    const std::lock_guard alone(busy_);
    product_.apply(x, y);
  }
  std::int64_t size() const { return product_.size(); }
  std::int64_t products() const { return product_.products(); }

 private:
  std::shared_ptr<const System> system_;
  assembly::StiffnessProduct product_;
  std::mutex busy_;
};

}  // namespace eigengrain::python

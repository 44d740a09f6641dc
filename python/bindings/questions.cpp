// What is asked of a state: its critical timestep.
#include "eigengrain/base/error.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/timestep/comparison.hpp"

#include "arrays.hpp"
#include "handle.hpp"
#include "parts.hpp"
#include "petsc_work.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <utility>

namespace eigengrain::python {
namespace {

using py::literals::operator""_a;

timestep::Certify certify_of(const std::string& word) {
  if (word == "always") return timestep::Certify::always;
  if (word == "never") return timestep::Certify::never;
  if (word == "small") return timestep::Certify::small;
  throw InputError("certify: \"" + word + "\"; write always, small or never");
}

py::dict to_dict(const timestep::Truth& truth) {
  return py::dict("dt"_a = truth.dt, "limit"_a = truth.limit, "lambda_max"_a = truth.lambda_max,
                  "residual"_a = truth.residual, "limit_residual"_a = truth.limit_residual,
                  "certified"_a = truth.certified, "proven_dt"_a = truth.proof.dt,
                  "proven_by"_a = std::string(timestep::name_of(truth.proof.by)),
                  "mode"_a = owned(truth.mode), "seconds"_a = truth.seconds, "products"_a = truth.products);
}

py::dict to_dict(const timestep::Estimate& estimate) {
  py::dict result("name"_a = estimate.name, "source"_a = estimate.source,
                  "claim"_a = std::string(timestep::name_of(estimate.claim)), "dt"_a = estimate.dt,
                  "ratio_to_true"_a = estimate.ratio_to_true, "safe"_a = estimate.safe,
                  "seconds"_a = estimate.seconds, "products"_a = estimate.products, "range"_a = py::none());
  if (estimate.range) result["range"] = py::make_tuple(estimate.range->least, estimate.range->largest);
  return result;
}

py::dict critical_timestep(const Handle& handle, double tolerance, std::uint64_t seed,
                           const std::string& certify) {
  const std::shared_ptr<const assembly::State> state = handle.state();
  timestep::TruthOptions options;
  options.tolerance = tolerance;
  options.seed = seed;
  options.certify = certify_of(certify);
  timestep::Comparison found;
  {
    const PetscWork work;
    petsc::start();
    found = timestep::compare(state->model, options, state->settings.materials);
  }
  py::list estimates;
  for (const timestep::Estimate& estimate : found.estimates) estimates.append(to_dict(estimate));
  py::dict left_out;
  for (const timestep::LeftOut& estimate : found.left_out) left_out[py::str(estimate.name)] = estimate.reason;
  return py::dict("bodies"_a = found.bodies, "contacts"_a = found.contacts, "unknowns"_a = found.unknowns,
                  "set_aside"_a = found.set_aside, "true"_a = to_dict(found.truth), "estimates"_a = estimates,
                  "left_out"_a = left_out);
}

}  // namespace

void add_questions(py::module_& module) {
  module.def("critical_timestep", &critical_timestep, py::arg("state"), py::arg("tolerance"), py::arg("seed"),
             py::arg("certify"));
}

}  // namespace eigengrain::python

// States: from scenes and files, their bodies and contacts as arrays, and what makes them move.
#include "eigengrain/assembly/balance.hpp"
#include "eigengrain/assembly/contact_list.hpp"
#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/base/timer.hpp"
#include "eigengrain/cycle/cycle.hpp"
#include "eigengrain/cycle/goal.hpp"
#include "eigengrain/cycle/policy.hpp"
#include "eigengrain/cycle/watch.hpp"
#include "eigengrain/io/scene_reader.hpp"
#include "eigengrain/io/state_file.hpp"
#include "eigengrain/measures/measure.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include "arrays.hpp"
#include "handle.hpp"
#include "parts.hpp"
#include "petsc_work.hpp"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <exception>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace eigengrain::python {
namespace {

using assembly::State;
using Snapshot = std::shared_ptr<const State>;

constexpr std::int64_t steps_between_looks = 100;   // for a blow-up, as the program does
constexpr double seconds_between_interrupts = 0.1;  // no result depends on it

Handle start_text(const std::string& yaml, const std::string& folder, const std::string& name,
                  const std::vector<std::string>& overrides) {
  const py::gil_scoped_release open;
  return Handle(cycle::start(io::read_scene_text(yaml, folder, name, overrides)));
}

/// HDF5 is used with the GIL held, as it is not safe for threads.
Handle read(const std::string& file, const std::vector<std::string>& overrides) {
  if (!io::is_state_file(file)) {
    const py::gil_scoped_release open;
    return Handle(cycle::start(io::read_scene(file, overrides)));
  }
  State state = io::read_state(file, overrides);
  if (!overrides.empty()) {
    assembly::forget_step(state);
    state.ledger.reset();
  }
  return Handle(std::move(state));
}

/// The explicit cycle of a state that a script holds.
class ScriptRun {
 public:
  /// looks   called every `every` steps with what was reached in the state's place, and at the end; true ends
  ///         the run. May be None.
  /// report  report(step, time) is called now and then; may be None.
  ScriptRun(Handle& handle, const std::optional<model::RunChoice>& run, std::int64_t every, py::object looks,
            py::object report)
      : handle_(handle),
        goal_(run ? cycle::Goal(*run, *handle.state()) : cycle::Goal(*handle.state())),
        every_(every),
        looks_(std::move(looks)),
        report_(std::move(report)) {}

  /// What was reached takes the place of the state even where the user ends it.
  void go() {
    std::exception_ptr interrupt;
    {
      const py::gil_scoped_release open;
      begin(*handle_.state());
      const std::int64_t first = state().step;
      bool over = false;
      try {
        while (!over && !goal_.reached(state())) {
          step();
          if (state().step % steps_between_looks == 0) look();
          if ((state().step - first) % every_ == 0) over = attend();
          give_way();
        }
        look();
        tell();
        if (!over && (state().step - first) % every_ != 0) attend();
      } catch (const py::error_already_set&) {
        interrupt = std::current_exception();
      }
    }
    handle_.replace(cycle_->release());
    if (interrupt) std::rethrow_exception(interrupt);
  }

 private:
  const State& state() const { return cycle_->state(); }

  void begin(State state) {
    kept_ = handle_.state();
    const cycle::TimestepPolicy policy = cycle::policy_of(state.settings);
    cycle_.emplace(std::move(state), policy);
    watch_.emplace(cycle_->state());
  }
  /// A state that is lost makes other mistakes than its own; the watch knows better.
  void step() {
    try {
      cycle_->step();
    } catch (const std::exception&) {
      look();
      throw;
    }
  }
  void look() {
    const auto trouble = watch_->look(state());
    if (!trouble) return;
    std::string names;
    for (const std::int64_t body : trouble->bodies)
      names += (names.empty() ? "" : ", ") + std::to_string(body);
    throw SolverError("the run blew up before step " + std::to_string(state().step) + ": " + trouble->what +
                      " (balls " + names + "); the state is still that of step " +
                      std::to_string(kept_->step));
  }
  /// Shows what was reached; whether the run is over.
  bool attend() {
    if (goal_.has_condition()) goal_.look(state());
    if (looks_.is_none()) return false;
    const py::gil_scoped_acquire gil;
    handle_.replace(State(state()));
    kept_ = handle_.state();
    const auto adopt = [&] {  // what the script has made of it
      if (handle_.state() != kept_) begin(*handle_.state());
    };
    try {
      const bool over = looks_().cast<bool>();
      adopt();
      return over;
    } catch (const py::error_already_set&) {
      adopt();
      throw;
    }
  }
  void give_way() {
    if (since_.seconds() - last_ < seconds_between_interrupts) return;
    last_ = since_.seconds();
    look_for_interrupt();
    tell();
  }
  void tell() {
    if (report_.is_none()) return;
    const py::gil_scoped_acquire gil;
    report_(state().step, state().time);
  }

  Handle& handle_;
  cycle::Goal goal_;
  std::int64_t every_;
  py::object looks_;
  py::object report_;
  Snapshot kept_;  ///< what the script sees
  std::optional<cycle::Cycle> cycle_;
  std::optional<cycle::Watch> watch_;
  Stopwatch since_;
  double last_ = 0;
};

/// Without an end of its own the run has that of the scene.
void run(Handle& handle, std::optional<std::int64_t> steps, std::optional<double> time,
         std::optional<double> unbalanced, std::int64_t every, const py::object& looks,
         const py::object& report) {
  std::optional<model::RunChoice> own{{.steps = steps, .time = time, .unbalanced = unbalanced}};
  if (!own->any()) own.reset();
  ScriptRun(handle, own, every, looks, report).go();
}

py::tuple tuple_of(const Vec3& v) {
  return py::make_tuple(v.x(), v.y(), v.z());
}

/// Bonds that broke, one row each.
py::list breaks(const Handle& handle) {
  using py::literals::operator""_a;
  py::list rows;
  for (const assembly::BondBreak& found : handle.state()->breaks)
    rows.append(py::dict("step"_a = found.step, "time"_a = found.time, "first"_a = found.first,
                         "second"_a = found.second, "place"_a = tuple_of(found.place),
                         "normal"_a = tuple_of(found.normal),
                         "mode"_a = found.mode == contact::BreakMode::tension ? "tension" : "shear",
                         "contact"_a = found.entry));
  return rows;
}

py::dict to_dict(const assembly::Balance& b) {
  using py::literals::operator""_a;
  return py::dict("mean"_a = b.mean, "max"_a = b.max, "moment_mean"_a = b.moment_mean,
                  "moment_max"_a = b.moment_max, "floor"_a = b.floor, "unsupported"_a = b.unsupported,
                  "bodies"_a = b.bodies, "contacts"_a = b.contacts,
                  "mean_contact_force"_a = b.mean_contact_force);
}

py::dict relax(Handle& handle, double tolerance, std::int64_t max_steps, const py::object& report) {
  using py::literals::operator""_a;
  const Snapshot start = handle.state();
  std::exception_ptr interrupt;
  relaxation::RelaxResult result;
  std::optional<State> reached;
  {
    const PetscWork work;
    petsc::start();
    reached.emplace(*start);
    relaxation::RelaxOptions options;
    options.tolerance = tolerance;
    options.max_steps = max_steps;
    const auto guarded = [&](const auto& call) {
      try {
        call();
      } catch (const py::error_already_set&) {
        if (!interrupt) interrupt = std::current_exception();
      }
    };
    if (!report.is_none())
      options.report = [&](const std::string& line) {
        guarded([&] {
          const py::gil_scoped_acquire gil;
          report(line);
        });
      };
    options.interrupted = [&] {
      guarded(look_for_interrupt);
      return static_cast<bool>(interrupt);
    };
    result = relaxation::relax(*reached, options);
    for (assembly::BondBreak& found : reached->breaks) {
      found.step = reached->step;
      found.time = reached->time;
    }
  }
  handle.replace(std::move(*reached));
  if (interrupt) std::rethrow_exception(interrupt);
  return py::dict("converged"_a = result.converged, "method"_a = result.method,
                  "steps"_a = result.explicit_steps, "part_steps"_a = result.part_steps,
                  "iterations"_a = result.newton_iterations, "linear_iterations"_a = result.linear_iterations,
                  "seconds"_a = result.seconds, "start"_a = to_dict(result.start),
                  "end"_a = to_dict(result.end));
}

using Rows3 = py::array_t<double, py::array::c_style | py::array::forcecast>;

void take_rows(const std::optional<Rows3>& from, std::vector<Vec3>& to, std::size_t count, const char* name) {
  if (!from) return;
  if (from->ndim() != 2 || from->shape(0) != static_cast<py::ssize_t>(count) || from->shape(1) != 3)
    throw InputError(std::string(name) + ": an array of shape (" + std::to_string(count) +
                     ", 3) is wanted, a row for each ball");
  const auto rows = from->unchecked<2>();
  to.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    for (int k = 0; k < 3; ++k) {
      to[i][k] = rows(static_cast<py::ssize_t>(i), k);
      if (!std::isfinite(to[i][k]))
        throw InputError(std::string(name) + ": row " + std::to_string(i) + " has " +
                         std::to_string(to[i][k]) + "; numbers that are finite are wanted");
    }
}

/// New places and motions of balls, in the order of the rows; contacts are listed anew, and those that stay
/// keep their history.
void change(Handle& handle, const std::optional<Rows3>& position, const std::optional<Rows3>& velocity,
            const std::optional<Rows3>& spin) {
  State state = *handle.state();
  model::Bodies& bodies = state.model.bodies;
  const auto count = static_cast<std::size_t>(bodies.size());
  if (!bodies.clumps.empty())
    throw InputError("arrays of positions and velocities change balls, and this state has clumps");
  if (spin && bodies.spin.empty())
    throw InputError("spin: nothing turns in this scene, as no contact resists it");
  take_rows(position, bodies.position, count, "position");
  take_rows(velocity, bodies.velocity, count, "velocity");
  take_rows(spin, bodies.spin, count, "spin");
  {
    const py::gil_scoped_release open;
    if (position) {
      assembly::renew_list(state, state.list.skin);
      assembly::renew_forces(state);
    }
    assembly::forget_step(state);
    state.ledger.reset();
  }
  handle.replace(std::move(state));
}

/// Contacts that act as columns, made once.
struct ContactColumns {
  explicit ContactColumns(const assembly::Model& model) {
    const std::vector<measures::ActingContact> contacts = measures::acting_contacts(model);
    for (const measures::ActingContact& c : contacts) {
      const bool at_wall = c.b == measures::ActingContact::wall;
      a.push_back(c.ball_a);
      b.push_back(at_wall ? -1 : c.ball_b);
      wall.push_back(at_wall ? c.ball_b : -1);
      image.push_back(c.image);
      rule.push_back(c.rule);
      normal.push_back(c.normal);
      branch.push_back(c.branch);
      point.push_back(c.point);
      force.push_back(c.force);
      overlap.push_back(c.overlap);
      slides.push_back(c.slides ? 1 : 0);
      bonded.push_back(c.carries_moments ? 1 : 0);
    }
    for (const bool held : measures::rattlers(model, contacts, measures::least_contacts(model)))
      rattler.push_back(held ? 1 : 0);
  }
  std::vector<std::int32_t> a, b, wall, rule;
  std::vector<model::Image> image;
  std::vector<Vec3> normal, branch, point, force;
  std::vector<double> overlap;
  std::vector<std::uint8_t> slides, bonded, rattler;
};

/// Stress, fabric and the like of everything, as `measure` has it of the region "all".
py::dict measure_all(const Handle& handle) {
  using py::literals::operator""_a;
  const std::vector<model::Region> all{{"all", {}}};
  const Snapshot state = handle.state();
  measures::Measure m;
  {
    const py::gil_scoped_release open;
    m = measures::measure(state->model, all).front();
  }
  return py::dict("volume"_a = m.volume, "porosity"_a = m.porosity, "stress"_a = matrix(m.stress),
                  "coordination"_a = m.fabric.coordination, "rattlers"_a = m.fabric.rattlers,
                  "coordination_without_rattlers"_a = m.fabric.without_rattlers,
                  "fabric"_a = matrix(m.fabric.tensor), "sliding"_a = m.fabric.sliding);
}

/// A read-only property that shows a column of the bodies.
template <class T>
void column(py::class_<Handle>& type, const char* name, std::vector<T> model::Bodies::*member) {
  type.def_property_readonly(name, [member](const Handle& handle) {
    const Snapshot state = handle.state();
    return view_or_none(state->model.bodies.*member, state);
  });
}

}  // namespace

void add_states(py::module_& module) {
  py::class_<ContactColumns, std::shared_ptr<ContactColumns>> contacts(module, "Contacts");
  const auto contact_column = [&](const char* name, auto member) {
    contacts.def_property_readonly(
        name, [member](const std::shared_ptr<ContactColumns>& self) { return view((*self).*member, self); });
  };
  contact_column("a", &ContactColumns::a);
  contact_column("b", &ContactColumns::b);
  contact_column("wall", &ContactColumns::wall);
  contact_column("rule", &ContactColumns::rule);
  contact_column("image", &ContactColumns::image);
  contact_column("normal", &ContactColumns::normal);
  contact_column("branch", &ContactColumns::branch);
  contact_column("point", &ContactColumns::point);
  contact_column("force", &ContactColumns::force);
  contact_column("overlap", &ContactColumns::overlap);
  contact_column("slides", &ContactColumns::slides);
  contact_column("bonded", &ContactColumns::bonded);
  contact_column("rattler", &ContactColumns::rattler);

  py::class_<Handle> state(module, "State");
  state.def(py::init(&start_text), py::arg("yaml"), py::arg("folder"), py::arg("name"), py::arg("overrides"));
  state.def_static("read", &read, py::arg("file"), py::arg("overrides"));
  state.def("write",
            [](const Handle& self, const std::string& file) { io::write_state(*self.state(), file); });
  state.def("copy", [](const Handle& self) { return Handle(self); });
  state.def("run", &run, py::arg("steps"), py::arg("time"), py::arg("unbalanced"), py::arg("every"),
            py::arg("looks"), py::arg("report"));
  state.def("breaks", &breaks);
  state.def("relax", &relax, py::arg("tolerance"), py::arg("max_steps"), py::arg("report"));
  state.def("change", &change, py::arg("position"), py::arg("velocity"), py::arg("spin"));
  state.def("measure", &measure_all);
  state.def("balance", [](const Handle& self) { return to_dict(assembly::balance_of(*self.state())); });
  state.def("energies", [](const Handle& self) {
    using py::literals::operator""_a;
    const assembly::Energies e = assembly::energies_of(*self.state());
    return py::dict("kinetic"_a = e.kinetic, "elastic"_a = e.elastic, "gravitational"_a = e.gravitational);
  });
  state.def("contacts", [](const Handle& self) {
    const Snapshot kept = self.state();
    const py::gil_scoped_release open;
    return std::make_shared<ContactColumns>(kept->model);
  });
  state.def("wall_forces",
            [](const Handle& self) { return owned(assembly::wall_forces(self.state()->model)); });
  column(state, "identity", &model::Bodies::identity);
  column(state, "position", &model::Bodies::position);
  column(state, "radius", &model::Bodies::radius);
  column(state, "mass", &model::Bodies::mass);
  column(state, "inertia", &model::Bodies::inertia);
  column(state, "material", &model::Bodies::material);
  column(state, "fixed", &model::Bodies::fixed);
  column(state, "velocity", &model::Bodies::velocity);
  column(state, "spin", &model::Bodies::spin);
  column(state, "orientation", &model::Bodies::orientation);
  state.def_property_readonly("force",
                              [](const Handle& self) { return view(self.state()->force, self.state()); });
  state.def_property_readonly(
      "moment", [](const Handle& self) { return view_or_none(self.state()->moment, self.state()); });
  state.def_property_readonly("owner", [](const Handle& self) {
    const model::Bodies& bodies = self.state()->model.bodies;
    std::vector<std::int32_t> owner;
    for (std::int32_t row = 0; row < bodies.size(); ++row) owner.push_back(bodies.clumps.owner(row));
    return owned(std::move(owner));
  });
  state.def_property_readonly("size", [](const Handle& self) { return self.state()->model.bodies.size(); });
  state.def_property_readonly("walls", [](const Handle& self) { return self.state()->model.wall_count(); });
  state.def_property_readonly("time", [](const Handle& self) { return self.state()->time; });
  state.def_property_readonly("step", [](const Handle& self) { return self.state()->step; });
  state.def_property_readonly("dt", [](const Handle& self) { return self.state()->dt; });
  state.def_property_readonly("next_dt", [](const Handle& self) { return self.state()->next_dt; });
  state.def_property_readonly("name", [](const Handle& self) { return self.state()->settings.name; });
  state.def_property_readonly("settings", [](const Handle& self) { return self.state()->settings.document; });
  state.def_property_readonly("notes", [](const Handle& self) { return self.state()->settings.notes; });
  state.def_property_readonly("has_stages",
                              [](const Handle& self) { return !self.state()->settings.stages.empty(); });
  state.def_property_readonly("cell", [](const Handle& self) {
    const model::PeriodicCell& cell = self.state()->model.cell;
    return py::make_tuple(matrix(cell.edges),
                          std::vector<double>{cell.origin[0], cell.origin[1], cell.origin[2]},
                          std::vector<bool>(cell.periodic.begin(), cell.periodic.end()));
  });
}

}  // namespace eigengrain::python

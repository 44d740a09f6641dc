#include "loading.hpp"

#include "eigengrain/assembly/energies.hpp"
#include "eigengrain/assembly/forces.hpp"
#include "eigengrain/base/error.hpp"
#include "eigengrain/io/state_file.hpp"
#include "eigengrain/measures/measure.hpp"
#include "eigengrain/petsc/session.hpp"
#include "eigengrain/relaxation/prescribed.hpp"
#include "eigengrain/relaxation/relax.hpp"

#include "equilibrium_report.hpp"
#include "input.hpp"
#include "interrupt.hpp"
#include "relaxing.hpp"
#include "text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>
#include <utility>

namespace eigengrain::app {
namespace {

namespace fs = std::filesystem;
using assembly::State;

constexpr std::string_view example =
    "write KEY=FROM..TO, e.g. \"gravity=[0, 0, -9.81]..[1.7, 0, -9.66]\", "
    "displacement.WALL=[x, y, z] or strain=[[..], [..], [..]]";

/// All numbers of a text, whatever brackets and commas stand between; none where something else does.
std::optional<std::vector<double>> numbers_in(std::string_view text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  while (at != end) {
    if (std::string_view("[], \t").find(*at) != std::string_view::npos) {
      ++at;
      continue;
    }
    if (*at == '+') ++at;
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    numbers.push_back(value);
    at = next;
  }
  return numbers;
}

/// The path of one text; empty where it is one, else what is wrong.
std::string add_to(LoadingPath& path, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) return "no key";
  const std::string key = text.substr(0, equals);
  const std::string value = text.substr(equals + 1);
  constexpr std::string_view displacement = "displacement.";
  if (key == "strain") {
    const auto numbers = numbers_in(value);
    if (!numbers || numbers->size() != 9) return "a strain has three rows of three numbers";
    if (path.strain) return "there is a strain already; write their sum";
    path.strain = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers->data());
    return "";
  }
  if (key.starts_with(displacement)) {
    const auto wall = numbers_in(key.substr(displacement.size()));
    const auto numbers = numbers_in(value);
    if (!wall || wall->size() != 1 || (*wall)[0] < 0 || (*wall)[0] != std::floor((*wall)[0]))
      return "the wall is not a number from 0";
    if (!numbers || numbers->size() != 3) return "a displacement has three numbers";
    path.walls.push_back(
        {static_cast<std::int32_t>((*wall)[0]), Vec3((*numbers)[0], (*numbers)[1], (*numbers)[2])});
    return "";
  }
  const std::size_t dots = value.find("..");
  if (dots == std::string::npos) return "no FROM..TO";
  const auto from = numbers_in(value.substr(0, dots));
  const auto to = numbers_in(value.substr(dots + 2));
  if (!from || !to || from->empty()) return "FROM and TO are numbers or lists of numbers, in SI units";
  if (from->size() != to->size()) return "FROM and TO have not as many numbers";
  path.keys.push_back({key, *from, *to, value.find('[') != std::string::npos});
  return "";
}

fs::path breaks_of(const fs::path& state) {
  return state.parent_path() / (state.stem().string() + "-breaks.csv");
}

fs::path state_file(const Input& input, int increment) {
  return input.folder / fmt::format("{}-load-{:04}.h5", input.stem, increment);
}

/// Part of the path at the end of an increment.
double part_at(int increment, int increments) {
  return static_cast<double>(increment) / increments;
}

/// States of a path that was followed here before.
void remove_states(const Input& input) {
  for (int k = 1; fs::remove(state_file(input, k)); ++k) fs::remove(breaks_of(state_file(input, k)));
}

/// The last increment that has its line in the table and its state, or 0. Throws InputError where the table
/// is of a path with other increments.
int last_saved(const Input& input, const fs::path& table, int increments) {
  std::ifstream in(table);
  std::string line;
  std::getline(in, line);
  int last = 0;
  while (std::getline(in, line) && fs::exists(state_file(input, last + 1))) {
    ++last;
    const std::string expected = fmt::format("{},{},", last, part_at(last, increments));
    if (!line.starts_with(expected))
      throw InputError(fmt::format(
          "--continue: {} has \"{}\" for increment {}, and with --increments {} it would begin with \"{}\": "
          "ask for as many increments as before, or begin anew without --continue",
          table.string(), line.substr(0, line.find(',', line.find(',') + 1)), last, increments, expected));
  }
  return last;
}

/// The table of a path: one line an increment.
class LoadTable {
 public:
  LoadTable(const Input& input, const fs::path& file, int kept) : file_(file) {
    if (kept > 0) return;
    std::string head =
        "increment,part,ratio,steps,iterations,linear_iterations,contacts,slipping,bonded,"
        "mean_contact_force [N],elastic [J],volume [m3],stress_xx [Pa],stress_yy [Pa],stress_zz [Pa],"
        "stress_yz [Pa],stress_xz [Pa],stress_xy [Pa]";
    const std::size_t walls = input.state.model.wall_count();
    for (std::size_t w = 0; w < walls; ++w)
      head += fmt::format(",wall_{0}_fx [N],wall_{0}_fy [N],wall_{0}_fz [N]", w);
    std::ofstream out(file_);
    out << head << '\n';
    require(out);
  }

  void add(int increment, double part, const relaxation::RelaxResult& result, const State& state,
           const ContactStatuses& statuses) const {
    std::string line = fmt::format("{},{},{},{},{},{},{},{},{},{},{}", increment, part, mean_of(result),
                                   result.explicit_steps, result.newton_iterations, result.linear_iterations,
                                   result.end.contacts, statuses.slipping, statuses.bonded,
                                   result.end.mean_contact_force, assembly::energies_of(state).elastic);
    const model::PeriodicCell& cell = state.model.cell;
    if (cell.periodic[0] && cell.periodic[1] && cell.periodic[2]) {
      const std::vector<model::Region> all{{"all", {}}};
      const measures::Measure of_all = measures::measure(state.model, all).front();
      const Mat3& s = of_all.stress;
      line += fmt::format(",{},{},{},{},{},{},{}", of_all.volume, s(0, 0), s(1, 1), s(2, 2), s(1, 2), s(0, 2),
                          s(0, 1));
    } else {
      line += ",,,,,,,";
    }
    for (const Vec3& force : assembly::wall_forces(state.model))
      line += fmt::format(",{},{},{}", force.x(), force.y(), force.z());
    std::ofstream out(file_, std::ios::app);
    out << line << '\n';
    out.flush();
    require(out);
  }

  /// Drops the lines behind an increment, as of a run that was killed after a line and before its state.
  static void cut(const fs::path& file, int increment) {
    std::ifstream in(file);
    std::string kept;
    std::string line;
    for (int k = 0; k <= increment && std::getline(in, line); ++k) kept += line + '\n';
    std::ofstream(file) << kept;
  }

 private:
  void require(const std::ofstream& out) const {
    if (!out)
      throw InputError(
          fmt::format("{} cannot be written; name another folder with --output", file_.string()));
  }
  fs::path file_;
};

/// What an increment changes, from a part of the way to another.
void apply(const LoadingPath& path, double from, double to, Input& input, const fs::path& scratch) {
  std::vector<std::string> overrides;
  for (const KeyPath& key : path.keys) overrides.push_back(key.at(to));
  if (!overrides.empty()) {
    // As it would be by hand: saved, and read with other settings.
    io::write_state(input.state, scratch);
    input.state = io::read_state(scratch, overrides);
    fs::remove(scratch);
    adapt_to(overrides, input.state);
  }
  for (const WallPath& wall : path.walls)
    relaxation::displace_wall(input.state, wall.wall, (to - from) * wall.displacement);
  if (path.strain)
    relaxation::strain_cell(input.state,
                            (to - from) * *path.strain * (Mat3::Identity() + from * *path.strain).inverse());
}

/// As of a velocity_gradient in a scene.
void check_strain(const Mat3& strain, const State& state) {
  const model::PeriodicCell& cell = state.model.cell;
  if (!cell.any())
    throw InputError("--load strain: the scene has no periodic cell; add periodic, or move walls");
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      if (strain(i, j) == 0) continue;
      for (const int axis : {i, j})
        if (!cell.periodic[static_cast<std::size_t>(axis)])
          throw InputError(fmt::format(
              "--load strain: {} in row {}, column {}, and the cell does not repeat along {}; write 0 there",
              strain(i, j), i + 1, j + 1, "xyz"[axis]));
    }
  if (!state.model.surfaces.empty())
    throw InputError(fmt::format("--load strain: {} cannot deform with the cell; take planes instead",
                                 state.model.surfaces.front().name));
}

void check_path(const LoadingPath& path, const State& state) {
  for (const WallPath& wall : path.walls)
    if (wall.wall >= static_cast<std::int32_t>(state.model.wall_count()))
      throw InputError(
          fmt::format("--load displacement.{}: there is no such wall; walls are numbered from 0 to {}",
                      wall.wall, static_cast<int>(state.model.wall_count()) - 1));
  if (path.strain) check_strain(*path.strain, state);
}

}  // namespace

std::string KeyPath::at(double part) const {
  std::vector<std::string> numbers;
  for (std::size_t k = 0; k < from.size(); ++k)
    numbers.push_back(fmt::format("{:.17g}", part == 1 ? to[k] : from[k] + part * (to[k] - from[k])));
  const std::string value = fmt::format("{}", fmt::join(numbers, ", "));
  return list ? fmt::format("{}=[{}]", key, value) : fmt::format("{}={}", key, value);
}

LoadingPath path_of(const std::vector<std::string>& loads) {
  LoadingPath path;
  std::vector<Mistake> mistakes;
  for (const std::string& text : loads)
    if (const std::string wrong = add_to(path, text); !wrong.empty())
      mistakes.push_back({"", 0, fmt::format("--load \"{}\": {}; {}", text, wrong, example)});
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  return path;
}

void relax_along(const Options& options) {
  const LoadingPath path = path_of(options.loads);
  const auto method = relaxation::find_method(options.method).value();
  Input input = read_input(options);
  print_notes(input.state.settings);
  check_path(path, input.state);
  const fs::path table_file = input.folder / (input.stem + "-load.csv");
  const int done = options.continues ? last_saved(input, table_file, options.increments) : 0;
  if (done > 0) {
    input.state = io::read_state(state_file(input, done));
    LoadTable::cut(table_file, done);
    fmt::print("continues behind {}\n", state_file(input, done).string());
  } else {
    remove_states(input);
  }
  const LoadTable table(input, table_file, done);
  nlohmann::ordered_json increments = nlohmann::ordered_json::array();
  const auto report = [&] {
    write_json(options.json, {{"increments", increments}, {"table", table_file.string()}});
  };
  const fs::path nearest = input.folder / (input.stem + "-load-nearest.h5");
  for (int k = done + 1; k <= options.increments; ++k) {
    const double part = part_at(k, options.increments);
    apply(path, part_at(k - 1, options.increments), part, input,
          input.folder / ("." + input.stem + "-load.part.h5"));
    const auto stop_short = [&] {
      save_equilibrium(input.state, nearest);
      report();
    };
    relaxation::RelaxResult result;
    try {
      result = relax_or_save(input.state, options.tolerance, options.max_steps, method, nearest);
    } catch (const SolverError&) {
      report();
      throw;
    }
    if (interrupted() != 0) {
      stop_short();
      throw Interrupted{interrupted()};
    }
    if (!result.converged) {
      stop_short();
      throw SolverError(fmt::format(
          "no equilibrium within {:g} was found at {:g} of the path (ratio {:.1e} after {}){}; "
          "the nearest state is in {}, the last equilibrium is increment {}",
          options.tolerance, part, mean_of(result), counted(result.explicit_steps, "step", "steps"),
          why_not(result, options.tolerance), nearest.string(), k - 1));
    }
    const fs::path file = state_file(input, k);
    const ContactStatuses statuses = statuses_of(input.state);
    table.add(k, part, result, input.state, statuses);
    save_equilibrium(input.state, file);
    increments.push_back({{"part", part},
                          {"steps", result.explicit_steps},
                          {"iterations", result.newton_iterations},
                          {"mean", mean_of(result)},
                          {"bonds_broken", input.state.breaks.size()},
                          {"state", file.string()}});
    input.state.breaks.clear();
    fmt::print("{:g} of the path: {}, {} of Newton, ratio {:.1e}, {}\n", part,
               counted(result.explicit_steps, "explicit step", "explicit steps"),
               counted(result.newton_iterations, "iteration", "iterations"), mean_of(result),
               text_of(statuses));
  }
  report();
  if (!options.petsc.empty()) petsc::require_options_used();
}

}  // namespace eigengrain::app

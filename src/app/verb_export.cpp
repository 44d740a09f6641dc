#include "eigengrain/assembly/linear_system.hpp"
#include "eigengrain/io/matrix_file.hpp"

#include "input.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace eigengrain::app {

void export_matrices(const Options& options) {
  std::vector<io::MatrixFormat> formats;
  for (const std::string& name : options.formats) formats.push_back(io::matrix_format(name));
  if (formats.empty()) formats = {io::MatrixFormat::hdf5, io::MatrixFormat::csv};
  const Question question = read_question(options);
  const std::filesystem::path scene = options.scene;
  const std::filesystem::path folder = options.output.empty()
                                           ? std::filesystem::path(scene.stem().string() + "-matrices")
                                           : std::filesystem::path(options.output);
  const assembly::LinearSystem system(question.model);
  const std::vector<std::filesystem::path> files =
      io::export_matrices(question.model, system, formats, folder);
  nlohmann::ordered_json report{{"unknowns", system.unknowns.size()},
                                {"contacts", system.elements.size()},
                                {"files", nlohmann::ordered_json::array()}};
  fmt::print("{}, {}\n", counted(system.unknowns.size(), "unknown", "unknowns"),
             counted(std::ssize(system.elements), "contact", "contacts"));
  for (const std::filesystem::path& file : files) {
    report["files"].push_back(file.string());
    fmt::print("{}\n", file.string());
  }
  write_json(options.json, report);
  print_notes(question.settings);
}

}  // namespace eigengrain::app

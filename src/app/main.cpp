#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/io/schema.hpp"
#include "eigengrain/io/suggest.hpp"

#include "verbs.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <new>

namespace eigengrain::app {
namespace {

constexpr int failure = 1;      // the scene or a solver
constexpr int usage_error = 2;  // the command line

/// A verb with what all verbs take.
CLI::App* add_verb(CLI::App& program, const std::string& name, const std::string& what, Options& options,
                   void (*run)(const Options&)) {
  CLI::App* verb = program.add_subcommand(name, what);
  verb->add_option("scene", options.scene, "scene file (YAML)")->required()->type_name("SCENE.yaml");
  verb->add_option("--json", options.json, "write the result there as JSON")->type_name("FILE");
  verb->add_option("--set", options.overrides,
                   "override a key of the scene, e.g. contacts.0.kn=2e5; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  verb->add_option_function<int>("--threads", set_threads, "threads; default: one a processor")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  verb->callback([&options, run] { run(options); });
  return verb;
}

/// A word that is no verb: said plainly, with the verb that was probably meant.
void require_known_verb(const CLI::App& program, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> verbs;
  for (const CLI::App* verb : program.get_subcommands({})) verbs.push_back(verb->get_name());
  if (std::find(verbs.begin(), verbs.end(), argv[1]) != verbs.end()) return;
  throw CLI::ValidationError(fmt::format("there is no verb \"{}\" here{} (verbs: {})", argv[1],
                                         io::did_you_mean(argv[1], verbs), fmt::join(verbs, ", ")));
}

int run(int argc, char** argv) {
  CLI::App program("Discrete elements with their true stiffness matrix.", "eigengrain");
  program.set_version_flag("--version", EIGENGRAIN_VERSION);
  program.require_subcommand(1);
  program.failure_message(CLI::FailureMessage::simple);
  Options options;
  add_verb(program, "check", "read a scene, report every mistake, say what the model will consist of",
           options, check);
#ifdef EIGENGRAIN_PETSC
  add_verb(program, "timestep", "estimated and true critical timestep", options, timestep)
      ->add_option("--petsc", options.petsc, "options for PETSc and SLEPc, e.g. \"-eps_ncv 80\"")
      ->type_name("OPTIONS");
#endif
  program.add_subcommand("schema", "print every key of a scene file, as Markdown")->callback([] {
    fmt::print("{}", io::schema_markdown());
  });
  try {
    require_known_verb(program, argc, argv);
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& success) {
    return program.exit(success);
  } catch (const CLI::ParseError& error) {
    program.exit(error);
    return usage_error;
  } catch (const InputError& error) {
    const std::size_t count = error.mistakes().size();
    if (count > 1) fmt::print(stderr, "{} mistakes:\n", count);
    fmt::print(stderr, "{}\n", error.what());
    return failure;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "not enough memory for this scene\n");
    return failure;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return failure;
  }
}

}  // namespace
}  // namespace eigengrain::app

// NOLINTNEXTLINE(bugprone-exception-escape): only where a message of a failure cannot be printed either
int main(int argc, char** argv) {
  return eigengrain::app::run(argc, argv);
}

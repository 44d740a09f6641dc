#include "eigengrain/base/error.hpp"
#include "eigengrain/base/parallel.hpp"
#include "eigengrain/io/schema.hpp"
#include "eigengrain/io/suggest.hpp"

#include "interrupt.hpp"
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

/// A verb with what all verbs take but the scene.
CLI::App* add_bare_verb(CLI::App& program, const std::string& name, const std::string& what, Options& options,
                        void (*run)(const Options&)) {
  CLI::App* verb = program.add_subcommand(name, what);
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

/// A verb with what all verbs take.
CLI::App* add_verb(CLI::App& program, const std::string& name, const std::string& what, Options& options,
                   void (*run)(const Options&)) {
  CLI::App* verb = add_bare_verb(program, name, what, options, run);
  verb->add_option("scene", options.scene, "scene (YAML), or a state that was saved (HDF5)")
      ->required()
      ->type_name("SCENE.yaml|STATE.h5");
  return verb;
}

void add_output(CLI::App& verb, Options& options) {
  verb.add_option("--output", options.output,
                  "folder of results; default: where the state lies, or the current one")
      ->type_name("FOLDER");
}

#ifdef EIGENGRAIN_PETSC
void add_petsc(CLI::App& verb, Options& options, const std::string& example) {
  verb.add_option("--petsc", options.petsc, fmt::format("options for PETSc and SLEPc, e.g. \"{}\"", example))
      ->type_name("OPTIONS");
}

void add_page(CLI::App& verb, Options& options) {
  verb.add_option("--output,--out", options.page, "write a page with pictures there (HTML, one file)")
      ->type_name("REPORT.html");
}

/// What an equilibrium is, and how long to look for it.
void add_equilibrium(CLI::App& verb, Options& options) {
  verb.add_option("--tolerance", options.tolerance, "mean unbalanced ratio to reach; default 1e-10")
      ->check(CLI::PositiveNumber);
  verb.add_option("--max-steps", options.max_steps, "explicit steps to spend; default 1000000")
      ->check(CLI::PositiveNumber);
}

/// `compare` and its subjects.
void add_compare(CLI::App& program, Options& options) {
  CLI::App* compare = program.add_subcommand("compare", "methods beside each other, as a table and a page");
  compare->require_subcommand(1);
  CLI::App* timesteps =
      add_bare_verb(*compare, "timesteps", "estimated against true critical timesteps, over many scenes",
                    options, compare_timesteps);
  timesteps
      ->add_option("scenes", options.scenes, "scenes, states, and folders of scenes (all *.yaml in them)")
      ->required()
      ->type_name("SCENE.yaml|STATE.h5|FOLDER");
  timesteps
      ->add_option("--sizes", options.sizes,
                   "measure the cost in packings of so many balls too, e.g. 100,1000,10000")
      ->delimiter(',')
      ->type_name("N,N,...");
  add_page(*timesteps, options);
  CLI::App* steps =
      add_verb(*compare, "steps", "what a larger step costs in accuracy", options, compare_steps);
  steps
      ->add_option("--fractions", options.fractions,
                   "steps, as parts of the limit; default 0.05,0.1,0.2,...,1")
      ->delimiter(',')
      ->type_name("F,F,...");
  steps->add_option("--time", options.time, "how long to run, s; default: as the scene says")
      ->check(CLI::PositiveNumber)
      ->type_name("SECONDS");
  add_page(*steps, options);
  CLI::App* relaxing =
      add_bare_verb(*compare, "relaxation", "ways to an equilibrium: ratio against seconds and work", options,
                    compare_relaxation);
  relaxing->add_option("scenes", options.scenes, "scenes, states, and folders of scenes (all *.yaml in them)")
      ->required()
      ->type_name("SCENE.yaml|STATE.h5|FOLDER");
  add_equilibrium(*relaxing, options);
  add_page(*relaxing, options);
}

/// What is asked of the elastic stiffness of an assembly.
void add_spectrum(CLI::App& program, Options& options) {
  SpectrumOptions& wanted = options.spectrum;
  CLI::App* modes = add_verb(program, "modes", "lowest and highest modes, and the density of states", options,
                             eigengrain::app::modes);
  add_petsc(*modes, options, "-eps_ncv 80");
  modes->add_option("--lowest", wanted.lowest, "how many that something resists; default 10")
      ->check(CLI::Range(0, 1000));
  modes->add_option("--highest", wanted.highest, "how many; default 10")->check(CLI::Range(0, 1000));
  CLI::Option* all = modes->add_flag("--all", wanted.all, "every mode, by a dense matrix");
  modes
      ->add_option("--shapes", options.modes_file,
                   "write the shapes of the lowest and highest ones, for ParaView")
      ->type_name("FILE.vtu")
      ->excludes(all);
  CLI::Option* density = modes->add_flag("--density", wanted.density, "the density of states, for any size");
  modes->add_option("--moments", wanted.moments, "of the density; default 512")->needs(density);
  modes->add_option("--vectors", wanted.vectors, "random vectors of the density; default 8")->needs(density);
  modes->add_option("--bins", wanted.bins, "of the density; default 50")->needs(density);
  CLI::App* rigidity = add_verb(program, "rigidity", "floppy modes and states of self-stress, counted",
                                options, eigengrain::app::rigidity);
  rigidity
      ->add_option(
          "--springs", wanted.springs,
          "all, sticking (contacts that slide have no shear) or normal (the frictionless count); default all")
      ->check(CLI::IsMember({"all", "sticking", "normal"}));
  rigidity->add_flag("--without-rattlers", wanted.without_rattlers, "of the balls that are held alone");
  add_verb(program, "moduli", "elastic stiffness tensor of a periodic assembly", options, moduli);
}
#endif

/// A word that is no verb (or subject of one): said plainly, with the one that was probably meant.
void require_known(const CLI::App& parent, const std::string& what, const std::string& all,
                   const std::string& word) {
  if (word.starts_with('-')) return;
  std::vector<std::string> known;
  for (const CLI::App* verb : parent.get_subcommands({})) known.push_back(verb->get_name());
  if (std::find(known.begin(), known.end(), word) != known.end()) return;
  throw CLI::ValidationError(fmt::format("there is no {0} \"{1}\" here{2} ({3}: {4})", what, word,
                                         io::did_you_mean(word, known), all, fmt::join(known, ", ")));
}

void require_known_words(const CLI::App& program, int argc, char** argv) {
  if (argc < 2) return;
  require_known(program, "verb", "verbs", argv[1]);
  for (const CLI::App* verb : program.get_subcommands({}))
    if (argc > 2 && verb->get_name() == argv[1] && !verb->get_subcommands({}).empty())
      require_known(*verb, fmt::format("subject of {}", argv[1]), "subjects", argv[2]);
}

int run_program(int argc, char** argv) {
  CLI::App program("Discrete elements with their true stiffness matrix.", "eigengrain");
  program.set_version_flag("--version", EIGENGRAIN_VERSION);
  program.require_subcommand(1);
  program.failure_message(CLI::FailureMessage::simple);
  Options options;
  add_verb(program, "check", "read a scene, report every mistake, say what the model will consist of",
           options, check);
  add_verb(program, "generate", "make the balls of a scene and write them to a file", options, generate)
      ->add_option("--output", options.output, "a packing, or, where the name ends in .h5, a state")
      ->required()
      ->type_name("FILE");
  add_verb(program, "measure", "stress, strain rate, porosity and fabric of regions", options, measure)
      ->add_option("--region", options.regions,
                   "a region instead of those of the scene, e.g. \"name: middle, sphere: {centre: [0, 0, "
                   "0.1], radius: 50 mm}\"; may be repeated")
      ->type_name("KEYS")
      ->allow_extra_args(false);
  add_output(*add_verb(program, "run", "the explicit cycle, to the end that the scene names", options, run),
             options);
#ifdef EIGENGRAIN_PETSC
  CLI::App* relaxing =
      add_verb(program, "relax", "equilibrium, by explicit cycles and Newton's method", options, relax);
  add_output(*relaxing, options);
  add_petsc(*relaxing, options, "-relax_ksp_type gmres");
  add_equilibrium(*relaxing, options);
  relaxing
      ->add_option("--method", options.method,
                   "hybrid (the default), or one alone: explicit (0.8 of PFC3D's step), tracked, scaled "
                   "(masses), fire, newton")
      ->type_name("NAME");
  CLI::Option* load =
      relaxing
          ->add_option("--load", options.loads,
                       "relax along a path: KEY=FROM..TO of the scene, displacement.WALL=[x, y, z] or "
                       "strain=[[..], [..], [..]] of the periodic cell; may be repeated")
          ->type_name("PATH")
          ->allow_extra_args(false);
  relaxing->add_option("--increments", options.increments, "of the path; default 10")
      ->check(CLI::Range(1, 9999))
      ->needs(load);
  relaxing->add_flag("--continue", options.continues, "go on behind the last increment that was saved")
      ->needs(load);
  relaxing
      ->add_option("--against", options.against,
                   "relax by this method too, e.g. explicit, and report how far the ends are apart")
      ->type_name("NAME");
  CLI::App* judging =
      add_verb(program, "timestep", "estimated and true critical timestep", options, timestep);
  add_petsc(*judging, options, "-eps_ncv 80");
  judging->add_flag("--tangent", options.tangent,
                    "what present forces and sliding contacts change of the elastic spectrum");
  judging->add_flag("--certify", options.certify,
                    "prove the true step by a sparse factorisation, however long that takes");
  judging->add_flag("--empirical", options.empirical,
                    "find the limit by running the cycle with one step after the other, too");
  CLI::Option* modes =
      judging
          ->add_option("--modes", options.modes,
                       "what limits the step: so many modes, the bodies and contacts that carry them, and "
                       "the step if these were heavier or softer")
          ->type_name("K")
          ->check(CLI::Range(1, 100));
  judging->add_option("--modes-to", options.modes_file, "write the shapes of these modes, for ParaView")
      ->type_name("FILE.vtu")
      ->needs(modes);
  judging
      ->add_option("--lift", options.lift,
                   "the least mass, on the fewest bodies, that makes this step stable (s), and what it does "
                   "to the slowest modes")
      ->type_name("DT");
  add_spectrum(program, options);
  add_compare(program, options);
#endif
  CLI::App* exporting =
      add_verb(program, "export", "K, M, B, D, contacts and the map of the unknowns, for other programs",
               options, export_matrices);
  exporting->add_option("--output", options.output, "folder of the files; default: SCENE-matrices, here")
      ->type_name("FOLDER");
  exporting->add_option("--format", options.formats, "mtx (MatrixMarket), petsc, h5, csv; default: h5,csv")
      ->delimiter(',')
      ->type_name("F,F,...");
  program.add_subcommand("schema", "print every key of a scene file, as Markdown")->callback([] {
    fmt::print("{}", io::schema_markdown());
  });
  try {
    require_known_words(program, argc, argv);
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
  } catch (const Interrupted& interrupt) {
    return 128 + interrupt.signal;
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
  return eigengrain::app::run_program(argc, argv);
}

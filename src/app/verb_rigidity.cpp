#include "eigengrain/petsc/session.hpp"
#include "eigengrain/spectrum/rigidity.hpp"

#include "input.hpp"
#include "text.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace eigengrain::app {

void rigidity(const Options& options) {
  const Question question = read_question(options);
  petsc::start();  // before the clock
  const std::string& springs = options.spectrum.springs;
  const spectrum::Rigidity found =
      spectrum::rigidity(question.model, {.springs = springs == "normal"     ? spectrum::Springs::normal
                                                     : springs == "sticking" ? spectrum::Springs::sticking
                                                                             : spectrum::Springs::all,
                                          .with_rattlers = !options.spectrum.without_rattlers});
  write_json(options.json, {{"bodies", found.bodies},
                            {"rattlers", found.rattlers},
                            {"set_aside", found.set_aside},
                            {"contacts", found.contacts},
                            {"springs", found.springs.size()},
                            {"unknowns", found.unknowns},
                            {"floppy", found.floppy},
                            {"trivial", found.trivial},
                            {"self_stress", found.self_stress},
                            {"excess", found.excess()},
                            {"counts_agree", found.counts_agree()},
                            {"seconds", found.seconds}});
  fmt::print("{} with {} unknowns, {} with {} springs; {}\n", counted(found.bodies, "body", "bodies"),
             found.unknowns, counted(found.contacts, "contact", "contacts"), found.springs.size(),
             counted(found.rattlers, "rattler", "rattlers"));
  fmt::print("floppy modes {} ({} of them rigid motions of all), states of self-stress {}\n", found.floppy,
             found.trivial, found.self_stress);
  fmt::print(
      "springs beyond isostaticity {} ({:+.4g} a body)\n", found.excess(),
      found.bodies > 0 ? static_cast<double>(found.excess()) / static_cast<double>(found.bodies) : 0.0);
  if (!found.counts_agree())
    fmt::print("the two decompositions do not agree (unknowns - springs = {}): singular values near zero\n",
               found.unknowns - std::ssize(found.springs));
  print_notes(question.settings);
}

}  // namespace eigengrain::app

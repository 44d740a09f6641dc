#include "verdict.hpp"

namespace eigengrain::app {

using report::Look;
using report::Mark;
using timestep::Claim;

Verdict verdict_on(const timestep::Estimate& estimate) {
  if (!estimate.safe) return Verdict::unsafe;
  switch (estimate.claim) {
    case Claim::proven:
      return Verdict::proven;
    case Claim::probable:
      return Verdict::probable;
    case Claim::none:
      break;
  }
  return Verdict::safe_here;
}

const char* text_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::proven:
      return "safe, proven";
    case Verdict::probable:
      return "safe but for a stated probability";
    case Verdict::safe_here:
      return "safe here";
    case Verdict::unsafe:
      break;
  }
  return "UNSAFE";
}

Look look_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::proven:
      return {Mark::circle, report::colour::blue, true};
    case Verdict::probable:
      return {Mark::diamond, report::colour::green, true};
    case Verdict::safe_here:
      return {Mark::square, report::colour::ink, false};
    case Verdict::unsafe:
      break;
  }
  return {Mark::triangle, report::colour::vermilion, true};
}

}  // namespace eigengrain::app

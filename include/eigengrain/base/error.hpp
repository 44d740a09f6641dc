#pragma once

#include <stdexcept>
#include <string>
#include <vector>

/// Three families: the user's mistake (InputError), a numerical method that did not do its work
/// (SolverError), and our own bug (the assertion of assert.hpp).
namespace eigengrain {

/// One mistake in what the user wrote: where it stands, and what is wrong and what to write instead.
struct Mistake {
  std::string file;     ///< as the user named it; empty where no file is involved
  int line = 0;         ///< 1-based; 0 where a line means nothing
  std::string message;  ///< value, what is wrong, what to write instead

  std::string text() const;
};

/// All mistakes found in an input, each with its place. what() lists them, one a line.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Mistake> mistakes);
  explicit InputError(std::string message);
  const std::vector<Mistake>& mistakes() const { return mistakes_; }

 private:
  std::vector<Mistake> mistakes_;
};

/// A solver (our own or a library's) failed; the message carries the library's own description.
class SolverError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace eigengrain

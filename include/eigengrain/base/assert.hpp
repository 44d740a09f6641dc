#pragma once

#include <sstream>
#include <string>

/// EIGENGRAIN_ASSERT(condition, values...): an invariant of our own code. On in the presets `dev` and
/// `audit`; a failure prints the condition, the place and the values, and aborts. Elsewhere it costs nothing.
namespace eigengrain::detail {

[[noreturn]] void assertion_failed(const char* condition, const char* file, int line, const char* names,
                                   const std::string& values);

template <class... Values>
std::string join_values(const Values&... values) {
  std::ostringstream out;
  out.precision(17);
  ((out << values << "; "), ...);
  return out.str();
}

}  // namespace eigengrain::detail

#ifdef EIGENGRAIN_ASSERTIONS
#define EIGENGRAIN_ASSERT(condition, ...)                                                     \
  do {                                                                                        \
    if (!(condition))                                                                         \
      ::eigengrain::detail::assertion_failed(#condition, __FILE__, __LINE__, #__VA_ARGS__,    \
                                             ::eigengrain::detail::join_values(__VA_ARGS__)); \
  } while (false)
#else
#define EIGENGRAIN_ASSERT(condition, ...) \
  do {                                    \
  } while (false)
#endif

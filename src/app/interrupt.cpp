#include "interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace eigengrain::app {
namespace {

volatile std::sig_atomic_t noted = 0;

void note(int signal) {
  noted = signal;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void note_interrupts() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, note);
}

int interrupted() {
  return noted;
}

}  // namespace eigengrain::app

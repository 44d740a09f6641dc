#pragma once

/// SIGINT and SIGTERM: long work stops at the next whole step, saves its state, and the program ends with 128
/// and the signal's number, as shells expect.
namespace eigengrain::app {

/// From now on the two signals are only noted; a second one ends the program at once.
void note_interrupts();

/// The number of the signal that was noted, or 0.
int interrupted();

/// Leaves a verb after an interrupt, when all is saved.
struct Interrupted {
  int signal = 0;
};

}  // namespace eigengrain::app

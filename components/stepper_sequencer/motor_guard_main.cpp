// motor_guard: started by stepper_sequencer with a pipe to it as standard input and the
// controller's port as standard output. Outlives it to stop the motor.
#include <signal.h>
#include <unistd.h>

#include <cstdio>

#include "hardware/stepper/motor_guard.hpp"

int main(int argc, char**) {
  if (argc > 1 || isatty(STDIN_FILENO) != 0) {
    std::fputs("motor_guard: is started by stepper_sequencer; there is nothing to do by hand\n",
               stderr);
    return 64;
  }
  // Only the sequencer's end is its own.
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) {
    signal(signal_number, SIG_IGN);
  }
  swivel::guard_motor(STDIN_FILENO, STDOUT_FILENO);
  return 0;
}

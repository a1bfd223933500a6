#include "io/interrupt.h"

#include <signal.h>

#include "io/atomic_file.h"
#include "io/child_process.h"

namespace aspic {
namespace {

// A signal handler can reach nothing but static storage.
volatile sig_atomic_t signal_count = 0;
struct sigaction old_interrupt, old_terminate, old_file_size;

void on_signal(int number) {
  signal_count = signal_count + 1;
  if (signal_count < 2) return;
  end_child_processes();  // one that runs on could make its file after all
  remove_temporary_files();
  ::signal(number, SIG_DFL);
  ::raise(number);  // delivered when this handler returns and the signal is unblocked
}

}  // namespace

InterruptGuard::InterruptGuard() {
  signal_count = 0;
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGINT, &action, &old_interrupt);
  ::sigaction(SIGTERM, &action, &old_terminate);
  action.sa_handler = SIG_IGN;
  ::sigaction(SIGXFSZ, &action, &old_file_size);
}

InterruptGuard::~InterruptGuard() {
  ::sigaction(SIGINT, &old_interrupt, nullptr);
  ::sigaction(SIGTERM, &old_terminate, nullptr);
  ::sigaction(SIGXFSZ, &old_file_size, nullptr);
}

bool InterruptGuard::interrupted() const {
  return signal_count > 0;
}

}  // namespace aspic

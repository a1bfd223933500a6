#include "io/program.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <exception>
#include <new>
#include <string_view>

#include "base/end_request.h"
#include "base/result.h"
#include "io/atomic_file.h"
#include "io/child_process.h"
#include "io/console.h"

namespace aspic {
namespace {

constexpr int failed = static_cast<int>(ErrorCode::io);
constexpr std::string_view no_memory =
    "aspic: there is not enough memory. Use a smaller scene or image, close other programs, or raise the "
    "limit of this process (ulimit -v). No incomplete file was left behind.\n";

/// Writes without allocating, also from a signal handler.
void write_plainly(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

void open_standard_streams() {
  // The lowest free descriptor is taken, which is the closed one: those below are open by now.
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) == -1 && errno == EBADF) (void)::open("/dev/null", O_RDWR);
  }
}

void on_fatal_signal(int number) {
  end_child_processes();
  remove_temporary_files();
  std::array<char, 2> digits = {static_cast<char>('0' + number / 10), static_cast<char>('0' + number % 10)};
  write_plainly("aspic: the program ended by signal ");
  write_plainly({digits.data() + (number < 10 ? 1 : 0), number < 10 ? 1u : 2u});
  write_plainly(
      ", in a driver or in aspic itself; its temporary files were removed. If little memory or stack is "
      "left, raise its limit (ulimit -v, ulimit -s). If a graphics driver is at fault, use the backend "
      "cpu.\n");
  ::signal(number, SIG_DFL);
  ::raise(number);
}

/// For exceptions that leave a thread or a destructor: nothing unwinds there.
[[noreturn]] void on_terminate() {
  end_child_processes();
  remove_temporary_files();
  try {
    if (const auto exception = std::current_exception()) std::rethrow_exception(exception);
    write_plainly("aspic: an internal error ended the program.\n");
  } catch (const std::bad_alloc&) {
    write_plainly(no_memory);
  } catch (const std::exception& exception) {
    write_plainly("aspic: unexpected error: ");
    write_plainly(exception.what());
    write_plainly("\n");
  } catch (...) {
    write_plainly("aspic: an internal error ended the program.\n");
  }
  ::_exit(failed);
}

void handle_signals() {
  ::signal(SIGPIPE, SIG_IGN);
  ::signal(SIGXFSZ, SIG_IGN);
  // A stack that has overflowed cannot hold the handler's frame.
  static std::array<char, 1 << 15> stack;
  const stack_t alternative = {stack.data(), 0, stack.size()};
  ::sigaltstack(&alternative, nullptr);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) {
    struct sigaction action = {};
    ::sigaction(number, nullptr, &action);
    if (action.sa_handler != SIG_DFL) continue;  // a sanitizer's report says more
    action.sa_handler = on_fatal_signal;
    action.sa_flags = SA_ONSTACK;
    sigemptyset(&action.sa_mask);
    ::sigaction(number, &action, nullptr);
  }
  std::set_terminate(on_terminate);
}

// A signal handler can reach nothing but static storage.
volatile sig_atomic_t signal_count = 0;
struct sigaction old_interrupt, old_terminate, old_hangup;

void on_signal(int number) {
  end_requested = true;
  if (number == SIGHUP) return;
  signal_count = signal_count + 1;
  if (signal_count < 2) return;
  end_child_processes();  // one that runs on could make its file after all
  remove_temporary_files();
  ::signal(number, SIG_DFL);
  ::raise(number);  // delivered when this handler returns and the signal is unblocked
}

}  // namespace

int run_program(const std::function<int()>& work) {
  open_standard_streams();
  handle_signals();
  try {
    return work();
  } catch (const std::bad_alloc&) {
    write_plainly(no_memory);
  } catch (const std::exception& exception) {
    try {
      print_message(
          fmt::format("unexpected error: {}. No incomplete file was left behind.", exception.what()));
    } catch (const std::bad_alloc&) {
      write_plainly(no_memory);
    }
  }
  end_child_processes();
  remove_temporary_files();
  return failed;
}

InterruptGuard::InterruptGuard(At at_once) {
  signal_count = at_once == At::first_signal ? 1 : 0;
  end_requested = false;
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGINT, &action, &old_interrupt);
  ::sigaction(SIGTERM, &action, &old_terminate);
  ::sigaction(SIGHUP, nullptr, &old_hangup);
  if (old_hangup.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);
}

InterruptGuard::~InterruptGuard() {
  ::sigaction(SIGINT, &old_interrupt, nullptr);
  ::sigaction(SIGTERM, &old_terminate, nullptr);
  ::sigaction(SIGHUP, &old_hangup, nullptr);
  end_requested = false;
}

bool InterruptGuard::interrupted() const {
  return end_requested;
}

}  // namespace aspic

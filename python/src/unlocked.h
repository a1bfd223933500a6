#pragma once
// Work without the GIL, up to the interpreter's end and across fork().
#include <nanobind/nanobind.h>

#include <atomic>
#include <cstdint>

namespace aspic::python {

namespace nb = nanobind;

/// Gives the GIL up for as long as it lives. A thread that meets the interpreter's end on either side stays
/// in it for ever: CPython would end it by unwinding through C++.
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

  /// Whether the interpreter ends: what takes long stops, and nothing may touch Python.
  static bool ending() { return ending_; }
  /// For atexit: from now on ending() is true. Waits up to 5 s for the threads that are without the GIL.
  static void end();

 private:
  PyThreadState* state_;
  static inline std::atomic<bool> ending_ = false;
  static inline std::atomic<int> threads_ = 0;  // in the scope of one
};

/// Forks between the start of the program and this process.
std::uint64_t forks();

}  // namespace aspic::python

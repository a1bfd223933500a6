#pragma once
// The treatment of denormal numbers that all backends share (docs/determinism.md, "Denormal numbers").
#include <cstdint>

namespace aspic {

/// Sets the floating-point environment of the calling thread for as long as it lives: denormal operands count
/// as zero, denormal results become zero of the same sign, operations round to nearest and never trap. The
/// destructor restores the caller's environment with its exception flags. Threads started meanwhile inherit
/// the environment, those of software rasterizers included. x86-64 and 64-bit ARM; no effect elsewhere
/// (WebAssembly has no such mode).
class FlushDenormals {
 public:
  /// False: changes nothing.
  explicit FlushDenormals(bool on = true);
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

  /// Whether one lives on this thread, or on the one that started it at that time.
  static bool is_on();

 private:
  std::uint64_t before_ = 0;
};

/// In steps: flushed to zero as on every backend, or kept as WebAssembly does, for comparison.
enum class Denormals { flushed, kept };

/// Whether denormal numbers are flushed on this thread, tried by an operation.
bool flushes_denormals();

}  // namespace aspic

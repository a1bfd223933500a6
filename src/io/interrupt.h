#pragma once
// Ctrl-C and SIGTERM as a flag that long work polls between batches, so that files are completed.

namespace aspic {

/// While one lives, the first SIGINT or SIGTERM only raises the flag; a second one removes temporary files
/// and ends the process at once, as the signal would have. SIGXFSZ is ignored, so that a file past the size
/// limit is an error of write() like a full disk. At most one may live at a time; the old handlers return
/// with its end.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether a signal has come since the guard was made.
  bool interrupted() const;
};

}  // namespace aspic

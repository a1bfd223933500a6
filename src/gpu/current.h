#pragma once
// Which context the calls of this thread go to.
#include "base/flush_denormals.h"
#include "base/result.h"
#include "gpu/context.h"

namespace aspic::gl {

/// Makes a context current for as long as it lives, and then the one that was current before. Nothing but a
/// comparison happens where the context is current already. Every public call of what owns objects of OpenGL
/// begins with one, so that any number of solvers and images may be used in turn. Denormal numbers are
/// flushed meanwhile, on the host and by software rasterizers that compute on this thread.
class Current {
 public:
  explicit Current(Context& context) : status_(context.enter(before_)) {}
  ~Current() {
    if (before_.context) Context::put_back(before_);
  }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;

  /// Error (no_device): the context is at work on another thread; then no call may be made for it.
  const Status& status() const { return status_; }

 private:
  FlushDenormals flush_;
  Context::Place before_;  // before status_, which fills it in
  Status status_;
};

}  // namespace aspic::gl

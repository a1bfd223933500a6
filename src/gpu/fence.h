#pragma once
// Whether the device has got so far: asked without waiting, or waited for within bounds.
#include <memory>

#include "base/result.h"
#include "gpu/context.h"

namespace aspic::gl {

/// Tells when the device has done all calls before it; owns a GLsync. Its context must outlive it.
struct DeleteFence {
  Context* context = nullptr;
  void operator()(void* sync) const;
};
using Fence = std::unique_ptr<void, DeleteFence>;
/// A fence after all calls of the context, which is current, so far; they go to the device.
Fence fence(Context& context);

/// What a device may take for one queue of work [s]. Systems end work that takes a card much less than this.
inline constexpr int longest_wait = 600;

/// Whether the device has passed the fence; true also where no wait for it would ever end. Never waits.
bool passed(Context& context, const Fence& fence);
/// Waits for the device. Error (no_device): it was lost, or has not answered for longest_wait; then the
/// context counts as lost. Or the context is in use on another thread.
Status wait_for(Context& context, const Fence& fence);

}  // namespace aspic::gl

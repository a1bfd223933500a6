#pragma once
// Everything that a frame shows of a solver besides its state: for videos and single images.
#include "aspic/files.h"
#include "render/frame_painter.h"
#include "scene/follow.h"

namespace aspic {

/// Size and options of a frame.
struct FrameRequest {
  ImageSize size;
  bool text = true;  ///< parameters, time and scales are written on it
};

/// Camera, text and arrows at the solver's current state. `copy` is that state if needs_copy(), else it may
/// be empty.
RunView run_view(const Scene& scene, const Following& following, const Solver& solver, std::uint64_t step,
                 const State& copy, const FrameRequest& request);

/// Whether the followed body or arrows need a copy of the state.
bool needs_copy(const Scene& scene, const Following& following);

}  // namespace aspic

#pragma once
// What a picture shows of a solver's state: for films and for single pictures.
#include "aspic/run.h"
#include "run/picture_painter.h"
#include "scene/follow.h"

namespace aspic {

/// How a picture is asked for.
struct PictureWish {
  PictureSize size;
  bool text = true;  ///< parameters, time and scales are written on it
};

/// Camera, text and arrows of the state that the solver is at. `copy` is that state where the view needs one
/// (needs_copy()), and may be empty elsewhere.
ShownRun shown_run(const Scene& scene, const Following& following, const Solver& solver, std::uint64_t step,
                   const State& copy, const PictureWish& wish);

/// Whether what is followed, or arrows, need numbers of the state.
bool needs_copy(const Scene& scene, const Following& following);

}  // namespace aspic

#pragma once
// The arrows of a frame, from a state.
#include "aspic/inputs.h"
#include "aspic/scene.h"
#include "aspic/state.h"
#include "model/model.h"
#include "render/arrows.h"

namespace aspic {

/// The arrows of a view at a state of the model: forces of particle_force() and contacts_of(). A cube with
/// more than twelve particles per edge shows every second, third … along each edge; another body with more
/// than a thousand particles shows every n-th. `inputs` are those of the solver. Empty if the view has none.
ArrowSet arrows_of(const Model& model, const State& state, const ArrowSettings& wanted,
                   const Inputs& inputs = {});

}  // namespace aspic

#pragma once
// What the arrows of a picture show, from a state.
#include "aspic/inputs.h"
#include "aspic/scene.h"
#include "aspic/state.h"
#include "model/model.h"
#include "render/arrows.h"

namespace aspic {

/// The arrows that a view asks for at a state of the model: forces as particle_force() and contacts_of() say.
/// Of a cube with more than twelve particles per edge every second, third … along each edge is shown, of
/// another body with more than a thousand particles every so-manieth. `inputs` are those of the solver. None
/// where the view asks for none.
ArrowSet arrows_of(const Model& model, const State& state, const ArrowSettings& wanted,
                   const Inputs& inputs = {});

}  // namespace aspic

#pragma once
// A state as VTK PolyData in XML, which ParaView, PyVista and VTK read: particles and balls as points, balls
// as vertices, springs as lines, surfaces as quadrilaterals.
#include "aspic/state.h"
#include "base/result.h"
#include "io/atomic_file.h"
#include "model/model.h"

namespace aspic {

/// Writes a state of the model; docs/files.md names the arrays. Numbers of the state keep their bits, in its
/// precision. Does not commit. Errors: diverged if a number is not finite; those of AtomicFile::write.
Status write_state_vtp(AtomicFile& file, const Model& model, const State& state);

}  // namespace aspic

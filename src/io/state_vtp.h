#pragma once
// A state as VTK PolyData in XML, which ParaView, PyVista and VTK read: particles and balls as points, balls
// as vertices, springs as lines, surfaces as quadrilaterals, meshes as triangles.
#include "aspic/files.h"
#include "base/result.h"
#include "io/atomic_file.h"

namespace aspic {

/// Writes a state; docs/files.md names the arrays. Numbers of the state keep their bits, in its precision,
/// and what follows from them is rounded to it. Does not commit. Errors: diverged if a number is not finite;
/// those of AtomicFile::write.
Status write_state_vtp(AtomicFile& file, const Sample& sample);

}  // namespace aspic

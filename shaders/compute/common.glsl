// What every kernel of the solver shares: arithmetic whose order of operations is fixed (docs/determinism.md), the
// step it works on, and the word that stops it.
#include "compute/dispatch.glsl"
#include "compute/exact.glsl"

layout(location = LOCATION_STEP) uniform uint step_index;
layout(location = LOCATION_STAGE) uniform uint stage_index;

layout(std430, binding = BINDING_CONTROL) restrict buffer ControlBlock { Control control; };

// (aₓbₓ + a_y b_y) + a_z b_z
float dot3(vec3 a, vec3 b) {
  precise float sum = (a.x * b.x + a.y * b.y) + a.z * b.z;
  return sum;
}

// √((aₓ² + a_y²) + a_z²)
float norm3(vec3 a) {
  precise float root = exact_sqrt(dot3(a, a));
  return root;
}

// An earlier step diverged: its start state must stay as it is.
bool halted() { return control.bad_step < step_index; }

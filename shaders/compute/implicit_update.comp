// Implicit Euler, conjugate gradients: δ += α·p, r −= α·A·p, z = B⁻¹·r in the free directions, and r·z; before the
// first iteration the same with the prescribed part of δ, if there is one.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit.glsl"
#include "compute/terms/implicit_springs.glsl"
#include "compute/implicit_block.glsl"
#include "compute/reduction.glsl"

// Returns 0, r·z, 0, 0.
vec4 update(uint i) {
  precise float alpha = prescribing ? 1.0 : solve.alpha;
  precise vec3 along_p = alpha * search[i].xyz;
  precise vec3 delta = own(OWN_DELTA, i) + along_p;
  if (solve.updates == 0u) delta = prescribing ? own(OWN_PRESCRIBED, i) : along_p;
  precise vec3 r = own(OWN_RESIDUAL, i) - alpha * own(OWN_PRODUCT, i);
  precise vec3 z = times(DiagonalBlock(own(OWN_INVERSE_A, i), own(OWN_INVERSE_B, i)), r);
  z = free_part(own4(OWN_GROUND, i), z);
  set_own(OWN_DELTA, i, delta);
  set_own(OWN_RESIDUAL, i, r);
  set_own(OWN_Z, i, z);
  return vec4(0.0, dot3(r, z), 0.0, 0.0);
}

void main() {
  if (enter() != PHASE_CG) return;
  uint i = item_index();
  precise vec4 element = vec4(0.0);
  if (i < particle_count) element = update(i);
  precise vec4 total;
  if (!reduce(element, total) || gl_LocalInvocationIndex != 0u) return;
  ++solve.updates;
  if (prescribing) {
    precise float enough = (solve.forcing * solve.forcing) * total.y;
    solve.enough = enough;
    solve.rz = total.y;
    if (!(total.y > 0.0)) solve.phase = PHASE_EVALUATE;
  } else if (!(total.y > solve.enough) || solve.cg == max_cg) {
    solve.phase = PHASE_EVALUATE;
  } else {
    precise float beta = exact_div(total.y, float(solve.rz));
    solve.beta = beta;
    solve.rz = total.y;
  }
}

// Springs and pulls in the matrix of implicit Euler: linearized() of src/physics/springs/law.h and SpringJacobian of
// src/physics/diagonal_block.h in GLSL.
#include "compute/terms/pulls.glsl"

// −h·∂f/∂v' as seen from one end: H·d = across·d + (along − across)·n(n·d). A compressed spring's negative part across
// its axis is left out (Choi and Ko, 2002).
struct SpringJacobian {
  float along;   // [kg]
  float across;  // [kg]
  vec3 n;        // unit vector along the spring
};

// Force on the end the vectors point to, and the Jacobian: e = spring vector at the step's end, v = relative velocity.
vec3 linearized(SpringClass spring, vec3 e, vec3 v, out SpringJacobian H) {
  H = SpringJacobian(0.0, 0.0, vec3(0.0));
  precise float q, s;
  if (!spring_tension(spring, e, v, q, s)) return vec3(0.0);
  precise vec3 f = -((s * q) * e);
  precise float along = (time_step * time_step) * spring.stiffness + time_step * spring.damping;
  precise float stretched = (time_step * time_step) * (s * q);
  precise vec3 n = q * e;
  H = SpringJacobian(along, s > 0.0 ? stretched : 0.0, n);
  return f;
}

// The same of a pull, for its particle where the step began and its trial velocity: the other end neither moves nor
// gives way.
vec3 linearized(Pull pull, vec3 x, vec3 v, out SpringJacobian H) {
  precise vec3 e = (x - pull.anchor.xyz) + time_step * v;
  precise vec3 f = linearized(spring_of(pull), e, v, H);
  return f;
}

vec3 times(SpringJacobian H, vec3 d) {
  precise float along_n = (H.along - H.across) * dot3(H.n, d);
  precise vec3 product = H.across * d + along_n * H.n;
  return product;
}

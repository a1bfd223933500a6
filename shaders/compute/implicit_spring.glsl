// A spring in the linear system, see src/cpu_reference/implicit_euler.h.
#include "compute/pull.glsl"

// −h·∂f/∂v' as seen from one end: H·d = across·d + (along − across)·n(n·d). A compressed spring's negative part across
// its axis is left out (Choi and Ko, 2002).
struct SpringJacobian {
  float along;   // [kg]
  float across;  // [kg]
  vec3 n;        // unit vector along the spring
};

// Force on the end the vectors point to, and the Jacobian: e = spring vector at the step's end, v = relative velocity.
vec3 linearised(SpringClass spring, vec3 e, vec3 v, out SpringJacobian H) {
  H = SpringJacobian(0.0, 0.0, vec3(0.0));
  precise vec2 root = exact_sqrt_rcp(dot3(e, e));
  precise float L = root.x;
  if (L == 0.0 || (spring.cord != 0u && L < spring.rest_length)) return vec3(0.0);
  precise float q = root.y;
  precise float s = spring.stiffness * (L - spring.rest_length) + spring.damping * (dot3(v, e) * q);
  precise vec3 f = -((s * q) * e);
  precise float along = (time_step * time_step) * spring.stiffness + time_step * spring.damping;
  precise float stretched = (time_step * time_step) * (s * q);
  precise vec3 n = q * e;
  H = SpringJacobian(along, s > 0.0 ? stretched : 0.0, n);
  return f;
}

// The same of a pull, for its particle where the step began and its trial velocity: the other end neither moves nor
// gives way.
vec3 linearised_pull(Pull pull, vec3 x, vec3 v, out SpringJacobian H) {
  precise vec3 e = (x - pull.anchor.xyz) + time_step * v;
  precise vec3 f = linearised(spring_of(pull), e, v, H);
  return f;
}

vec3 times(SpringJacobian H, vec3 d) {
  precise float along_n = (H.along - H.across) * dot3(H.n, d);
  precise vec3 product = H.across * d + along_n * H.n;
  return product;
}

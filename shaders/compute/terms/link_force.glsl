// not-exact: with ASPIC_FAST, for --arithmetic fast; without, the exact spring alone
// What a spring does to the end at x_a, v_a in a step: xyz: force [N], w: s [N]. Exact, it is spring_force. Fast:
//   f = −(k − q·(k·r − c·((v·e)·q)))·e,  q ≈ 1/L
// with the device's reciprocal root, in the order and with the fused operations that its compiler likes best. A spring
// shorter than 1e-15 m counts as that long, so that one of no length pulls nowhere.
#include "compute/terms/springs.glsl"

#ifdef ASPIC_FAST
vec4 link_force(SpringClass spring, vec3 x_a, vec3 v_a, vec3 x_b, vec3 v_b) {
  vec3 e = x_a - x_b;
  float square = max(dot(e, e), 1e-30);
  float q = inversesqrt(square);
  float k = spring.stiffness;
  float factor = k - q * (k * spring.rest_length - spring.damping * (dot(v_a - v_b, e) * q));
  float L = square * q;
  if (spring.cord != 0u && L < spring.rest_length) factor = 0.0;
  return vec4(-factor * e, factor * L);
}
#else
vec4 link_force(SpringClass spring, vec3 x_a, vec3 v_a, vec3 x_b, vec3 v_b) {
  return spring_force(spring, x_a, v_a, x_b, v_b);
}
#endif

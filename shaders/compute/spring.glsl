// The damped spring (docs/physics.md, section 1): force on the end at x_a, v_a from the end at x_b, v_b.
//   e = x_a − x_b,  L = |e|,  q = 1/L,  s = k(L − r) + c(((v_a − v_b)·e)·q),  f = −((s·q)·e)
// xyz: force [N], w: s [N]. A spring of no length and a cord that hangs slack pull nowhere. Exchanging the ends
// negates e and v_a − v_b exactly, so the force is exactly opposite and either end may evaluate it.
vec4 spring_force(SpringClass spring, vec3 x_a, vec3 v_a, vec3 x_b, vec3 v_b) {
  precise vec3 e = x_a - x_b;
  precise vec3 v = v_a - v_b;
  precise vec2 root = exact_sqrt_rcp(dot3(e, e));
  precise float L = root.x;
  if (L == 0.0 || (spring.cord != 0u && L < spring.rest_length)) return vec4(0.0);
  precise float q = root.y;
  precise float s = spring.stiffness * (L - spring.rest_length) + spring.damping * (dot3(v, e) * q);
  precise vec3 f = -((s * q) * e);
  return vec4(f, s);
}

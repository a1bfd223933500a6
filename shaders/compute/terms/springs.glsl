// The damped spring (docs/physics.md, section 1): src/physics/springs/law.h in GLSL.

// q = 1/|e| [1/m] and the tension s = k(L − r) + c((v·e)·q) [N] of a spring with e = x_a − x_b and v = v_a − v_b. Returns
// whether it acts: a spring of no length and a cord that hangs slack pull nowhere.
bool spring_tension(SpringClass spring, vec3 e, vec3 v, out precise float q, out precise float s) {
  q = 0.0;
  s = 0.0;
  precise vec2 root = exact_sqrt_rcp(dot3(e, e));
  precise float L = root.x;
  if (L == 0.0 || (spring.cord != 0u && L < spring.rest_length)) return false;
  q = root.y;
  s = spring.stiffness * (L - spring.rest_length) + spring.damping * (dot3(v, e) * q);
  return true;
}

// xyz: force on the end at x_a, v_a [N], −((s·q)·e); w: s. Exchanging the ends negates e and v exactly, so the force is exactly
// opposite and either end may evaluate it.
vec4 spring_force(SpringClass spring, vec3 x_a, vec3 v_a, vec3 x_b, vec3 v_b) {
  precise vec3 e = x_a - x_b;
  precise vec3 v = v_a - v_b;
  precise float q, s;
  if (!spring_tension(spring, e, v, q, s)) return vec4(0.0);
  precise vec3 f = -((s * q) * e);
  return vec4(f, s);
}

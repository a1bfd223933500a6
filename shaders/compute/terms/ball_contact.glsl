// Contact of balls (docs/balls.md): src/physics/balls/law.h in GLSL.

// xyz: t = s/|s|; w: the friction impulse along it that a normal impulse allows, for bodies that give way by
// `compliance`. Zero without slip.
vec4 friction_impulse(vec3 s, float normal_impulse, float friction, float compliance) {
  precise float slip = norm3(s);
  if (!(slip > 0.0)) return vec4(0.0);
  precise float limit = friction * normal_impulse;
  precise float stop = exact_div(slip, compliance);
  precise float q = exact_div(1.0, slip);
  precise vec3 t = q * s;
  return vec4(t, limit < stop ? limit : stop);
}

// Two bodies as one of them sees it: e = its center − the other's, reach = the sum of the radii. xyz: normal; w: gap.
vec4 pair_gap(vec3 e, float reach, bool up) {
  precise float L = norm3(e);
  precise float d = L - reach;
  if (L == 0.0) return vec4(0.0, up ? 1.0 : -1.0, 0.0, d);
  precise float q = exact_div(1.0, L);
  precise vec3 n = q * e;
  return vec4(n, d);
}

// What a body receives from its partners: impulse, and the part of it at the surface times the normal.
struct Impulse {
  vec3 linear;
  vec3 turning;
};

// An acting pair as one body sees it. n: towards it; dv, dv_0: its velocity less the partner's, now and at the start
// of the step; rolling: Σ R·ω of the balls; weight: c₁w₁ + c₂w₂; slip_weight: the same and Σ c·R²/I.
Impulse impact(vec3 n, vec3 dv, vec3 dv_0, vec3 rolling, float weight, float slip_weight) {
  precise float u = dot3(dv, n);
  precise float approach = -dot3(dv_0, n);
  precise float e = approach < resting_speed ? 0.0 : ball_restitution;
  precise float lost = (1.0 + e) * -u;
  precise float J = exact_div(lost, weight);
  precise vec3 linear = J * n;
  precise vec3 turning = vec3(0.0);
  if (ball_spin != 0u) {
    precise vec3 s = (dv - u * n) - cross3(rolling, n);
    precise vec4 friction = friction_impulse(s, J, ball_friction, slip_weight);
    linear = linear - friction.w * friction.xyz;
    turning = friction.w * cross3(n, friction.xyz);
  }
  return Impulse(linear, turning);
}

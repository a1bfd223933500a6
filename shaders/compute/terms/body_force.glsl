// Gravity and linear drag on a particle or ball of mass m and velocity v [N]: src/physics/body_force.h.
vec3 body_force(float m, vec3 v) {
  precise vec3 f = m * gravity.xyz - (drag * m) * v;
  return f;
}

// The mass in the matrix of implicit Euler [kg].
float implicit_mass(float m) {
  precise float mass = m + time_step * (drag * m);
  return mass;
}

// src/physics/body_force.h: gravity and the medium's resistance on a particle or ball of mass m and velocity v.
#define drag resistance_constants.x  // γ [1/s]

// [N]
vec3 body_force(float m, vec3 v) {
  precise vec3 f = m * gravity.xyz - (drag * m) * v;
  return f;
}

// The mass in the matrix of implicit Euler [kg].
float implicit_mass(float m, vec3 v) {
  precise float mass = m + time_step * (drag * m);
  return mass;
}

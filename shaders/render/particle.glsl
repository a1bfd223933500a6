// A particle as the solvers hold it (shaders/compute/layout.glsl).
struct Particle {
  vec4 position;  // x [m]; w: inverse mass [1/kg], 0 = pinned
  vec4 velocity;  // v [m/s]; w: mass [kg]
};

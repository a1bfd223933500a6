// A ball as the solvers hold it (shaders/compute/layout.glsl).
struct Ball {
  vec4 position;        // x [m]; w: radius R [m]
  vec4 velocity;        // v [m/s]; w: inverse mass [1/kg], 0 while it is not launched
  vec4 spin;            // ω [rad/s]
  vec4 start_velocity;  // the solver's own
};

// How many times as far as its target the eye looks: balls beyond are left out where one could spoil the picture of all.
const float far_share = 3.0;

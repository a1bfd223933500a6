// Moving terrain: where it is at both ends of the step under way, from the table that the host makes in double precision
// (src/gpu_solver/step_inputs.h). Kernels of scenes in which nothing moves do without: terrain that does not move keeps every bit.
#define AT_START 0u
#define AT_END 1u

#ifdef ASPIC_MOTION
layout(std140, binding = BINDING_POSES) uniform PoseBlock {
  uint pose_first;  // step of the first row
  uint pose_count;  // terrains that move: poses in a row
  uint pose_padding0, pose_padding1;
  Pose poses[MAX_POSES];
};

bool moves(uint t) { return terrains[t].motion != 0u; }

Pose pose_of(uint t, uint end) {
  uint row = steps_done() - pose_first + end;
  return poses[row * pose_count + terrains[t].motion - 1u];
}

// A place as the displaced terrain sees it.
vec3 place(uint t, uint end, vec3 x) {
  if (!moves(t)) return x;
  precise vec3 seen = x - pose_of(t, end).offset.xyz;
  return seen;
}

// A velocity as it sees it, v − V, and the way back at the step's end.
vec3 relative_velocity(uint t, uint end, vec3 v) {
  if (!moves(t)) return v;
  precise vec3 seen = v - pose_of(t, end).velocity.xyz;
  return seen;
}

vec3 absolute_velocity(uint t, vec3 v) {
  if (!moves(t)) return v;
  precise vec3 seen = v + pose_of(t, AT_END).velocity.xyz;
  return seen;
}

// The speed of terrain t along a direction at the step's end.
float speed_along(uint t, vec3 direction) {
  if (!moves(t)) return 0.0;
  return dot3(pose_of(t, AT_END).velocity.xyz, direction);
}
#else
bool moves(uint t) { return false; }
vec3 place(uint t, uint end, vec3 x) { return x; }
vec3 relative_velocity(uint t, uint end, vec3 v) { return v; }
vec3 absolute_velocity(uint t, vec3 v) { return v; }
float speed_along(uint t, vec3 direction) { return 0.0; }
#endif

float distance_at_start(uint t, vec3 x) { return distance_to(t, place(t, AT_START, x)); }
float distance_at_end(uint t, vec3 x) { return distance_to(t, place(t, AT_END, x)); }
vec4 gap_at_start(uint t, vec3 x) { return gap(t, place(t, AT_START, x)); }
vec4 gap_at_end(uint t, vec3 x) { return gap(t, place(t, AT_END, x)); }

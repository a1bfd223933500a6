// Plane with a hole, src/model/shapes/plane_with_hole.h in GLSL. geometry: (point, radius), normal, center.
float plane_with_hole_distance(uint t, vec3 x) {
  precise vec3 from_point = x - terrains[t].geometry[0].xyz;
  precise vec3 e = x - terrains[t].geometry[2].xyz;
  precise float over_plane = dot3(terrains[t].geometry[1].xyz, from_point);
  precise float within_bowl = terrains[t].geometry[0].w - norm3(e);
  return within_bowl > over_plane ? within_bowl : over_plane;
}

vec4 plane_with_hole_gap(uint t, vec3 x) {
  precise vec3 normal = terrains[t].geometry[1].xyz;
  precise vec3 from_point = x - terrains[t].geometry[0].xyz;
  precise float over_plane = dot3(normal, from_point);
  precise vec3 e = x - terrains[t].geometry[2].xyz;
  precise float L = norm3(e);
  precise float within_bowl = terrains[t].geometry[0].w - L;
  if (!(within_bowl > over_plane)) return vec4(normal, over_plane);
  if (L == 0.0) return vec4(0.0, 1.0, 0.0, within_bowl);
  precise float q = exact_div(1.0, L);
  precise vec3 n = -(q * e);
  return vec4(n, within_bowl);
}

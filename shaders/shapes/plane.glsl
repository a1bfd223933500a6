// Plane, src/model/shapes/plane.h in GLSL. geometry: point, normal.
float plane_distance(uint t, vec3 x) {
  precise vec3 e = x - terrains[t].geometry[0].xyz;
  return dot3(terrains[t].geometry[1].xyz, e);
}

vec4 plane_gap(uint t, vec3 x) {
  return vec4(terrains[t].geometry[1].xyz, plane_distance(t, x));
}

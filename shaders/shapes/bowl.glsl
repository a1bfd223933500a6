// Bowl, src/model/shapes/bowl.h in GLSL. geometry: (center, radius).
float bowl_distance(uint t, vec3 x) {
  precise vec3 e = x - terrains[t].geometry[0].xyz;
  precise float d = terrains[t].geometry[0].w - norm3(e);
  return d;
}

vec4 bowl_gap(uint t, vec3 x) {
  precise vec3 e = x - terrains[t].geometry[0].xyz;
  precise float L = norm3(e);
  precise float d = terrains[t].geometry[0].w - L;
  if (L == 0.0) return vec4(0.0, 1.0, 0.0, d);
  precise float q = exact_div(1.0, L);
  precise vec3 n = -(q * e);
  return vec4(n, d);
}

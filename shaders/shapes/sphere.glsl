// Sphere, src/model/shapes/sphere.h in GLSL. geometry: (center, radius).
float sphere_distance(uint t, vec3 x) {
  precise vec3 e = x - terrains[t].geometry[0].xyz;
  precise float d = norm3(e) - terrains[t].geometry[0].w;
  return d;
}

vec4 sphere_gap(uint t, vec3 x) {
  precise vec3 e = x - terrains[t].geometry[0].xyz;
  precise float L = norm3(e);
  precise float d = L - terrains[t].geometry[0].w;
  if (L == 0.0) return vec4(0.0, 1.0, 0.0, d);
  precise float q = exact_div(1.0, L);
  precise vec3 n = q * e;
  return vec4(n, d);
}

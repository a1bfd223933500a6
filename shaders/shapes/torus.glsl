// Torus, src/model/shapes/torus.h in GLSL. geometry: (center, major radius), (axis, minor radius).
float torus_distance(uint t, vec3 x) {
  precise vec4 center = terrains[t].geometry[0];
  precise vec4 axis = terrains[t].geometry[1];
  precise vec3 e = x - center.xyz;
  precise float along = dot3(e, axis.xyz);
  precise vec3 across = e - along * axis.xyz;
  precise float off = norm3(across) - center.w;
  precise float away_2 = off * off + along * along;
  precise float d = exact_sqrt(away_2) - axis.w;
  return d;
}

vec4 torus_gap(uint t, vec3 x) {
  precise vec4 center = terrains[t].geometry[0];
  precise vec4 axis = terrains[t].geometry[1];
  precise vec3 e = x - center.xyz;
  precise float along = dot3(e, axis.xyz);
  precise vec3 across = e - along * axis.xyz;
  precise float L = norm3(across);
  precise float off = L - center.w;
  precise float away_2 = off * off + along * along;
  precise float away = exact_sqrt(away_2);
  precise float d = away - axis.w;
  if (away == 0.0) return vec4(axis.xyz, d);
  if (L == 0.0) return vec4(along < 0.0 ? -axis.xyz : axis.xyz, d);
  precise float q = exact_div(1.0, away);
  precise float outward = off * q;
  precise vec3 n = exact_div(outward, L) * across + (along * q) * axis.xyz;
  return vec4(n, d);
}

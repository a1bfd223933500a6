// Tone, sky and highlights, in terms of the sun alone: also of pages for browsers (src/page/web), which speak GLSL ES 3.00.
// The includer declares `vec4 sun`, whose xyz points to it.

// Tone: linear light in, display light 0…1 out; straight up to 0.7, then a soft shoulder that reaches 1 at infinity.
vec3 to_display(vec3 light) {
  vec3 over = max(light - 0.7, vec3(0.0));
  return min(light, vec3(0.7)) + 0.3 * over / (over + 0.3);
}

const vec3 sun_light = vec3(2.35, 2.20, 1.95);
const vec3 horizon_light = vec3(0.70, 0.79, 0.88);

// Light of the sky from a direction.
vec3 sky(vec3 direction) {
  float up = direction.y;
  vec3 zenith = vec3(0.13, 0.29, 0.60);
  vec3 below = vec3(0.30, 0.30, 0.31);
  float high = 1.0 - clamp(up, 0.0, 1.0);
  float low = clamp(-2.0 * up - 0.3, 0.0, 1.0);
  vec3 gradient = mix(mix(zenith, horizon_light, high * high * high), below, low);
  float towards_sun = max(dot(direction, sun.xyz), 0.0);
  float glow = towards_sun * towards_sun;
  glow *= glow;
  return gradient + vec3(0.16, 0.13, 0.08) * glow;
}

// The sky with a large soft lamp next to the sun, as polished surfaces mirror it.
vec3 studio(vec3 direction) {
  float lamp = smoothstep(0.80, 0.93, dot(direction, sun.xyz));
  vec3 floor_light = vec3(0.34, 0.33, 0.32);
  return mix(sky(direction), floor_light, smoothstep(0.0, -0.12, direction.y)) + vec3(2.2, 2.15, 2.05) * lamp;
}

// Mean light that the sky and the ground send to a surface of this normal.
vec3 ambient(vec3 normal) {
  return mix(vec3(0.28, 0.265, 0.25), vec3(0.50, 0.60, 0.74), 0.5 + 0.5 * normal.y);
}

float fresnel(float cosine, float at_normal) {
  float c = 1.0 - clamp(cosine, 0.0, 1.0);
  float c2 = c * c;
  return at_normal + (1.0 - at_normal) * c2 * c2 * c;
}

// Highlight of a light source on a surface of that roughness (Trowbridge and Reitz, 1975; visibility after Kelemen and
// Szirmay-Kalos, 2001).
float highlight(vec3 n, vec3 v, vec3 l, float roughness) {
  vec3 h = normalize(v + l);
  float a = roughness * roughness;
  float nh = max(dot(n, h), 0.0);
  float lh = max(dot(l, h), 0.05);
  float d = nh * nh * (a * a - 1.0) + 1.0;
  return a * a / (3.1416 * d * d * 4.0 * lh * lh) * max(dot(n, l), 0.0);
}

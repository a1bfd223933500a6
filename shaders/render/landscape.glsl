// The sky as a background: with hills in haze along the horizon, so far away that no camera comes nearer to them.

// Height of a ridge in a direction, as the tangent of the angle above the horizon.
float ridge(float azimuth, float height, vec4 phase) {
  vec4 waves = sin(vec4(3.0, 7.0, 17.0, 43.0) * azimuth + phase);
  return height * (1.0 + dot(waves, vec4(0.34, 0.24, 0.12, 0.05)));
}

// Light from a direction. Hills rise out of the light into which ground fades.
vec3 landscape(vec3 direction) {
  vec3 light = sky(direction);
  float tangent = direction.y / max(length(direction.xz), 1e-3);
  float blur = max(0.7 * fwidth(direction.y), 5e-4);
  if (tangent <= 0.0 || tangent > 0.15) return light;
  float azimuth = atan(direction.z, direction.x);
  float mist = clamp(tangent / 0.05, 0.0, 1.0);
  float far = tangent - ridge(azimuth, 0.052, vec4(0.4, 2.1, 5.0, 1.0));
  float near = tangent - ridge(azimuth, 0.030, vec4(7.7, 4.2, 0.3, 2.6));
  vec3 far_light = mix(horizon_light, vec3(0.44, 0.56, 0.70), 0.6 * mist);
  vec3 near_light = mix(horizon_light, vec3(0.36, 0.46, 0.54), 0.8 * mist);
  light = mix(far_light, light, smoothstep(-blur, blur, far));
  return mix(near_light, light, smoothstep(-blur, blur, near));
}

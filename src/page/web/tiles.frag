// The ground's texture, 4 × 4 tiles that repeat: ground_texels() of src/render/terrain_mesh.cpp.
in vec2 on_screen;
out vec4 color;

float hashed(uint x, uint y, uint salt) {
  uint h = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ salt * 0xc2b2ae3du;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  return float(h ^ (h >> 16)) / 4294967295.0;
}

float noise(vec2 at, uint period, uint salt) {
  vec2 x = at * float(period), t = fract(x), e = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
  uvec2 i = uvec2(x), j = (i + 1u) % period;
  i %= period;
  float low = mix(hashed(i.x, i.y, salt), hashed(j.x, i.y, salt), e.x);
  float high = mix(hashed(i.x, j.y, salt), hashed(j.x, j.y, salt), e.x);
  return 2.0 * mix(low, high, e.y) - 1.0;
}

void main() {
  vec2 at = 0.5 + 0.5 * on_screen, x = 4.0 * at, within = fract(x);
  uvec2 tile = uvec2(x);
  float to_joint = min(min(within.x, 1.0 - within.x), min(within.y, 1.0 - within.y));
  float grain = 0.0, strength = 0.5;
  for (uint octave = 0u; octave < 5u; ++octave, strength *= 0.6) grain += strength * noise(at, 8u << octave, octave);
  float shade = ((tile.x + tile.y) % 2u == 0u ? 0.045 : -0.045) + 0.05 * (hashed(tile.x, tile.y, 77u) - 0.5);
  float joint = 1.0 - 0.38 * clamp(1.0 - (to_joint - 0.006) / 0.008, 0.0, 1.0);
  color = vec4((0.47 + shade * 0.9 + 0.022 * grain) * joint * vec3(1.02, 1.0, 0.965), 1.0);
}

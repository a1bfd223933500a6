// Terrain that is no plane.
#include "frame.glsl"
#include "shadow.glsl"
uniform sampler2D tiles;
uniform vec3 place;
in vec3 world;
in vec3 surface_normal;
out vec4 color;

void main() {
  vec3 n = normalize(surface_normal), v = to_eye(world);
  vec3 weight = n * n, p = (world - place) / 4.0, sunny = sunlight_at(world);
  vec3 albedo = weight.x * texture(tiles, p.yz).rgb + weight.y * texture(tiles, p.xz).rgb + weight.z * texture(tiles, p.xy).rgb;
  albedo *= vec3(1.16, 1.20, 1.30);
  float open = skylight_at(world), nl = max(dot(n, sun.xyz), 0.0);
  vec3 light = albedo * (0.46 * sun_light * nl * sunny * (0.45 + 0.55 * open) + 0.62 * open * ambient(n));
  light += 0.10 * open * fresnel(dot(n, v), 0.03) * horizon_light;
  color = vec4(to_display(light), 1.0);
}

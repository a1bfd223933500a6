// A square around each ball, or each particle (PARTICLES), that faces the eye. LIGHT: as a light sees it.
#include "frame.glsl"
#ifdef PARTICLES
#include "particles.glsl"
uniform float radius;
uniform vec3 base_color;
#else
layout(location = 0) in vec4 place;       // w: radius [m]; 0: not launched yet
layout(location = 1) in vec4 orientation;
layout(location = 2) in vec4 look;        // color; w: what colors show
#endif
#ifdef LIGHT
#include "lights.glsl"
uniform int light;
#endif
flat out vec3 center;
flat out float size;
flat out vec4 turn;
flat out vec3 own_color;
out vec3 on_square;
out vec2 on_disc;
out float middle;

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
#ifdef PARTICLES
  vec4 p = particle(uint(gl_InstanceID));
  vec4 place = vec4(p.xyz, radius);
  turn = vec4(0.0);
  own_color = mapped == 1 ? on_scale(p.w) : base_color;
#else
  turn = orientation;
  own_color = mapped == 1 && look.w >= 0.0 ? on_scale(look.w) : look.rgb;
#endif
  size = place.w;
  on_disc = corner;
#ifdef LIGHT
  vec3 q = in_light(light, place.xyz);
  middle = q.z;
  gl_Position = vec4(q.xy + corner * size / lights[light].center.w, q.z / lights[light].depth, size > 0.0 ? 1.0 : 0.0);
#else
  center = (view * vec4(place.xyz, 1.0)).xyz;
  // Seen from near the outline of a sphere is larger than its section.
  float d = length(center), more = viewer.w > 0.0 ? d / sqrt(max(d * d - size * size, 0.01 * d * d)) : 1.0;
  vec3 axis = viewer.w > 0.0 ? center / d : vec3(0.0, 0.0, -1.0);
  vec3 x = normalize(cross(axis, vec3(0.0, 1.0, 0.0))), y = cross(x, axis);
  on_square = center + 1.04 * more * size * (corner.x * x + corner.y * y);
  gl_Position = size > 0.0 ? projection * vec4(on_square, 1.0) : vec4(0.0);
#endif
}

// Vertices of meshes that follow the particles of a body: where they are, and what colors show there. Each is in a cell of
// the body, or up to half a cell outside, and moves as the cell's corners do, trilinearly (src/model/skin.h).
#include "render/layout.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_PARTICLES) restrict readonly buffer Particles { Particle particles[]; };
layout(std430, binding = BINDING_SKIN_CORNERS) restrict readonly buffer Corners { uvec4 corners[]; };
layout(std430, binding = BINDING_SKIN_PLACES) restrict readonly buffer Places { vec4 places[]; };
layout(std430, binding = BINDING_QUANTITY) restrict readonly buffer Quantity { float quantity[]; };
layout(std430, binding = BINDING_SKIN) restrict writeonly buffer Skin { SkinVertex skin[]; };
layout(location = LOCATION_COUNT) uniform uint vertex_count;
layout(location = LOCATION_FIRST) uniform uint first_vertex;

vec4 at_corner(uint particle) {
  return vec4(particles[particle].position.xyz, quantity[particle]);
}

// Along z, y and x between the corners, which are in the order of their places.
void main() {
  uint i = item_index();
  if (i >= vertex_count) return;
  vec3 at = places[i].xyz;
  uvec4 low = corners[2u * i], high = corners[2u * i + 1u];
  vec4 a = mix(at_corner(low.x), at_corner(low.y), at.z), b = mix(at_corner(low.z), at_corner(low.w), at.z);
  vec4 c = mix(at_corner(high.x), at_corner(high.y), at.z), d = mix(at_corner(high.z), at_corner(high.w), at.z);
  vec4 found = mix(mix(a, b, at.y), mix(c, d, at.y), at.x);
  skin[first_vertex + i].position = vec4(found.xyz, 1.0);
  skin[first_vertex + i].normal = vec4(0.0, 1.0, 0.0, found.w);
}

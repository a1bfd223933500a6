// The vertices of the bodies' surfaces: where they are, what colors show there, and their normals. A normal is the sum
// over the quads at the vertex of the cross product of the two edges there: over all of them where the patches of a
// surface run into each other smoothly, over those of one patch at an edge.
#include "render/layout.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_PARTICLES) restrict readonly buffer Particles { Particle particles[]; };
layout(std430, binding = BINDING_FAN_START) restrict readonly buffer FanStart { uint fan_start[]; };
layout(std430, binding = BINDING_FAN) restrict readonly buffer Fan { uvec2 fan[]; };
layout(std430, binding = BINDING_FAN_VERTEX) restrict readonly buffer FanVertex { uint fan_vertex[]; };
layout(std430, binding = BINDING_FAN_OWN) restrict readonly buffer FanOwn { uint fan_own[]; };
layout(std430, binding = BINDING_QUANTITY) restrict readonly buffer Quantity { float quantity[]; };
layout(std430, binding = BINDING_SKIN) restrict writeonly buffer Skin { SkinVertex skin[]; };
layout(location = LOCATION_COUNT) uniform uint vertex_count;

vec3 unit(vec3 v) {
  float size = length(v);
  return size > 0.0 ? v / size : vec3(0.0, 1.0, 0.0);
}

void main() {
  uint i = item_index();
  if (i >= vertex_count) return;
  uint particle = fan_vertex[i];
  vec3 x = particles[particle].position.xyz;
  vec3 own = vec3(0.0), all = vec3(0.0);
  for (uint q = fan_start[i]; q < fan_start[i + 1u]; ++q) {
    vec3 n = cross(particles[fan[q].x].position.xyz - x, particles[fan[q].y].position.xyz - x);
    all += n;
    if (q < fan_own[i]) own += n;
  }
  // The edge of a cube turns either face's normal by 45°; what turns it by 20° is a bend.
  vec3 flat_normal = unit(own), smooth_normal = unit(all);
  float bend = smoothstep(0.80, 0.94, dot(flat_normal, smooth_normal));
  skin[i] = SkinVertex(vec4(x, 1.0), vec4(unit(mix(flat_normal, smooth_normal, bend)), quantity[particle]));
}

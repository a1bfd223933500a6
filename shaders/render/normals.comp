// Smooth normals of the bodies' surfaces: the sum over the quads at a vertex of the cross product of the two edges there,
// so that every corner of an undeformed cube leans equally towards its three faces.
#include "render/layout.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_PARTICLES) restrict readonly buffer Particles { Particle particles[]; };
layout(std430, binding = BINDING_FAN_START) restrict readonly buffer FanStart { uint fan_start[]; };
layout(std430, binding = BINDING_FAN) restrict readonly buffer Fan { uvec2 fan[]; };
layout(std430, binding = BINDING_FAN_VERTEX) restrict readonly buffer FanVertex { uint fan_vertex[]; };
layout(std430, binding = BINDING_NORMALS) restrict writeonly buffer Normals { vec4 normals[]; };
layout(location = LOCATION_COUNT) uniform uint vertex_count;

void main() {
  uint i = item_index();
  if (i >= vertex_count) return;
  uint vertex = fan_vertex[i];
  vec3 x = particles[vertex].position.xyz;
  vec3 sum = vec3(0.0);
  for (uint q = fan_start[i]; q < fan_start[i + 1u]; ++q)
    sum += cross(particles[fan[q].x].position.xyz - x, particles[fan[q].y].position.xyz - x);
  float size = length(sum);
  normals[vertex] = vec4(size > 0.0 ? sum / size : vec3(0.0, 1.0, 0.0), 0.0);
}

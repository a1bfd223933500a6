// Normals of meshes that follow particles: the mean of the triangles at a vertex, weighted by their area.
#include "render/layout.glsl"
#include "compute/dispatch.glsl"

layout(std430, binding = BINDING_FAN_START) restrict readonly buffer FanStart { uint fan_start[]; };
layout(std430, binding = BINDING_FAN) restrict readonly buffer Fan { uvec2 fan[]; };
layout(std430, binding = BINDING_SKIN) buffer Skin { SkinVertex skin[]; };  // positions of all, the normal of one
layout(location = LOCATION_COUNT) uniform uint vertex_count;
layout(location = LOCATION_FIRST) uniform uint first_vertex;

void main() {
  uint i = item_index();
  if (i >= vertex_count) return;
  vec3 x = skin[first_vertex + i].position.xyz, sum = vec3(0.0);
  for (uint t = fan_start[i]; t < fan_start[i + 1u]; ++t)
    sum += cross(skin[fan[t].x].position.xyz - x, skin[fan[t].y].position.xyz - x);
  float size = length(sum);
  if (size > 0.0) skin[first_vertex + i].normal.xyz = sum / size;
}

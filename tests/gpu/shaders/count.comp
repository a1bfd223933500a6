// Counts how often each item is visited.
#include "compute/dispatch.glsl"
layout(std430, binding = 2) buffer Visits {
  uint visits[];
};
layout(location = 0) uniform uint count;

void main() {
  uint i = item_index();
  if (i >= count) return;
  atomicAdd(visits[i], 1u);
}

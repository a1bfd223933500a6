// Writes the arguments of an indirect dispatch: `groups` groups.
#include "compute/dispatch.glsl"
layout(std430, binding = 0) writeonly buffer Arguments {
  uint arguments[];
};
layout(location = 0) uniform uint groups;

void main() {
  if (item_index() != 0u) return;
  arguments[1] = groups;
  arguments[2] = 1u;
  arguments[3] = 1u;
}

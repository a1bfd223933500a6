// One invocation per item, along x and, past 65,535 groups, y (src/gpu/pass.h).
#ifndef ASPIC_GROUP_SIZE
#define ASPIC_GROUP_SIZE 64
#endif
layout(local_size_x = ASPIC_GROUP_SIZE) in;

// The item of this invocation. Kernels return where it is not below their count.
uint item_index() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  return group * uint(ASPIC_GROUP_SIZE) + gl_LocalInvocationIndex;
}

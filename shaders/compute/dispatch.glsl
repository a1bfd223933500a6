// One invocation per item, along x and, past 65,535 groups, y (src/gpu/pass.h).
#ifndef ASPIC_GROUP_SIZE
#define ASPIC_GROUP_SIZE 64
#endif
layout(local_size_x = ASPIC_GROUP_SIZE) in;

// Where a scene's arrays are larger than a storage block, a dispatch sees a window of them (src/gpu_solver/windows.h):
// AT and its like turn an index into the place in the block.
#ifdef ASPIC_WINDOWS
layout(location = LOCATION_WINDOW) uniform uvec4 window;  // items from x to below y; first particle, first word
layout(location = LOCATION_FIRST_SPRING) uniform uint first_spring;
#define FIRST_ITEM window.x
#define AT(particle) ((particle) - window.z)
#define AT_ITEM(item) ((item) - window.x)
#define AT_WORD(word) ((word) - window.w)
#define AT_SPRING(spring) ((spring) - first_spring)
#else
#define FIRST_ITEM 0u
#define AT(particle) (particle)
#define AT_ITEM(item) (item)
#define AT_WORD(word) (word)
#define AT_SPRING(spring) (spring)
#endif

// The item of this invocation. Kernels return where it is not below item_end(their count).
uint item_index() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  return FIRST_ITEM + group * uint(ASPIC_GROUP_SIZE) + gl_LocalInvocationIndex;
}

#ifdef ASPIC_WINDOWS
uint item_end(uint count) { return window.y; }
#else
uint item_end(uint count) { return count; }
#endif

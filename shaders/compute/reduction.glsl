// Reductions as trees over fixed blocks of 256 elements (src/physics/reductions.h): each work group reduces its
// block, the last group to finish reduces the blocks' results. x takes the largest, y, z and w the sums; elements that
// are missing count as zero. Every invocation of the group must call these.
shared vec4 reduction[REDUCTION_BLOCK];
shared bool reduction_is_last;

vec4 combined(vec4 a, vec4 b) {
  precise vec3 sum = a.yzw + b.yzw;
  return vec4(b.x > a.x ? b.x : a.x, sum);
}

void reduce_block(vec4 element) {
  uint lane = gl_LocalInvocationIndex;
  reduction[lane] = element;
  barrier();
  for (uint span = REDUCTION_BLOCK / 2; span > 0u; span /= 2u) {
    if (lane < span) reduction[lane] = combined(reduction[lane], reduction[lane + span]);
    barrier();
  }
}

uint blocks_of(uint count) { return (count + REDUCTION_BLOCK - 1u) / REDUCTION_BLOCK; }

// True in all invocations of the one group that is last; `total` is then the result over all particles.
bool reduce(vec4 element, out vec4 total) {
  uint block = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint blocks = blocks_of(particle_count);
  reduce_block(element);
  if (gl_LocalInvocationIndex == 0u) {
    reduction_is_last = false;
    if (block < blocks_of(particle_count)) {
      partials[block] = reduction[0];
      memoryBarrierBuffer();
      reduction_is_last = atomicAdd(solve.blocks_done, 1u) == blocks - 1u;
    }
  }
  barrier();
  total = vec4(0.0);
  if (!reduction_is_last) return false;
  memoryBarrierBuffer();
  for (uint left = blocks; left > 1u; left = blocks_of(left)) {
    for (uint b = 0u; b < blocks_of(left); ++b) {
      uint index = b * REDUCTION_BLOCK + gl_LocalInvocationIndex;
      precise vec4 element_of_block = index < left ? partials[index] : vec4(0.0);
      reduce_block(element_of_block);
      if (gl_LocalInvocationIndex == 0u) partials[b] = reduction[0];
      memoryBarrierBuffer();
      barrier();
    }
  }
  if (gl_LocalInvocationIndex == 0u) solve.blocks_done = 0u;
  total = partials[0];
  return true;
}

// Boxes around blocks of triangles at the end of the particles' step.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#define ASPIC_BALL_FACE_KERNEL
#include "compute/ball_blocks.glsl"
#include "compute/ball_face_blocks.glsl"

void main() {
  uint block = item_index();
  if (block >= face_block_count() || idle()) return;
  precise vec3 low = vec3(0.0), high = vec3(0.0);
  for (uint n = 0u; n < FACE_BLOCK; ++n) {
    uvec3 corner = corners_of(FACE_BLOCK * block + n);
    precise vec3 A = end_place(corner.x), B = end_place(corner.y), C = end_place(corner.z);
    precise vec3 least = min(min(A, B), C), most = max(max(A, B), C);
    low = n == 0u ? least : min(low, least);
    high = n == 0u ? most : max(high, most);
  }
  face_boxes[2u * block] = vec4(low, 0.0);
  face_boxes[2u * block + 1u] = vec4(high, 0.0);
}

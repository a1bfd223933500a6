// Bodies with more than 256 partners: the sums over their blocks other than the first, each by the item in which the block
// begins.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/ball_blocks.glsl"
#include "compute/terms/ball_contact.glsl"
#include "compute/ball_sums.glsl"

void main() {
  uint i = item_index();
  if (idle() || i >= work.items_used) return;
  uint body = items[i].body, kind = items[i].kind, count = count_in(i);
  if (!phase_has(body < ball_count ? KIND_BALL : KIND_PARTICLE, kind)) return;
  if (count == 0u || contacts[body].pairs[ball_phase] <= PARTNER_BLOCK) return;

  Partners of = partners_of(body);
  uint place = kind == KIND_BALL ? i - of.first_a : of.count_a + (i - of.first_b);
  uint before = uint(bitCount(of.listed));
  uint rounds = bounded(place, KERNEL_BALL_PARTIALS);
  for (uint k = 0u; k < rounds; ++k) before += count_in(item_at(of, k));
  uint skip = block_start(before, count);
  if (skip == count) return;

  uint w = 0u;
  uint left = word_in(i, 0u);
  for (; skip >= uint(bitCount(left)); left = word_in(i, ++w)) skip -= uint(bitCount(left));
  for (; skip > 0u; --skip) left &= left - 1u;
  Impulse sum = sum_block(seeking(body), of, place, w, left, KERNEL_BALL_PARTIALS);
  items[i].linear = vec4(sum.linear, 0.0);
  items[i].turning = vec4(sum.turning, 0.0);
}

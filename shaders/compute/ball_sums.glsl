// What a body receives from its partners, in their order: sums run over blocks of 256 partners, one partner after the
// other; then over these sums, one block after the other.
#include "compute/ball_partners.glsl"

// c·w and c·R²/I of a body.
vec2 share_of(uint kind, uint index) {
  precise vec2 share = vec2(0.0);
  if (kind == KIND_PARTICLE) {
    share.x = float(contacts[ball_count + index].pairs[ball_phase]) * end_particle(index).position.w;
  } else {
    Ball ball = ball_in(slot_before(ball_phase), index);
    precise float c = float(contacts[index].pairs[ball_phase]);
    share.x = c * ball.velocity.w;
    share.y = c * ball.start_velocity.w;
  }
  return share;
}

vec3 rolling_of(uint b) {
  Ball ball = ball_in(slot_before(ball_phase), b);
  precise vec3 rolling = ball.position.w * ball.spin.xyz;
  return rolling;
}

// What a body receives from one partner; in the position phase `linear` is its shift [m·kg].
Impulse received(Seeker seeker, vec2 mine, vec3 own_rolling, uint kind, uint index) {
  Partner other = partner(seeker, kind, index);
  precise vec2 its = share_of(kind, index);
  precise float weight = mine.x + its.x;
  if (ball_phase == BALL_PHASE_POSITIONS) {
    precise vec3 shift = exact_div(-other.gap.w, weight) * other.gap.xyz;
    return Impulse(shift, vec3(0.0));
  }
  precise vec3 rolling = own_rolling;
  precise float slip_share = mine.y;
  if (seeker.kind == KIND_PARTICLE) {
    rolling = rolling_of(index);
    slip_share = its.y;
  } else if (kind == KIND_BALL) {
    rolling = own_rolling + rolling_of(index);
    slip_share = mine.y + its.y;
  }
  precise float slip_weight = weight + slip_share;
  return impact(other.gap.xyz, other.dv, other.dv_0, rolling, weight, slip_weight);
}

// The sum over up to 256 partners from bit `left` of word w of item k on; k = NO_BODY: from the list on.
Impulse sum_block(Seeker seeker, Partners of, uint k, uint w, uint left, uint kernel) {
  precise vec2 mine = share_of(seeker.kind, seeker.index);
  precise vec3 rolling = vec3(0.0), linear = vec3(0.0), turning = vec3(0.0);
  if (seeker.kind == KIND_BALL) rolling = rolling_of(seeker.index);
  bool in_list = k == NO_BODY;
  uint kind = in_list ? KIND_BALL : items[item_at(of, k)].kind;
  uint base = in_list ? 0u : items[item_at(of, k)].first + 32u * w;
  uint taken = 0u;
  for (uint n = 0u; taken < PARTNER_BLOCK; ++n) {
    if (bounded(n + 1u, kernel) == n) break;
    if (left != 0u) {
      uint bit = uint(findLSB(left));
      left &= left - 1u;
      uint index = in_list ? lists[of.list + bit] : base + bit;
      Impulse got = received(seeker, mine, rolling, kind, index);
      linear = linear + got.linear;
      turning = turning + got.turning;
      ++taken;
      continue;
    }
    // The next word; items without partners are passed over as one.
    w = in_list || w + 1u == ITEM_WORDS ? 0u : w + 1u;
    if (w == 0u) {
      k = in_list ? 0u : k + 1u;
      in_list = false;
      if (k == items_in(of)) break;
    }
    uint item = item_at(of, k);
    if (count_in(item) == 0u) {
      w = ITEM_WORDS - 1u;
      continue;
    }
    kind = items[item].kind;
    base = items[item].first + 32u * w;
    left = word_in(item, w);
  }
  return Impulse(linear, turning);
}

// The sum over all partners; those of blocks other than the first have been summed (ball_partials.comp).
Impulse sum_all(Seeker seeker, uint body, uint kernel) {
  Partners of = partners_of(body);
  Impulse first = sum_block(seeker, of, NO_BODY, 0u, of.listed, kernel);
  if (contacts[body].pairs[ball_phase] <= PARTNER_BLOCK) return first;
  precise vec3 linear = first.linear, turning = first.turning;
  uint before = uint(bitCount(of.listed));
  uint rounds = bounded(items_in(of), kernel);
  for (uint k = 0u; k < rounds; ++k) {
    uint item = item_at(of, k), count = count_in(item);
    if (block_start(before, count) < count) {
      linear = linear + items[item].linear.xyz;
      turning = turning + items[item].turning.xyz;
    }
    before += count;
  }
  return Impulse(linear, turning);
}

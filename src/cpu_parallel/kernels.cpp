#include "cpu_parallel/kernels.h"

#include <algorithm>
#include <limits>

#include "cpu_parallel/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu_parallel/kernels.cpp"
#include <hwy/foreach_target.h>

#include "cpu_parallel/spring-inl.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

void ListedForces(const SpringLists& lists, const ForceInput& input, Range range, const Forces& forces) {
  const hn::RebindToSigned<Tag> index_tag;
  const Particles& at = *input.at;
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const std::size_t local = range.first + n, lane = local % slice, p = lists.first() + local;
    const Vector x = load(at.x, p), v = load(at.v, p);
    Vector f = body_force(input, p);
    for (const SpringLists::Slot& slot : lists.slots(local / slice)) {
      const auto other = hn::LoadU(index_tag, slot.neighbor.data() + lane);
      const auto kind = hn::LoadU(index_tag, slot.spring_class.data() + lane);
      const Spring of[] = {{hn::GatherIndex(tag, lists.stiffness().data(), kind),
                            hn::GatherIndex(tag, lists.damping().data(), kind),
                            hn::GatherIndex(tag, lists.rest_length().data(), kind)}};
      const Vector e[] = {x - gathered(at.x, other)}, dv[] = {v - gathered(at.v, other)};
      Float factor[1], length[1];
      evaluate_springs(e, dv, of, factor, length);
      const Float nothing = hn::LoadU(tag, slot.nothing.data() + lane);
      const Mask idle = hn::Or(hn::Eq(length[0], hn::Zero(tag)),
                               hn::Lt(length[0], hn::GatherIndex(tag, lists.slack().data(), kind)));
      const Vector taken = chosen(idle, {nothing, nothing, nothing}, factor[0] * e[0]);
      f = chosen(mask_of(slot.present, lane), f - taken, f);
    }
    store(f, forces, n);
  }
}

/// One stage of up to `lanes` particles: those behind them belong to another thread.
template <bool whole>
HWY_INLINE void move_lanes(const StageMove& stage, std::size_t p, std::size_t count, const Forces& forces,
                           std::size_t n, Moved& moved) {
  const Mask own = hn::FirstN(tag, count);
  const auto loaded = [&](const float* from) {
    return whole ? hn::LoadU(tag, from) : load_first(from, count);
  };
  const auto put = [&](Float v, float* to) {
    if constexpr (whole) return hn::StoreU(v, tag, to);
    // A masked store may write the other lanes too, with the values that were there before.
    alignas(64) float all[slice];
    hn::Store(v, tag, all);
    std::copy_n(all, count, to);
  };
  const Float weight = hn::Set(tag, stage.weight), w = loaded(stage.inverse_mass + p);
  Mask sound = hn::FirstN(tag, 0);
  Float square;
  for (std::size_t c = 0; c < 3; ++c) {
    const Float a = hn::Mul(w, hn::LoadU(tag, forces.component[c] + n));
    const Float at_v = loaded(stage.at->v[c].data() + p);
    const Float start_x = loaded(stage.start->x[c].data() + p),
                start_v = loaded(stage.start->v[c].data() + p);
    Float slope_x = hn::Mul(weight, at_v), slope_v = hn::Mul(weight, a);
    if (stage.accumulate) {
      slope_x = hn::Add(loaded(stage.sums->x[c].data() + p), slope_x);
      slope_v = hn::Add(loaded(stage.sums->v[c].data() + p), slope_v);
    }
    Float next_x, next_v;
    if (stage.last) {
      const Float scale = hn::Set(tag, stage.step_scale);
      next_v = hn::Add(start_v, hn::Mul(scale, slope_v));
      next_x = hn::Add(start_x, hn::Mul(scale, stage.drift == Drift::new_velocity ? next_v : slope_x));
    } else {
      if (stage.weight != 0.0f) {
        put(slope_x, stage.sums->x[c].data() + p);
        put(slope_v, stage.sums->v[c].data() + p);
      }
      const Float advance = hn::Set(tag, stage.advance);
      next_v = hn::Add(start_v, hn::Mul(advance, a));
      const Float moves =
          stage.drift == Drift::mean_velocity ? hn::Mul(hn::Set(tag, 0.5f), hn::Add(at_v, next_v)) : at_v;
      next_x = hn::Add(start_x, hn::Mul(advance, moves));
    }
    put(next_x, stage.next->x[c].data() + p);
    put(next_v, stage.next->v[c].data() + p);
    // The new value comes first: where it is not a number the bounds stay.
    const Float low = hn::Load(tag, moved.low[c]), high = hn::Load(tag, moved.high[c]);
    const Float least = hn::Min(next_x, low), most = hn::Max(next_x, high);
    hn::Store(whole ? least : hn::IfThenElse(own, least, low), tag, moved.low[c]);
    hn::Store(whole ? most : hn::IfThenElse(own, most, high), tag, moved.high[c]);
    const Mask finite = hn::Le(hn::Abs(next_x), hn::Set(tag, hwy::HighestValue<float>()));
    sound = c == 0 ? finite : hn::And(sound, finite);
    square = c == 0 ? hn::Mul(next_v, next_v) : hn::Add(square, hn::Mul(next_v, next_v));
  }
  sound = hn::And(sound, hn::Le(square, hn::Set(tag, moved.limit)));
  if (!whole) sound = hn::Or(sound, hn::Not(own));
  moved.sound = moved.sound && hn::AllTrue(tag, sound);
}

void Move(const StageMove& stage, Range range, const Forces& forces, Moved& moved) {
  std::size_t n = 0;
  for (; n + lanes <= range.count; n += lanes)
    move_lanes<true>(stage, range.first + n, lanes, forces, n, moved);
  if (n < range.count) move_lanes<false>(stage, range.first + n, range.count - n, forces, n, moved);
}

Box BoxOf(const VectorArray& x, Range range) {
  Box box;
  for (std::size_t c = 0; c < 3; ++c) {
    const float* const from = x[c].data() + range.first;
    float least = from[0], most = from[0];
    std::size_t n = 0;
    if (range.count >= lanes) {
      Float low = hn::LoadU(tag, from), high = low;
      for (n = lanes; n + lanes <= range.count; n += lanes) {
        const Float at = hn::LoadU(tag, from + n);
        low = hn::Min(low, at);
        high = hn::Max(high, at);
      }
      least = hn::GetLane(hn::MinOfLanes(tag, low));
      most = hn::GetLane(hn::MaxOfLanes(tag, high));
    }
    for (; n < range.count; ++n) {
      least = from[n] < least ? from[n] : least;
      most = from[n] > most ? from[n] : most;
    }
    box.min[c] = least;
    box.max[c] = most;
  }
  return box;
}

bool AllSound(const Particles& particles, Range range, float limit) {
  const Float most = hn::Set(tag, limit), largest = hn::Set(tag, hwy::HighestValue<float>());
  for (std::size_t n = 0; n < range.count; n += lanes) {
    const auto at = [&](const VectorArray& a) {
      const std::size_t p = range.first + n;
      return Vector{load_first(a[0].data() + p, range.count - n),
                    load_first(a[1].data() + p, range.count - n),
                    load_first(a[2].data() + p, range.count - n)};
    };
    const Vector x = at(particles.x), v = at(particles.v);
    const Mask finite = hn::And(hn::Le(hn::Abs(x.x), largest),
                                hn::And(hn::Le(hn::Abs(x.y), largest), hn::Le(hn::Abs(x.z), largest)));
    if (!hn::AllTrue(tag, hn::And(finite, hn::Le(dot3(v, v), most)))) return false;
  }
  return true;
}

void WriteRows(const VectorArray& from, Range range, float* rows) {
  const float *const x = from[0].data() + range.first, *const y = from[1].data() + range.first,
                     *const z = from[2].data() + range.first;
  std::size_t n = 0;
  for (; n + lanes <= range.count; n += lanes)
    hn::StoreInterleaved3(hn::LoadU(tag, x + n), hn::LoadU(tag, y + n), hn::LoadU(tag, z + n), tag,
                          rows + 3 * n);
  for (; n < range.count; ++n) {
    rows[3 * n] = x[n];
    rows[3 * n + 1] = y[n];
    rows[3 * n + 2] = z[n];
  }
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::parallel {

HWY_EXPORT(ListedForces);
HWY_EXPORT(Move);
HWY_EXPORT(BoxOf);
HWY_EXPORT(AllSound);
HWY_EXPORT(WriteRows);

void listed_forces(const SpringLists& lists, const ForceInput& input, Range range, const Forces& forces) {
  HWY_DYNAMIC_DISPATCH(ListedForces)(lists, input, range, forces);
}
void move(const StageMove& stage, Range range, const Forces& forces, Moved& moved) {
  HWY_DYNAMIC_DISPATCH(Move)(stage, range, forces, moved);
}
Box box_of(const VectorArray& x, Range range) {
  return HWY_DYNAMIC_DISPATCH(BoxOf)(x, range);
}
bool all_sound(const Particles& particles, Range range, float limit) {
  return HWY_DYNAMIC_DISPATCH(AllSound)(particles, range, limit);
}
void write_rows(const VectorArray& from, Range range, float* rows) {
  HWY_DYNAMIC_DISPATCH(WriteRows)(from, range, rows);
}
Moved::Moved(float limit_of_square) : limit(limit_of_square) {
  for (auto& of : low) std::ranges::fill(of, std::numeric_limits<float>::infinity());
  for (auto& of : high) std::ranges::fill(of, -std::numeric_limits<float>::infinity());
}
Box Moved::box() const {
  Box box;
  for (std::size_t c = 0; c < 3; ++c) {
    box.min[c] = *std::ranges::min_element(low[c]);
    box.max[c] = *std::ranges::max_element(high[c]);
  }
  return box;
}
std::string_view instruction_set() {
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(usable & -usable);
}

}  // namespace aspic::parallel
#endif

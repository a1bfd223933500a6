#include "cpu_parallel/stack_kernels.h"

#include <algorithm>

#include "cpu_parallel/targets.h"
#include "model/springs.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu_parallel/stack_kernels.cpp"
#include <hwy/foreach_target.h>

#include "cpu_parallel/spring-inl.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

/// The arrays of a stack from a lane on. Pointers are copies, since every store could change those in memory.
struct Rows {
  const float *x[3], *v[3];
  Forces f;
};

HWY_INLINE Vector row(const float* const (&from)[3], std::size_t at) {
  return {hn::Load(tag, from[0] + at), hn::Load(tag, from[1] + at), hn::Load(tag, from[2] + at)};
}

/// Springs from a particle at (x, v) to `size` upper ends, taken off `own` and added to theirs.
template <std::size_t size>
HWY_INLINE void pull(const Rows& rows, const float* constants, const UpperEnds::End* ends, const Vector& x,
                     const Vector& v, Vector& own) {
  Vector e[size], dv[size];
  Spring of[size];
  Float slack[size], factor[size], length[size];
  for (std::size_t s = 0; s < size; ++s) {
    const std::size_t other = ends[s].particle * stack_lanes;
    e[s] = x - row(rows.x, other);
    dv[s] = v - row(rows.v, other);
    const float* const from =
        constants + ends[s].spring_class * static_cast<std::size_t>(ConstantRow::count) * stack_lanes;
    const auto constant = [&](ConstantRow which) {
      return hn::Load(tag, from + static_cast<std::size_t>(which) * stack_lanes);
    };
    of[s] = {constant(ConstantRow::stiffness), constant(ConstantRow::damping),
             constant(ConstantRow::rest_length)};
    slack[s] = constant(ConstantRow::slack);
  }
  evaluate_springs(e, dv, of, factor, length);
  // A spring that pulls nowhere adds +0 to its lower end and takes +0 off its upper one.
  const Float none = hn::Set(tag, -0.0f);
  for (std::size_t s = 0; s < size; ++s) {
    const Mask idle = hn::Or(hn::Eq(length[s], hn::Zero(tag)), hn::Lt(length[s], slack[s]));
    const Vector taken = chosen(idle, {none, none, none}, factor[s] * e[s]);
    own = own - taken;
    const std::size_t other = ends[s].particle * stack_lanes;
    store(load(rows.f, other) + taken, rows.f, other);
  }
}

void StackForces(const StackInput& input, const Particles& at, const Forces& forces) {
  const UpperEnds& springs = *input.springs;
  const std::size_t particles = springs.start.size() - 1;
  const UpperEnds::End* const ends = springs.ends.data();
  for (std::size_t lane = 0; lane < stack_lanes; lane += lanes) {
    Rows rows;
    for (std::size_t c = 0; c < 3; ++c) {
      rows.x[c] = at.x[c].data() + lane;
      rows.v[c] = at.v[c].data() + lane;
      rows.f.component[c] = forces.component[c] + lane;
    }
    const float *const mass = input.mass + lane, *const constants = input.constants + lane;
    const BodyForce body_force(input.body_forces + lane);
    for (std::size_t i = 0; i < particles; ++i) {
      const std::size_t own_row = i * stack_lanes;
      store(body_force.at(hn::Load(tag, mass + own_row), row(rows.v, own_row)), rows.f, own_row);
    }
    for (std::size_t i = 0; i < particles; ++i) {
      const std::size_t own_row = i * stack_lanes, end = springs.start[i + 1];
      std::size_t s = springs.start[i];
      if (s == end) continue;
      const Vector x = row(rows.x, own_row), v = row(rows.v, own_row);
      Vector own = load(rows.f, own_row);
      for (; s + 4 <= end; s += 4) pull<4>(rows, constants, ends + s, x, v, own);
      for (; s < end; ++s) pull<1>(rows, constants, ends + s, x, v, own);
      store(own, rows.f, own_row);
    }
  }
}

void FindBoxes(const VectorArray& x, std::size_t particles, LaneBoxes& boxes) {
  for (std::size_t lane = 0; lane < stack_lanes; lane += lanes) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float* const from = x[c].data() + lane;
      Float low = hn::Load(tag, from), high = low;
      for (std::size_t i = 1; i < particles; ++i) {
        const Float at = hn::Load(tag, from + i * stack_lanes);
        low = hn::Min(low, at);
        high = hn::Max(high, at);
      }
      hn::Store(low, tag, boxes.low[c] + lane);
      hn::Store(high, tag, boxes.high[c] + lane);
    }
  }
}

void FindNear(const VectorArray& x, std::size_t particles, std::span<const Front> terrain,
              std::uint32_t wanted, std::vector<NearRow>& rows) {
  for (std::size_t i = 0; i < particles; ++i) {
    std::uint32_t found = 0;
    for (std::size_t lane = 0; lane < stack_lanes; lane += lanes) {
      const std::size_t at = i * stack_lanes + lane;
      const float* const places[3] = {x[0].data(), x[1].data(), x[2].data()};
      const Vector place = row(places, at);
      Mask near = hn::FirstN(tag, 0);
      for (const Front& front : terrain) {
        const float* const normal[3] = {front.normal[0], front.normal[1], front.normal[2]};
        const Mask far = hn::Gt(dot3(row(normal, lane), place), hn::Load(tag, front.limit + lane));
        near = hn::Or(near, hn::Not(far));
      }
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(tag, near, bits);
      found |= static_cast<std::uint32_t>(bits[0] | bits[1] << 8) << lane;
    }
    if ((found & wanted) != 0) rows.push_back({static_cast<std::uint32_t>(i), found & wanted});
  }
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::parallel {

HWY_EXPORT(StackForces);
HWY_EXPORT(FindBoxes);
HWY_EXPORT(FindNear);

void stack_forces(const StackInput& input, const Particles& at, const Forces& forces) {
  HWY_DYNAMIC_DISPATCH(StackForces)(input, at, forces);
}
void lane_boxes(const VectorArray& x, std::size_t particles, LaneBoxes& boxes) {
  HWY_DYNAMIC_DISPATCH(FindBoxes)(x, particles, boxes);
}
void find_near_rows(const VectorArray& x, std::size_t particles, std::span<const Front> terrain,
                    std::uint32_t lanes, std::vector<NearRow>& rows) {
  HWY_DYNAMIC_DISPATCH(FindNear)(x, particles, terrain, lanes, rows);
}

UpperEnds::UpperEnds(const Model& model) {
  start.assign(1, 0);
  for (const aspic::Spring& spring : springs_of(model)) {
    while (start.size() <= spring.a) start.push_back(static_cast<std::uint32_t>(ends.size()));
    ends.push_back({spring.b, spring.spring_class});
  }
  while (start.size() <= model.particle_count()) start.push_back(static_cast<std::uint32_t>(ends.size()));
}

}  // namespace aspic::parallel
#endif

#include <hwy/cache_control.h>

#include <algorithm>
#include <limits>

#include "cpu_parallel/targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "cpu_parallel/contact_kernels.cpp"
#include <hwy/foreach_target.h>

#include "cpu_parallel/contact_lanes.h"
#include "cpu_parallel/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace aspic::parallel::HWY_NAMESPACE {
namespace {

const hn::RebindToSigned<Tag> index_tag;
using Index = hn::Vec<hn::RebindToSigned<Tag>>;

HWY_INLINE Vector cross3(const Vector& a, const Vector& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)), hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

/// Shares b and c of the nearest place, and whether it is within the face: nearest_place(), the regions asked
/// for last first.
struct Nearest {
  Float b, c;
  Mask face;

  HWY_INLINE void unless(Mask region, Float b_there, Float c_there) {
    b = hn::IfThenElse(region, b_there, b);
    c = hn::IfThenElse(region, c_there, c);
    face = hn::AndNot(region, face);
  }
};

HWY_INLINE Nearest nearest_place(const Vector& P, const Vector& A, const Vector& B, const Vector& C) {
  const Vector ab = B - A, ac = C - A, ap = P - A, bp = P - B, cp = P - C;
  const Float d1 = dot3(ab, ap), d2 = dot3(ac, ap), d3 = dot3(ab, bp), d4 = dot3(ac, bp), d5 = dot3(ab, cp),
              d6 = dot3(ac, cp);
  const Float vc = hn::Sub(hn::Mul(d1, d4), hn::Mul(d3, d2)), vb = hn::Sub(hn::Mul(d5, d2), hn::Mul(d1, d6)),
              va = hn::Sub(hn::Mul(d3, d6), hn::Mul(d5, d4));
  const Float to_b = hn::Sub(d4, d3), to_c = hn::Sub(d5, d6);
  const Float zero = hn::Zero(tag), one = hn::Set(tag, 1.0f);
  const auto all = [](Mask a, Mask b, Mask c) { return hn::And(hn::And(a, b), c); };
  const Float q = hn::Div(one, hn::Add(hn::Add(va, vb), vc));
  Nearest at = {hn::Mul(vb, q), hn::Mul(vc, q), hn::Eq(zero, zero)};
  const Float on_bc = hn::Div(to_b, hn::Add(to_b, to_c));
  at.unless(all(hn::Le(va, zero), hn::Ge(to_b, zero), hn::Ge(to_c, zero)), hn::Sub(one, on_bc), on_bc);
  at.unless(all(hn::Le(vb, zero), hn::Ge(d2, zero), hn::Le(d6, zero)), zero, hn::Div(d2, hn::Sub(d2, d6)));
  at.unless(hn::And(hn::Ge(d6, zero), hn::Le(d5, d6)), zero, one);
  at.unless(all(hn::Le(vc, zero), hn::Ge(d1, zero), hn::Le(d3, zero)), hn::Div(d1, hn::Sub(d1, d3)), zero);
  at.unless(hn::And(hn::Ge(d3, zero), hn::Le(d4, d3)), one, zero);
  at.unless(hn::And(hn::Le(d1, zero), hn::Le(d2, zero)), zero, zero);
  return at;
}

/// A triangle as a point sees it: physics::ClosestPoint.
struct ClosestPoint {
  Vector N, e;
  Nearest at;
  Float L, z;
};

/// physics::sight_of(). Returns g, the area normal.
HWY_INLINE Vector look(const Vector& P, const Vector& A, const Vector& B, const Vector& C,
                       ClosestPoint& seen) {
  const Vector g = cross3(B - A, C - A);
  seen.N = hn::Div(hn::Set(tag, 1.0f), hn::Sqrt(dot3(g, g))) * g;
  seen.at = nearest_place(P, A, B, C);
  seen.e = ((P - A) - seen.at.b * (B - A)) - seen.at.c * (C - A);
  seen.L = hn::Sqrt(dot3(seen.e, seen.e));
  seen.z = dot3(seen.e, seen.N);
  return g;
}
/// Whether a triangle has an area.
HWY_INLINE Mask real(const Vector& g) {
  return hn::Gt(dot3(g, g), hn::Zero(tag));
}

HWY_INLINE void store(const Vector& v, float* const* to, std::size_t n) {
  hn::StoreU(v.x, tag, to[0] + n);
  hn::StoreU(v.y, tag, to[1] + n);
  hn::StoreU(v.z, tag, to[2] + n);
}

using collision::ContactBatch;
using collision::ContactTables;
using collision::Row;

/// Rows of so many lanes as vectors: lane n of column c is c of row number index[n].
struct Columns {
  Float column[4];
  HWY_INLINE Vector vector() const { return {column[0], column[1], column[2]}; }
};

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Columns columns(const float* rows, const std::int32_t* index) {
  const float* const row = rows + 4 * static_cast<std::ptrdiff_t>(*index);
  return {{hn::Set(tag, row[0]), hn::Set(tag, row[1]), hn::Set(tag, row[2]), hn::Set(tag, row[3])}};
}
#else
/// Rows index[0], index[4], … one after the other.
template <class D>
HWY_INLINE hn::Vec<D> every_fourth(D d, const float* rows, const std::int32_t* index) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::LoadU(d, rows + 4 * static_cast<std::ptrdiff_t>(*index));
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, every_fourth(half, rows, index + hn::MaxLanes(D()) / 2),
                       every_fourth(half, rows, index));
  }
}

HWY_INLINE Columns columns(const float* rows, const std::int32_t* index) {
  const hn::Repartition<double, Tag> pairs;
  const Float row[4] = {every_fourth(tag, rows, index), every_fourth(tag, rows, index + 1),
                        every_fourth(tag, rows, index + 2), every_fourth(tag, rows, index + 3)};
  const auto xy_01 = hn::BitCast(pairs, hn::InterleaveLower(tag, row[0], row[1])),
             xy_23 = hn::BitCast(pairs, hn::InterleaveLower(tag, row[2], row[3])),
             zw_01 = hn::BitCast(pairs, hn::InterleaveUpper(tag, row[0], row[1])),
             zw_23 = hn::BitCast(pairs, hn::InterleaveUpper(tag, row[2], row[3]));
  return {{hn::BitCast(tag, hn::InterleaveLower(pairs, xy_01, xy_23)),
           hn::BitCast(tag, hn::InterleaveUpper(pairs, xy_01, xy_23)),
           hn::BitCast(tag, hn::InterleaveLower(pairs, zw_01, zw_23)),
           hn::BitCast(tag, hn::InterleaveUpper(pairs, zw_01, zw_23))}};
}
#endif
HWY_INLINE Vector vectors(const Row<float>* rows, const std::int32_t* index) {
  return columns(rows->data(), index).vector();
}

/// A triangle for each lane.
struct Faces {
  alignas(64) std::int32_t corner[3][lanes];
  Index side;
};
HWY_INLINE Faces faces_at(const Row<std::uint32_t>* rows, const std::int32_t* index) {
  const Columns all = columns(reinterpret_cast<const float*>(rows->data()), index);
  Faces faces;
  for (std::size_t c = 0; c < 3; ++c)
    hn::StoreU(hn::BitCast(index_tag, all.column[c]), index_tag, faces.corner[c]);
  faces.side = hn::BitCast(index_tag, all.column[3]);
  return faces;
}

void Look(const SightLanes& batch) {
  const Float one = hn::Set(tag, 1.0f);
  const auto flags = [&](Mask mask, std::int32_t* to) {
    hn::StoreU(hn::ConvertTo(index_tag, hn::IfThenElseZero(mask, one)), index_tag, to);
  };
  const Vector P = {hn::Set(tag, batch.P[0]), hn::Set(tag, batch.P[1]), hn::Set(tag, batch.P[2])};
  for (std::size_t n = 0; n < batch.count; n += lanes) {
    const Faces faces = faces_at(batch.faces, batch.triangle + n);
    ClosestPoint seen;
    const Vector g = look(P, vectors(batch.x, faces.corner[0]), vectors(batch.x, faces.corner[1]),
                          vectors(batch.x, faces.corner[2]), seen);
    flags(real(g), batch.real + n);
    flags(seen.at.face, batch.face + n);
    hn::StoreU(seen.at.b, tag, batch.b + n);
    hn::StoreU(seen.at.c, tag, batch.c + n);
    hn::StoreU(seen.L, tag, batch.L + n);
    hn::StoreU(seen.z, tag, batch.z + n);
    store(seen.e, batch.e, n);
    store(seen.N, batch.N, n);
  }
}

HWY_INLINE Mask both(Mask a, Mask b) {
  return hn::And(a, b);
}

/// The same constant of each lane's pair.
struct Pairs {
  const physics::PairConstants<float>* all;
  const std::int32_t* index;
  bool same;

  template <class Value>
  HWY_INLINE Float of(Value physics::PairConstants<float>::*which) const {
    if (same) return hn::Set(tag, static_cast<float>(all[*index].*which));
    alignas(64) float values[lanes];
    for (std::size_t n = 0; n < lanes; ++n) values[n] = static_cast<float>(all[index[n]].*which);
    return hn::Load(tag, values);
  }
};

/// Points that carry points, and their weights.
struct Carried {
  const std::int32_t *first, *second;
  Float weight_first, weight_second;
  Mask single;
  bool all_single;

  HWY_INLINE Vector of(const Row<float>* rows) const {
    const Vector a = vectors(rows, first);
    if (all_single) return a;
    return chosen(single, a, weight_first * a + weight_second * vectors(rows, second));
  }
};

/// What a point sees of the triangles of its short cache, one of each.
struct Listed {
  ClosestPoint seen[collision::most_cached];
  Index triangle[collision::most_cached], side[collision::most_cached];
  Mask matters[collision::most_cached];
};

/// That which counts as the nearest: physics::nearest_of().
struct Best {
  ClosestPoint seen;
  Index triangle, side;
  Mask any;
};

HWY_INLINE Best nearest_of(const Listed& all, std::size_t count, Float far) {
  const Float zero = hn::Zero(tag), one = hn::Set(tag, 1.0f);
  Best best;
  best.seen.N = all.seen[0].N;
  best.seen.e = all.seen[0].e;
  best.seen.at = all.seen[0].at;
  best.seen.L = all.seen[0].L;
  best.seen.z = all.seen[0].z;
  best.triangle = all.triangle[0];
  best.side = all.side[0];
  best.any = hn::Lt(zero, zero);
  Float straight = hn::Set(tag, -1.0f);
  for (std::size_t j = 0; j < count; ++j) {
    const ClosestPoint& seen = all.seen[j];
    const Float slant = hn::IfThenElseZero(hn::Gt(seen.L, zero), hn::Div(hn::Abs(seen.z), seen.L));
    const Float here = hn::IfThenElse(seen.at.face, one, slant);
    const Mask straighter =
        hn::Or(hn::Gt(here, straight), both(hn::Eq(here, straight), hn::Lt(seen.L, best.seen.L)));
    const Mask better = both(both(all.matters[j], hn::Le(seen.L, far)), straighter);
    straight = hn::IfThenElse(better, here, straight);
    best.seen.N = chosen(better, seen.N, best.seen.N);
    best.seen.e = chosen(better, seen.e, best.seen.e);
    best.seen.L = hn::IfThenElse(better, seen.L, best.seen.L);
    best.seen.z = hn::IfThenElse(better, seen.z, best.seen.z);
    best.seen.at.b = hn::IfThenElse(better, seen.at.b, best.seen.at.b);
    best.seen.at.c = hn::IfThenElse(better, seen.at.c, best.seen.at.c);
    best.seen.at.face = hn::Or(both(better, seen.at.face), hn::AndNot(better, best.seen.at.face));
    const auto turn = hn::RebindMask(index_tag, better);
    best.triangle = hn::IfThenElse(turn, all.triangle[j], best.triangle);
    best.side = hn::IfThenElse(turn, all.side[j], best.side);
    best.any = hn::Or(best.any, better);
  }
  return best;
}

struct Gap {
  Float d;
  Vector n;
  Mask contacts;
};

/// physics::closed_gap() and open_gap()
HWY_INLINE Gap gap_of(const ClosestPoint& seen, Mask closed, Float range, Float depth) {
  const Float zero = hn::Zero(tag), one = hn::Set(tag, 1.0f);
  const Mask behind = hn::Lt(seen.z, zero), inside = both(closed, behind), outside = hn::Lt(seen.L, range);
  const Mask deep = both(hn::Le(seen.L, depth), hn::Ge(hn::Neg(seen.z), hn::Mul(hn::Set(tag, 0.7f), seen.L)));
  const Vector back = {hn::Neg(seen.N.x), hn::Neg(seen.N.y), hn::Neg(seen.N.z)};
  const Mask turned = hn::AndNot(closed, behind);
  const Float d = hn::IfThenElse(inside, hn::Neg(seen.L), seen.L);
  const Vector beside = chosen(hn::Gt(seen.L, zero), hn::Div(one, d) * seen.e, seen.N);
  return {hn::IfThenElse(seen.at.face, hn::IfThenElse(turned, hn::Neg(seen.z), seen.z), d),
          chosen(seen.at.face, chosen(turned, back, seen.N), beside),
          hn::Or(both(inside, deep), hn::AndNot(inside, outside))};
}

/// Whether a triangle of another side than the first contact's may be in contact, too.
HWY_INLINE Mask second_side(const Listed& all, std::size_t count, const Best& first, Float range) {
  Mask any = hn::Lt(range, range);
  for (std::size_t j = 0; j < count; ++j) {
    const ClosestPoint& seen = all.seen[j];
    const Mask other = hn::RebindMask(tag, hn::Ne(all.side[j], first.side));
    const Mask straight =
        both(hn::Ge(seen.z, hn::Zero(tag)), hn::Ge(seen.z, hn::Mul(hn::Set(tag, 0.9f), seen.L)));
    any = hn::Or(any, both(both(all.matters[j], other), both(straight, hn::Lt(seen.L, range))));
  }
  return any;
}

void FindContacts(const ContactTables<float>& from, ContactBatch<float>& batch) {
  using Constants = physics::PairConstants<float>;
  const Float zero = hn::Zero(tag), one = hn::Set(tag, 1.0f);
  for (std::size_t n = 0; n < batch.count; n += lanes) {
    const auto numbers = [n](const auto& lane) { return hn::LoadU(index_tag, lane.data() + n); };
    const auto values = [n](const auto& lane) { return hn::LoadU(tag, lane.data() + n); };
    const Mask single = hn::RebindMask(tag, hn::Eq(numbers(batch.own[0]), numbers(batch.own[1])));
    const Carried carried = {batch.own[0].data() + n,
                             batch.own[1].data() + n,
                             values(batch.weight[0]),
                             values(batch.weight[1]),
                             single,
                             hn::AllTrue(tag, single)};
    const auto same = hn::Eq(numbers(batch.pair), hn::Set(index_tag, batch.pair[n]));
    const Pairs pairs = {from.pairs, batch.pair.data() + n, hn::AllTrue(index_tag, same)};
    const Vector P = carried.of(from.x), N_P = carried.of(from.normal);
    const Mask closed = hn::Ne(pairs.of(&Constants::closed), zero),
               either = hn::Eq(pairs.of(&Constants::opposing), zero);
    const Float range = pairs.of(&Constants::range), depth = pairs.of(&Constants::depth),
                tie = pairs.of(&Constants::tie);

    const Index cached = numbers(batch.cached);
    const auto count = static_cast<std::size_t>(hn::GetLane(hn::MaxOfLanes(index_tag, cached)));
    const std::uint32_t* lists[lanes];
    for (std::size_t lane = 0; lane < lanes; ++lane)
      lists[lane] = from.cache + static_cast<std::size_t>(batch.candidate_group[n + lane]) * from.entry_size;
    for (std::size_t next = n + lanes; next < std::min(n + 2 * lanes, batch.count); ++next) {
      const std::uint32_t* const cache =
          from.cache + static_cast<std::size_t>(batch.candidate_group[next]) * from.entry_size;
      for (std::int32_t j = 0; j < batch.cached[next]; ++j) hwy::Prefetch(&from.faces[cache[j]]);
    }
    Listed all;
    // All that is read for the same lanes comes before what is computed of it: reads wait for each other.
    Faces at[collision::most_cached];
    for (std::size_t j = 0; j < count; ++j) {
      alignas(64) std::int32_t t[lanes];
      for (std::size_t lane = 0; lane < lanes; ++lane)
        t[lane] = static_cast<std::int32_t>(
            lists[lane][j < static_cast<std::size_t>(batch.cached[n + lane]) ? j : 0]);
      at[j] = faces_at(from.faces, t);
      all.triangle[j] = hn::Load(index_tag, t);
      all.side[j] = at[j].side;
    }
    Float least = hn::Set(tag, std::numeric_limits<float>::infinity());
    for (std::size_t j = 0; j < count; ++j) {
      const Faces& faces = at[j];
      ClosestPoint& seen = all.seen[j];
      const Vector g = look(P, vectors(from.x, faces.corner[0]), vectors(from.x, faces.corner[1]),
                            vectors(from.x, faces.corner[2]), seen);
      const Mask there =
          hn::RebindMask(tag, hn::Gt(cached, hn::Set(index_tag, static_cast<std::int32_t>(j))));
      const Mask counts = both(both(there, real(g)), hn::Or(either, hn::Lt(dot3(N_P, g), zero)));
      all.matters[j] = counts;
      least = hn::IfThenElse(both(counts, hn::Lt(seen.L, least)), seen.L, least);
    }
    // As far as BodyContact::enough(), where nothing is eased apart.
    const Float in_contact = hn::Add(hn::Max(range, depth), tie);
    const Float nearest = hn::Add(hn::Max(least, range), tie);
    const Float rounding =
        hn::Add(hn::Mul(hn::Set(tag, 0.002f), pairs.of(&Constants::s)), hn::Set(tag, from.rounding));
    const Float enough = hn::Add(hn::IfThenElse(hn::Le(least, in_contact), nearest, in_contact), rounding);
    for (std::size_t j = 0; j < count; ++j)
      all.matters[j] = both(all.matters[j], hn::Le(all.seen[j].L, enough));

    const Best first = nearest_of(all, count, hn::Add(least, tie));
    const Gap gap = gap_of(first.seen, closed, range, depth);
    const Mask contacts = both(first.any, gap.contacts);
    const Mask undecided = hn::Or(hn::Not(hn::Gt(hn::LoadU(tag, batch.limit.data() + n), enough)),
                                  both(both(first.any, closed), second_side(all, count, first, range)));

    const Float b0 = hn::Sub(hn::Sub(one, first.seen.at.b), first.seen.at.c);
    hn::StoreU(first.triangle, index_tag, batch.triangle.data() + n);
    const Faces faces = faces_at(from.faces, batch.triangle.data() + n);
    const Vector v = carried.of(from.v);
    const Vector v_face =
        (b0 * vectors(from.v, faces.corner[0]) + first.seen.at.b * vectors(from.v, faces.corner[1])) +
        first.seen.at.c * vectors(from.v, faces.corner[2]);
    const Float c_u = hn::Mul(pairs.of(&Constants::c), dot3(gap.n, v - v_face));
    Float rest = hn::Mul(pairs.of(&Constants::k), hn::Sub(pairs.of(&Constants::reach), gap.d));
    if (from.at_end) rest = hn::Add(rest, c_u);
    const Float normal_force = hn::Sub(rest, c_u);

    const Float answer =
        hn::IfThenElse(undecided, hn::Set(tag, static_cast<float>(ContactBatch<float>::undecided)),
                       hn::IfThenElseZero(contacts, one));
    hn::StoreU(hn::ConvertTo(index_tag, answer), index_tag, batch.answer.data() + n);
    float* const to[3] = {batch.n[0].data(), batch.n[1].data(), batch.n[2].data()};
    store(gap.n, to, n);
    hn::StoreU(first.seen.at.b, tag, batch.b.data() + n);
    hn::StoreU(first.seen.at.c, tag, batch.c.data() + n);
    hn::StoreU(gap.d, tag, batch.d.data() + n);
    hn::StoreU(rest, tag, batch.static_force.data() + n);
    hn::StoreU(hn::IfThenElseZero(hn::Gt(normal_force, zero), normal_force), tag,
               batch.normal_force.data() + n);
  }
}

}  // namespace
}  // namespace aspic::parallel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace aspic::parallel {

HWY_EXPORT(Look);
HWY_EXPORT(FindContacts);

void look_in_lanes(const SightLanes& batch) {
  HWY_DYNAMIC_DISPATCH(Look)(batch);
}

void contacts_in_lanes(const collision::ContactTables<float>& from, collision::ContactBatch<float>& batch) {
  HWY_DYNAMIC_DISPATCH(FindContacts)(from, batch);
}

}  // namespace aspic::parallel
#endif

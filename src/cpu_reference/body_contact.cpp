#include "cpu_reference/body_contact.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "model/model.h"

namespace aspic::reference {
namespace {

constexpr std::uint32_t nowhere = 0xffffffffu;

/// Of lists of what is near, in spacings: larger ones take longer to make, and live longer.
constexpr double near_slack = 0.5;
/// For which short lists are made, in spacings: what is in no list of what is near stays out of their reach.
constexpr float longest_way = 0.3f;
/// A point that touches nothing until it has gone by so many spacings is not looked at until then.
constexpr float least_idle = 0.04f;

template <class T>
TouchConstants<T> rounded_pair(const ContactSettings& contact, const TouchBody& a, const TouchBody& b,
                               bool same, double ahead_step) {
  const TouchPair exact = touch_pair(contact, a, b, same);
  const TouchPair pair = ahead_step > 0.0 ? seen_ahead(exact, ahead_step) : exact;
  return {static_cast<T>(pair.stiffness),
          static_cast<T>(pair.damping),
          static_cast<T>(pair.friction),
          static_cast<T>(pair.spacing),
          static_cast<T>(pair.reach),
          static_cast<T>(pair.sight),
          static_cast<T>(pair.depth),
          static_cast<T>(pair.eased_depth),
          static_cast<T>(pair.margin),
          static_cast<T>(2e-6 * pair.spacing),
          b.closed,
          a.closed && b.closed};
}

/// P, or V: of the carriers' places or velocities.
template <class T, class Value>
Vector<T> carried(const TouchPoint& point, const Value& value) {
  if (point.single()) return value(point.carrier[0]);
  return static_cast<T>(point.weight[0]) * value(point.carrier[0]) +
         static_cast<T>(point.weight[1]) * value(point.carrier[1]);
}

/// The same of the points of the carriers.
template <class T, class Value>
Vector<T> over_own(const TouchPoint& point, const Value& value) {
  if (point.single()) return value(point.own[0]);
  return static_cast<T>(point.weight[0]) * value(point.own[0]) +
         static_cast<T>(point.weight[1]) * value(point.own[1]);
}

/// How far, up to `most` [m], a point may go against each corner of a triangle before it touches it, from
/// either side and whatever else is near; 0 or less if not far.
template <class T>
T free_way(const Sight<T>& seen, const Face<T>& face, const TouchConstants<T>& pair, T most) {
  const T first = std::min(most, seen.L - pair.sight), off = seen.L - pair.eased;
  if (!pair.closed || first <= off) return first;
  // Left is a touch from inside, for which −z has to become 0.7 L. With the corners its plane moves at the
  // point's foot by κ·way, κ the sum of the foot's absolute barycentric coordinates, and N turns.
  const T ab = norm3<T>(face.B - face.A), ac = norm3<T>(face.C - face.A), bc = norm3<T>(face.C - face.B);
  const T area = norm3<T>(face.g), longest = (ab + ac + bc) - std::min({ab, ac, bc});
  const T aside = std::sqrt(std::max(seen.L * seen.L - seen.z * seen.z, T(0)));
  const T kappa = T(1) + T(2.01) * aside * longest / area;
  for (T way = first; way > T(0.02) * pair.s; way *= T(0.8)) {
    const T turn = T(4) * way * (ab + ac + T(2) * way) / area;
    if (seen.z + T(0.7) * seen.L >
        std::abs(seen.z) * std::min(T(0.5) * turn * turn, T(2)) + way * (kappa + T(0.7)))
      return std::max(way, off);
  }
  return off;
}

/// Whether a triangle counts for a point with the normal N: between closed surfaces, if it turns to it.
template <class T>
bool counts(const Face<T>& face, const TouchConstants<T>& pair, const Vector<T>& N) {
  return face.real && (!pair.opposing || dot3<T>(N, face.g) < T(0));
}

template <class T>
Vector<T> place(const TouchPoint& point, const ParticleView<const T>& at) {
  return carried<T>(point, [&](std::uint32_t p) { return at.position(p); });
}

}  // namespace

template <class T>
TouchTable<T>::TouchTable(const ContactSettings& contact, const std::vector<TouchBody>& bodies,
                          double ahead_step) {
  std::vector<const TouchBody*> kinds;
  for (const TouchBody& body : bodies) {
    const auto found = std::ranges::find_if(kinds, [&](const TouchBody* k) { return k->alike(body); });
    kind_.push_back(static_cast<std::uint32_t>(found - kinds.begin()));
    if (found == kinds.end()) kinds.push_back(&body);
  }
  kinds_ = static_cast<std::uint32_t>(kinds.size());
  for (const TouchBody* a : kinds) pairs_.push_back(rounded_pair<T>(contact, *a, *a, true, ahead_step));
  for (const TouchBody* a : kinds)
    for (const TouchBody* b : kinds) pairs_.push_back(rounded_pair<T>(contact, *a, *b, false, ahead_step));
}

template <class T>
BodyContact<T>::BodyContact(const Model& model, double ahead_step)
    : surfaces_(touch_surfaces(model)),
      table_(model.contact, surfaces_.bodies, ahead_step),
      near_(model, surfaces_, near_slack, true),
      h_(static_cast<T>(model.simulation.timestep)),
      rubs_(table_.rubs()),
      timestep_(model.simulation.timestep),
      ways_(surfaces_),
      normals_(surfaces_),
      short_(surfaces_),
      x_(surfaces_.points.size()),
      v_(surfaces_.points.size()),
      place_of_(surfaces_.points.size(), nowhere),
      places_(surfaces_.points.size()) {
  for (std::uint32_t p = 0; p < surfaces_.points.size(); ++p) {
    const TouchPoint& point = surfaces_.points[p];
    for (std::size_t n = 0; n < 2; ++n) weight_[n].push_back(static_cast<T>(point.weight[n]));
    if (point.single()) surface_.push_back({point.carrier[0], p});
  }
  ease_apart(model, ahead_step > 0.0);
}

/// Distances in the initial state, in double precision whatever the solver's.
template <class T>
void BodyContact<T>::ease_apart(const Model& model, bool ahead) {
  if (ahead || !std::is_same_v<T, double>) {
    const BodyContact<double> fine(model);
    for (const auto& [point, body, d] : fine.eased()) eased_.push_back({point, body, static_cast<T>(d)});
  } else if constexpr (std::is_same_v<T, double>) {
    const Field<double> x = field<double>(model.initial_position.list(0, model.initial_position.size()));
    const Field<double> v = Field<double>::Zero(3, x.cols());
    const Particles start = {components(x.data()), components(v.data()), 3};
    initial_ = true;
    const bool touching = begin_step(0, start) && find(start);
    initial_ = false;
    if (!touching) return;
    std::vector<Eased> eased;
    for (const Touch<T>& touch : touches_) {
      const std::uint32_t body = body_of_triangle(touch.triangle);
      if (eased.empty() || eased.back().point != touch.point || eased.back().body != body)
        eased.push_back({touch.point, body, touch.d});
      eased.back().d = std::min(eased.back().d, touch.d);
    }
    eased_ = std::move(eased);
  }
}

template <class T>
bool BodyContact<T>::begin_measured(std::uint64_t step, const Particles& start) {
  time_ = static_cast<T>(static_cast<double>(step) * timestep_);
  if (!ways_.hold(near_)) {
    // Of what was not near, nothing has come as near as short lists reach if it has come little nearer than
    // the lists of what is near allow.
    if (!ways_.hold(near_, 0.2 * near_.slack()))
      for (std::size_t n = 0; n < own_.size(); ++n) short_.begin(n, -1.0);
    for (const auto& [particle, point] : surface_) {
      const Vector<T> x = start.position(particle);
      places_[point] = {x.x(), x.y(), x.z()};
    }
    near_.make(places_);
    ways_.begin(start);
    list_used(start);
  }
  laid_out_ = true;
  start_ = start;
  easing_ = std::ranges::any_of(eased_, [&](const Eased& eased) {
    const TouchConstants<T>& pair = table_.at(body_of(eased.point), eased.body);
    return back(eased, pair) < pair.reach;
  });
  return !near_.encounters().empty();
}

/// Other encounters are near.
template <class T>
void BodyContact<T>::list_used(const Particles& at) {
  name(near_.met());
  met_.clear();
  for (const std::uint32_t p : named_.added()) met_.push_back({surfaces_.points[p].carrier[0], p});
  lay_out(at, one_by_one);
  own_.clear();
  asked_.clear();
  std::uint32_t own = 0;  // they ascend
  for (const Encounter& near : near_.encounters()) {
    const TouchPoint& point = surfaces_.points[near.point];
    while (own + 1 < surfaces_.bodies.size() && surfaces_.bodies[own + 1].first_point <= near.point) ++own;
    own_.push_back(own);
    asked_.push_back(
        {point.own, {weight_[0][near.point], weight_[1][near.point]}, table_.of(own_.back(), near.body)});
  }
  short_.reset(near_, own_, x_);
  name(short_.followed());
  particles_.clear();
  for (const std::uint32_t p : named_.added()) {
    place_of_[p] = static_cast<std::uint32_t>(particles_.size());
    particles_.push_back(surfaces_.points[p].carrier[0]);
  }
  normals_.clear();
  for (std::size_t n = 0; n < own_.size(); ++n) want(n);
  normals_.sort();
}

/// These points, ascending and each once.
template <class T>
void BodyContact<T>::name(std::span<const std::uint32_t> points) {
  named_.clear();
  for (const std::uint32_t p : points) named_.add(p);
  named_.sort();
}

/// What is made ahead for the short list of an encounter.
template <class T>
void BodyContact<T>::want(std::size_t encounter) {
  if (short_[encounter].count > 0 && !short_[encounter].idle)
    normals_.want(surfaces_.points[near_.encounters()[encounter].point]);
}

/// Whether the box of a triangle holds a point near it at the start of the step.
template <class T>
bool BodyContact<T>::is_candidate(const Encounter& near, const TouchConstants<T>& pair,
                                  std::uint32_t triangle) const {
  const auto& corner = surfaces_.triangles[triangle].corner;
  const Vector<T> A = start_->position(corner[0]), B = start_->position(corner[1]),
                  C = start_->position(corner[2]);
  return box_holds<T>(Vector<T>(A.cwiseMin(B).cwiseMin(C)), Vector<T>(A.cwiseMax(B).cwiseMax(C)), pair.margin,
                      place<T>(surfaces_.points[near.point], *start_));
}

template <class T>
void BodyContact<T>::find_in(std::size_t number) {
  Piece& piece = pieces_[number];
  const bool in_turn = in_turn_.load(std::memory_order_acquire) == number;
  piece.out = in_turn ? &touches_ : &piece.touches;
  piece.touches.clear();
  piece.listed.clear();
  const std::size_t first = number * piece_size,
                    end = std::min(near_.encounters().size(), first + piece_size);
  TouchBatch<T> batch;
  if (side_by_side_ != nullptr && !easing_) {
    ask(first, end, batch);
    if (batch.count > 0) side_by_side_(tables(), batch);
  }
  std::size_t asked = 0;
  for (std::size_t n = first; n < end; ++n) {
    const bool side_by_side = asked < batch.count && static_cast<std::size_t>(batch.encounter[asked]) == n;
    const std::size_t place = side_by_side ? asked++ : 0;
    if (side_by_side && batch.answer[place] != batch.unsure) {
      if (batch.answer[place] == batch.touches) add(n, batch, place, piece);
    } else if (short_.may_touch(n)) {
      const Looker p = looker(n);
      if (stays_apart(p)) continue;
      if (!look_at_few(p, piece.sights)) look_at_all(p, piece);
      touch(p, piece);
    }
  }
  if (in_turn) in_turn_.store(number + 1, std::memory_order_release);
}

/// The encounters of a range whose short lists hold and name triangles.
template <class T>
void BodyContact<T>::ask(std::size_t first, std::size_t end, TouchBatch<T>& batch) const {
  for (std::size_t n = first; n < end; ++n) {
    if (!short_.holds(n) || !short_.may_touch(n)) continue;
    const std::uint32_t listed = short_[n].count;
    const std::size_t place = batch.count++;
    batch.encounter[place] = static_cast<std::int32_t>(n);
    batch.pair[place] = static_cast<std::int32_t>(asked_[n].pair);
    for (std::size_t each = 0; each < 2; ++each) {
      batch.own[each][place] = static_cast<std::int32_t>(asked_[n].own[each]);
      batch.weight[each][place] = asked_[n].weight[each];
    }
    batch.listed[place] = static_cast<std::int32_t>(listed);
    batch.limit[place] = static_cast<T>(short_.limit(n)) - static_cast<T>(near_.pad());
  }
  if (batch.count == 0) return;
  // Lanes behind the last look, too.
  const auto repeat = [&](auto& lane) {
    std::fill_n(lane.begin() + static_cast<std::ptrdiff_t>(batch.count), batch_behind, lane[batch.count - 1]);
  };
  repeat(batch.encounter);
  repeat(batch.pair);
  for (std::size_t each = 0; each < 2; ++each) {
    repeat(batch.own[each]);
    repeat(batch.weight[each]);
  }
  repeat(batch.listed);
  repeat(batch.limit);
}

template <class T>
TouchTables<T> BodyContact<T>::tables() const {
  const auto& lists = short_.lists();
  static_assert(sizeof(lists[0]) % sizeof(lists[0].triangle[0]) == 0);
  return {x_.data(),
          v_.data(),
          normals_.rows(),
          surfaces_.faces.data(),
          lists[0].triangle.data(),
          sizeof(lists[0]) / sizeof(lists[0].triangle[0]),
          table_.pairs().data(),
          static_cast<T>(near_.pad()),
          at_end_};
}

template <class T>
typename BodyContact<T>::Looker BodyContact<T>::looker(std::size_t n) const {
  const Encounter& near = near_.encounters()[n];
  const auto place = [&](std::uint32_t own) { return vector_of(x_[own]); };
  return {n, near, table_[asked_[n].pair], over_own<T>(surfaces_.points[near.point], place)};
}

/// N_P, where only faces count that turn to the point.
template <class T>
Vector<T> BodyContact<T>::normal_of(const Looker& p) const {
  if (!p.pair.opposing) return Vector<T>::Zero();
  return over_own<T>(surfaces_.points[p.near.point], [&](std::uint32_t own) { return normals_.at(own, x_); });
}

template <class T>
void BodyContact<T>::gather() {
  const std::size_t pieces = pieces_of(near_.encounters().size());
  for (std::size_t n = in_turn_; n < pieces; ++n)
    touches_.insert(touches_.end(), pieces_[n].touches.begin(), pieces_[n].touches.end());
  for (std::size_t n = 0; n < pieces; ++n)
    for (const std::size_t listed : pieces_[n].listed) want(listed);
}

template <class T>
std::uint32_t BodyContact<T>::body_of(std::uint32_t point) const {
  const auto after = std::ranges::upper_bound(surfaces_.bodies, point, {}, &TouchBody::first_point);
  return static_cast<std::uint32_t>(after - surfaces_.bodies.begin()) - 1;
}

template <class T>
std::uint32_t BodyContact<T>::body_of_triangle(std::uint32_t triangle) const {
  const auto after = std::ranges::upper_bound(surfaces_.bodies, triangle, {}, &TouchBody::first_triangle);
  return static_cast<std::uint32_t>(after - surfaces_.bodies.begin()) - 1;
}

/// More than distances are wrong by [m].
template <class T>
T BodyContact<T>::pad(const TouchConstants<T>& pair) const {
  return T(0.002) * pair.s + static_cast<T>(near_.pad());
}

/// Triangles farther than this [m] change nothing for a point whose nearest is `least` away.
template <class T>
T BodyContact<T>::enough(std::optional<T> least, const TouchConstants<T>& pair) const {
  const T touching = std::max(pair.sight, pair.eased) + pair.tie;
  return (least && *least <= touching ? std::max(*least, pair.sight) + pair.tie : touching) + pad(pair);
}

/// Whether a point that was to touch nothing for a while touches nothing for another, going by the triangles
/// that it may touch first.
template <class T>
bool BodyContact<T>::stays_apart(const Looker& p) {
  const auto& list = short_[p.n];
  if (!list.idle) return false;
  const T way = longest_way * p.pair.s, pad = this->pad(p.pair);
  double idle = short_.limit(p.n);
  for (std::size_t n = 0; n < list.count; ++n) {
    const Face<T> face = faces()[list.triangle[n]];
    if (!face.real) return false;
    const Sight<T> seen = sight_of<T>(list.triangle[n], 0, face, p.P);
    idle = std::min(idle, static_cast<double>(free_way<T>(seen, face, p.pair, way + pad) - pad));
  }
  if (!(idle >= static_cast<double>(least_idle * p.pair.s))) return false;
  short_.prolong(p.n, idle);
  return true;
}

/// Fills in `sights` with what may matter from the short list. Returns false if it does not hold.
template <class T>
bool BodyContact<T>::look_at_few(const Looker& p, std::vector<Sight<T>>& sights) const {
  sights.clear();
  if (!short_.holds(p.n)) return false;
  const auto& list = short_[p.n];
  const Vector<T> N = normal_of(p);
  std::optional<T> least;
  for (std::size_t n = 0; n < list.count; ++n) {
    const std::uint32_t t = list.triangle[n];
    const Face<T> face = faces()[t];
    if (!counts<T>(face, p.pair, N)) continue;
    sights.push_back(sight_of<T>(t, surfaces_.triangles[t].side, face, p.P));
    if (!least || sights.back().L < *least) least = sights.back().L;
  }
  const T matters = enough(least, p.pair);
  std::erase_if(sights, [&](const Sight<T>& seen) { return !(seen.L <= matters); });
  return short_.limit(p.n) > static_cast<double>(matters);
}

/// The same from all that is near. Then makes the short list, of the triangles that may come to matter before
/// the zone has gone by some way, or, of a point that touches none until then, of those that it may touch
/// first.
template <class T>
void BodyContact<T>::look_at_all(const Looker& p, Piece& piece) {
  const T way = longest_way * p.pair.s, pad = this->pad(p.pair);
  const T far = enough(std::nullopt, p.pair) + way;
  std::vector<Sight<T>>&sights = piece.sights, &around = piece.around;
  sights.clear();
  around.clear();
  piece.by_distance.clear();
  // No longer than that every triangle of the list is a candidate.
  auto& list = short_.begin(p.n, static_cast<double>(way));
  bool lasts = true;
  SightBatch<T> batch;
  batch.P = p.P;
  for (auto all = near_.triangles(p.near); !all.empty(); all = all.subspan(batch.count)) {
    batch.count = std::min(all.size(), batch_room);
    for (std::size_t n = 0; n < batch.count; ++n) batch.triangle[n] = static_cast<std::int32_t>(all[n]);
    look_(faces(), batch);
    for (std::size_t n = 0; n < batch.count; ++n) {
      if (!batch.real[n]) lasts = false;  // it may get an area
      if (!batch.real[n] || !(batch.L[n] <= far)) continue;
      piece.by_distance.push_back({batch.L[n], static_cast<std::uint32_t>(around.size())});
      around.push_back(batch.sight(n, surfaces_.triangles[all[n]].side));
    }
  }
  std::ranges::sort(piece.by_distance);
  piece.listed.push_back(p.n);
  // Most points touch nothing until they have gone by some way.
  piece.by_way.clear();
  T idle = way;
  for (std::size_t n = 0; n < around.size() && idle >= least_idle * p.pair.s; ++n) {
    const Sight<T>& seen = around[piece.by_distance[n].second];
    const T free = free_way<T>(seen, faces()[seen.triangle], p.pair, way + pad) - pad;
    idle = std::min(idle, free);
    if (free < way) piece.by_way.push_back({free, piece.by_distance[n].second});
  }
  if (idle >= least_idle * p.pair.s) {
    list.idle = lasts;
    list.spare = lasts ? static_cast<double>(idle) - short_.way(p.n) : -1.0;
    std::ranges::sort(piece.by_way);
    list.bound = list_first(p, piece.by_way, way, way, around) - short_.way(p.n);
    return;
  }
  const Vector<T> N = normal_of(p);
  for (const Sight<T>& seen : around)
    if (counts<T>(faces()[seen.triangle], p.pair, N) && is_candidate(p.near, p.pair, seen.triangle))
      sights.push_back(seen);
  const Sight<T>* const first = nearest_of<T>(sights, p.pair.tie, [](const Sight<T>&) { return true; });
  const T most = enough(first ? std::optional(first->L) : std::nullopt, p.pair) + way;
  list.bound = list_first(p, piece.by_distance, most, far, around) - short_.way(p.n);
  for (std::size_t n = 0; n < list.count; ++n)
    if (!is_candidate(p.near, p.pair, list.triangle[n])) lasts = false;  // it came within this step
  if (!lasts) list.spare = -1.0;
  std::sort(list.triangle.begin(), list.triangle.begin() + list.count);
}

/// The first by distance, up to `most` [m], are those of the short list. Returns the distance of the next, or
/// `beyond` if there is none [m].
template <class T>
double BodyContact<T>::list_first(const Looker& p, const Order& order, T most, T beyond,
                                  const std::vector<Sight<T>>& around) {
  auto& list = short_.list(p.n);
  for (const auto& [distance, n] : order) {
    if (distance > most || list.count == most_listed) return static_cast<double>(distance);
    list.triangle[list.count++] = around[n].triangle;
  }
  return static_cast<double>(beyond);
}

/// The contacts of a point with a body, from what it sees: the first, then second sides.
template <class T>
void BodyContact<T>::touch(const Looker& p, Piece& piece) const {
  const bool closed = p.pair.closed;
  const T depth = depth_of(p.near, p.pair);
  const Sight<T>* const first = nearest_of<T>(piece.sights, p.pair.tie, [](const Sight<T>&) { return true; });
  if (!first) return;
  const auto gap = closed ? closed_gap<T>(*first, p.pair.sight, depth) : open_gap<T>(*first, p.pair.sight);
  if (gap) add(p, *first, *gap, piece);
  if (!closed) return;
  const auto next_side = [&](std::uint32_t least) {
    std::uint32_t side = nowhere;
    for (const Sight<T>& seen : piece.sights)
      if (seen.side >= least && seen.side != first->side) side = std::min(side, seen.side);
    return side;
  };
  for (std::uint32_t side = next_side(0); side != nowhere; side = next_side(side + 1)) {
    const Sight<T>& seen =
        *nearest_of<T>(piece.sights, p.pair.tie, [&](const Sight<T>& each) { return each.side == side; });
    if (straight_in_front<T>(seen, p.pair.sight))
      add(p, seen, *closed_gap<T>(seen, p.pair.sight, depth), piece);
  }
}

template <class T>
void BodyContact<T>::add(const Looker& p, const Sight<T>& seen, const TouchGap<T>& gap, Piece& piece) const {
  Touch<T>& made = begin_touch(p.n, seen.triangle, seen.at.b, seen.at.c, piece);
  made.n = gap.n;
  made.d = gap.d;
  made.reach = reach_of(p.near, p.pair);
  const auto v = [&](std::uint32_t place) { return vector_of(v_[named_.added()[place]]); };
  const T u = dot3<T>(made.n, over_carriers<T>(made, v) - over_corners<T>(made, v));
  made.rest = made.k * (made.reach - made.d);
  if (at_end_) made.rest = made.rest + made.c * u;
  made.push = push_of<T>(made, u);
}

/// What has been found side by side.
template <class T>
void BodyContact<T>::add(std::size_t encounter, const TouchBatch<T>& batch, std::size_t place,
                         Piece& piece) const {
  Touch<T>& made = begin_touch(encounter, static_cast<std::uint32_t>(batch.triangle[place]), batch.b[place],
                               batch.c[place], piece);
  made.n = {batch.n[0][place], batch.n[1][place], batch.n[2][place]};
  made.d = batch.d[place];
  made.reach = table_[asked_[encounter].pair].reach;
  made.rest = batch.rest[place];
  made.push = batch.push[place];
}

template <class T>
Touch<T>& BodyContact<T>::begin_touch(std::size_t encounter, std::uint32_t triangle, T b, T c,
                                      Piece& piece) const {
  const Asked& asked = asked_[encounter];
  const auto& face = surfaces_.faces[triangle];
  const TouchConstants<T>& pair = table_[asked.pair];
  Touch<T>& made = piece.out->emplace_back();
  made.point = near_.encounters()[encounter].point;
  made.triangle = triangle;
  made.carriers = asked.own[0] == asked.own[1] ? 1 : 2;
  made.place = {place_of_[asked.own[0]], place_of_[asked.own[1]], place_of_[face[0]], place_of_[face[1]],
                place_of_[face[2]]};
  assert(named(asked.own[0]) && named(asked.own[1]) &&
         std::ranges::all_of(std::span(face).first(3), [&](std::uint32_t p) { return named(p); }));
  made.weight = {asked.weight[0], asked.weight[1], (T(1) - b) - c, b, c};
  made.k = pair.k;
  made.c = pair.c;
  made.mu = pair.mu;
  return made;
}

/// Where pushes of bodies that overlapped in the initial state begin by now [m].
template <class T>
T BodyContact<T>::back(const Eased& eased, const TouchConstants<T>& pair) const {
  return eased.d + pair.s * time_;
}

/// How a point is eased apart from a body in this step; null: it is not.
template <class T>
const typename BodyContact<T>::Eased* BodyContact<T>::easing(const Encounter& encounter,
                                                             const TouchConstants<T>& pair) const {
  if (!easing_) return nullptr;
  const auto key = [](const auto& of) { return std::tuple(of.point, of.body); };
  const auto found = std::ranges::lower_bound(eased_, key(encounter), {}, key);
  if (found == eased_.end() || key(*found) != key(encounter)) return nullptr;
  return back(*found, pair) < pair.reach ? &*found : nullptr;
}

/// ρ, or what of it has come back since the initial state, in which the bodies overlapped.
template <class T>
T BodyContact<T>::reach_of(const Encounter& encounter, const TouchConstants<T>& pair) const {
  const Eased* const eased = easing(encounter, pair);
  return eased ? back(*eased, pair) : pair.reach;
}

/// D, which is larger in the initial state and where that is eased apart.
template <class T>
T BodyContact<T>::depth_of(const Encounter& encounter, const TouchConstants<T>& pair) const {
  return initial_ || easing(encounter, pair) ? pair.eased : pair.depth;
}

template <class T>
void BodyContact<T>::push(std::vector<Vector<T>>& f) {
  share_.assign(particles_.size(), T(0));
  spread_pushes<T>(touches_, f, share_);
}

template <class T>
void BodyContact<T>::begin_friction(const Particles& start, const std::vector<Vector<T>>& f) {
  v1_.resize(particles_.size());
  for (std::size_t n = 0; n < particles_.size(); ++n) {
    v1_[n] = start.velocity(particles_[n]) + (h_ * w_[n]) * f[n];
    share_[n] = w_[n] * share_[n];
  }
}

template <class T>
void BodyContact<T>::find_friction(Touch<T>& touch) const {
  if (!(touch.push > T(0))) return;
  const auto part = [&](std::uint32_t place) { return share_[place]; };
  const auto v1 = [&](std::uint32_t place) { return v1_[place]; };
  const T W = (over_carriers<T>(touch, part) + over_corners<T>(touch, part)) / touch.push;
  touch.rub = friction_of<T>(touch, W, over_carriers<T>(touch, v1), over_corners<T>(touch, v1), h_);
}

template <class T>
void BodyContact<T>::rub(std::vector<Vector<T>>& f) const {
  spread<T>(touches_, f, [](const Touch<T>& touch) -> const Vector<T>& { return touch.rub; });
}

template <class T>
T BodyContact<T>::energy() const {
  T sum = T(0);
  for (const Touch<T>& touch : touches_) {
    const T near = touch.reach - touch.d;
    if (near > T(0)) sum += T(0.5) * touch.k * near * near;
  }
  return sum;
}

template <class T>
std::uint64_t BodyContact<T>::bytes() const {
  const auto of = [](const auto&... lists) { return ((lists.capacity() * sizeof(lists[0])) + ...); };
  std::uint64_t all = sizeof(*this) + near_.bytes() + normals_.bytes() + short_.bytes() + ways_.bytes() +
                      named_.bytes() + surfaces_.points.size() * sizeof(TouchPoint) +
                      surfaces_.triangles.size() *
                          (sizeof(TouchTriangle) + sizeof(surfaces_.faces[0]) + 3 * sizeof(std::uint32_t)) +
                      of(eased_, weight_[0], weight_[1], x_, v_, own_, asked_, surface_, met_, places_,
                         pieces_, touches_, particles_, place_of_, w_, share_, v1_);
  for (const Piece& p : pieces_) all += of(p.sights, p.around, p.by_distance, p.by_way, p.touches, p.listed);
  return all;
}

template class TouchTable<float>;
template class TouchTable<double>;
template class BodyContact<float>;
template class BodyContact<double>;

}  // namespace aspic::reference

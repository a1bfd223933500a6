#include "collision/contact_search.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

#include "model/model.h"

namespace aspic::collision {
namespace {

constexpr std::uint32_t nowhere = 0xffffffffu;

/// Of lists of what is near, in spacings: larger ones take longer to make, and live longer.
constexpr double near_slack = 0.5;
/// For which short lists are made, in spacings: what is in no list of what is near stays out of their reach.
constexpr float longest_way = 0.3f;
/// A point that touches nothing until it has gone by so many spacings is not looked at until then.
constexpr float least_idle = 0.04f;

/// P, or N_P, of the points of the carriers.
template <class T, class Value>
Vector<T> over_own(const SurfacePoint& point, const Value& value) {
  if (point.single()) return value(point.own[0]);
  return static_cast<T>(point.weight[0]) * value(point.own[0]) +
         static_cast<T>(point.weight[1]) * value(point.own[1]);
}

/// How far, up to `most` [m], a point may go against each corner of a triangle before it touches it, from
/// either side and whatever else is near; 0 or less if not far.
template <class T>
T free_way(const ClosestPoint<T>& seen, const Face<T>& face, const PairConstants<T>& pair, T most) {
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

}  // namespace

template <class T>
ContactSearch<T>::ContactSearch(const Model& model, double ahead_step)
    : ContactSearch(model, ahead_step, false) {
  ContactSearch<double> initial(model, 0.0, true);
  const Field<double> x = field<double>(model.initial_position.list(0, model.particle_count()));
  const Field<double> v = Field<double>::Zero(3, x.cols());
  const ParticleView<const double> at = {components(x.data()), components(v.data()), 3};
  if (initial.begin_step(0, at) && initial.find(at)) overlaps_ = {surfaces_, initial.contacts()};
}

template <class T>
ContactSearch<T>::ContactSearch(const Model& model, double ahead_step, bool initial)
    : ContactForces<T>(model.simulation.timestep),
      surfaces_(contact_surfaces(model)),
      table_(model.contact, surfaces_.bodies, ahead_step),
      near_(model, surfaces_, near_slack, true),
      timestep_(model.simulation.timestep),
      initial_(initial),
      ways_(surfaces_),
      normals_(surfaces_),
      short_(surfaces_),
      x_(surfaces_.points.size()),
      v_(surfaces_.points.size()),
      place_of_(surfaces_.points.size(), nowhere),
      places_(surfaces_.points.size()) {
  this->friction_ = table_.has_friction();
  for (std::uint32_t p = 0; p < surfaces_.points.size(); ++p) {
    const SurfacePoint& point = surfaces_.points[p];
    for (std::size_t n = 0; n < 2; ++n) weight_[n].push_back(static_cast<T>(point.weight[n]));
    if (point.single()) surface_.push_back({point.carrier[0], p});
  }
}

template <class T>
bool ContactSearch<T>::begin_measured(std::uint64_t step, const Particles& start) {
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
  overlaps_.begin_step(surfaces_, table_, static_cast<T>(static_cast<double>(step) * timestep_));
  return !near_.encounters().empty();
}

/// Other encounters are near.
template <class T>
void ContactSearch<T>::list_used(const Particles& at) {
  name(near_.met());
  met_.clear();
  for (const std::uint32_t p : named_.added()) met_.push_back({surfaces_.points[p].carrier[0], p});
  lay_out(at, one_by_one);
  own_.clear();
  asked_.clear();
  std::uint32_t own = 0;  // they ascend
  for (const PointCandidates& near : near_.encounters()) {
    const SurfacePoint& point = surfaces_.points[near.point];
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
void ContactSearch<T>::name(std::span<const std::uint32_t> points) {
  named_.clear();
  for (const std::uint32_t p : points) named_.add(p);
  named_.sort();
}

/// What is made ahead for the short list of an encounter.
template <class T>
void ContactSearch<T>::want(std::size_t encounter) {
  if (short_[encounter].count > 0 && !short_[encounter].idle)
    normals_.want(surfaces_.points[near_.encounters()[encounter].point]);
}

/// Whether the box of a triangle holds a point near it at the start of the step.
template <class T>
bool ContactSearch<T>::is_candidate(const PointCandidates& near, const PairConstants<T>& pair,
                                    std::uint32_t triangle) const {
  return box_of<T>(surfaces_.triangles[triangle], *start_)
      .holds(pair.margin, position_of<T>(surfaces_.points[near.point], *start_));
}

template <class T>
void ContactSearch<T>::find_in(std::size_t number) {
  Piece& piece = pieces_[number];
  const bool in_turn = in_turn_.load(std::memory_order_acquire) == number;
  piece.out = in_turn ? &contacts_ : &piece.contacts;
  piece.contacts.clear();
  piece.listed.clear();
  const std::size_t first = number * piece_size,
                    end = std::min(near_.encounters().size(), first + piece_size);
  ContactBatch<T> batch;
  if (side_by_side_ != nullptr && !overlaps_.active() && !initial_) {
    ask(first, end, batch);
    if (batch.count > 0) side_by_side_(tables(), batch);
  }
  std::size_t asked = 0;
  for (std::size_t n = first; n < end; ++n) {
    const bool side_by_side = asked < batch.count && static_cast<std::size_t>(batch.encounter[asked]) == n;
    const std::size_t place = side_by_side ? asked++ : 0;
    if (side_by_side && batch.answer[place] != batch.unsure) {
      if (batch.answer[place] == batch.contacts) add(n, batch, place, piece);
    } else if (short_.may_contact(n)) {
      const Looker p = looker(n);
      if (stays_apart(p)) continue;
      if (!look_at_few(p, piece.sights)) look_at_all(p, piece);
      contact(p, piece);
    }
  }
  if (in_turn) in_turn_.store(number + 1, std::memory_order_release);
}

/// The encounters of a range whose short lists hold and name triangles.
template <class T>
void ContactSearch<T>::ask(std::size_t first, std::size_t end, ContactBatch<T>& batch) const {
  for (std::size_t n = first; n < end; ++n) {
    if (!short_.holds(n) || !short_.may_contact(n)) continue;
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
ContactTables<T> ContactSearch<T>::tables() const {
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
typename ContactSearch<T>::Looker ContactSearch<T>::looker(std::size_t n) const {
  const PointCandidates& near = near_.encounters()[n];
  const auto place = [&](std::uint32_t own) { return vector_of(x_[own]); };
  return {n, near, table_[asked_[n].pair], over_own<T>(surfaces_.points[near.point], place)};
}

/// N_P, where only faces count that turn to the point.
template <class T>
Vector<T> ContactSearch<T>::normal_of(const Looker& p) const {
  if (!p.pair.opposing) return Vector<T>::Zero();
  return over_own<T>(surfaces_.points[p.near.point], [&](std::uint32_t own) { return normals_.at(own, x_); });
}

template <class T>
void ContactSearch<T>::gather() {
  const std::size_t pieces = pieces_of(near_.encounters().size());
  for (std::size_t n = in_turn_; n < pieces; ++n)
    contacts_.insert(contacts_.end(), pieces_[n].contacts.begin(), pieces_[n].contacts.end());
  for (std::size_t n = 0; n < pieces; ++n)
    for (const std::size_t listed : pieces_[n].listed) want(listed);
}

/// More than distances are wrong by [m].
template <class T>
T ContactSearch<T>::pad(const PairConstants<T>& pair) const {
  return T(0.002) * pair.s + static_cast<T>(near_.pad());
}

/// Triangles farther than this [m] change nothing for a point whose nearest is `least` away.
template <class T>
T ContactSearch<T>::enough(std::optional<T> least, const PairConstants<T>& pair) const {
  const T in_contact = std::max(pair.sight, pair.eased) + pair.tie;
  return (least && *least <= in_contact ? std::max(*least, pair.sight) + pair.tie : in_contact) + pad(pair);
}

/// Whether a point that was to touch nothing for a while touches nothing for another, going by the triangles
/// that it may touch first.
template <class T>
bool ContactSearch<T>::stays_apart(const Looker& p) {
  const auto& list = short_[p.n];
  if (!list.idle) return false;
  const T way = longest_way * p.pair.s, pad = this->pad(p.pair);
  double idle = short_.limit(p.n);
  for (std::size_t n = 0; n < list.count; ++n) {
    const Face<T> face = faces()[list.triangle[n]];
    if (!face.real) return false;
    const ClosestPoint<T> seen = sight_of<T>(list.triangle[n], 0, face, p.P);
    idle = std::min(idle, static_cast<double>(free_way<T>(seen, face, p.pair, way + pad) - pad));
  }
  if (!(idle >= static_cast<double>(least_idle * p.pair.s))) return false;
  short_.prolong(p.n, idle);
  return true;
}

/// Fills in `sights` with what may matter from the short list. Returns false if it does not hold.
template <class T>
bool ContactSearch<T>::look_at_few(const Looker& p, std::vector<ClosestPoint<T>>& sights) const {
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
  std::erase_if(sights, [&](const ClosestPoint<T>& seen) { return !(seen.L <= matters); });
  return short_.limit(p.n) > static_cast<double>(matters);
}

/// The same from all that is near. Then makes the short list, of the triangles that may come to matter before
/// the zone has gone by some way, or, of a point that touches none until then, of those that it may touch
/// first.
template <class T>
void ContactSearch<T>::look_at_all(const Looker& p, Piece& piece) {
  const T way = longest_way * p.pair.s, pad = this->pad(p.pair);
  const T far = enough(std::nullopt, p.pair) + way;
  std::vector<ClosestPoint<T>>&sights = piece.sights, &around = piece.around;
  sights.clear();
  around.clear();
  piece.by_distance.clear();
  // No longer than that every triangle of the list is a candidate.
  auto& list = short_.begin(p.n, static_cast<double>(way));
  bool lasts = true;
  ClosestPointBatch<T> batch;
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
    const ClosestPoint<T>& seen = around[piece.by_distance[n].second];
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
  for (const ClosestPoint<T>& seen : around)
    if (counts<T>(faces()[seen.triangle], p.pair, N) && is_candidate(p.near, p.pair, seen.triangle))
      sights.push_back(seen);
  const ClosestPoint<T>* const first =
      nearest_of<T>(sights, p.pair.tie, [](const ClosestPoint<T>&) { return true; });
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
double ContactSearch<T>::list_first(const Looker& p, const Order& order, T most, T beyond,
                                    const std::vector<ClosestPoint<T>>& around) {
  auto& list = short_.list(p.n);
  for (const auto& [distance, n] : order) {
    if (distance > most || list.count == most_listed) return static_cast<double>(distance);
    list.triangle[list.count++] = around[n].triangle;
  }
  return static_cast<double>(beyond);
}

template <class T>
void ContactSearch<T>::contact(const Looker& p, Piece& piece) const {
  const T depth = initial_ ? p.pair.eased : overlaps_.depth(p.near.point, p.near.body, p.pair);
  select_contacts<T>(piece.sights, p.pair, depth, [&](const ClosestPoint<T>& seen, const ContactGap<T>& gap) {
    add(p, seen, gap, piece);
  });
}

template <class T>
void ContactSearch<T>::add(const Looker& p, const ClosestPoint<T>& seen, const ContactGap<T>& gap,
                           Piece& piece) const {
  ContactPoint<T>& made = begin_contact(p.n, seen.triangle, seen.at.b, seen.at.c, piece);
  made.n = gap.n;
  made.d = gap.d;
  made.reach = overlaps_.reach(p.near.point, p.near.body, p.pair);
  const auto v = [&](std::uint32_t place) { return vector_of(v_[named_.added()[place]]); };
  set_normal_force<T>(made, dot3<T>(made.n, over_carriers<T>(made, v) - over_corners<T>(made, v)), at_end_);
}

/// What has been found side by side.
template <class T>
void ContactSearch<T>::add(std::size_t encounter, const ContactBatch<T>& batch, std::size_t place,
                           Piece& piece) const {
  ContactPoint<T>& made = begin_contact(encounter, static_cast<std::uint32_t>(batch.triangle[place]),
                                        batch.b[place], batch.c[place], piece);
  made.n = {batch.n[0][place], batch.n[1][place], batch.n[2][place]};
  made.d = batch.d[place];
  made.reach = table_[asked_[encounter].pair].reach;
  made.static_force = batch.static_force[place];
  made.normal_force = batch.normal_force[place];
}

template <class T>
ContactPoint<T>& ContactSearch<T>::begin_contact(std::size_t encounter, std::uint32_t triangle, T b, T c,
                                                 Piece& piece) const {
  const Asked& asked = asked_[encounter];
  const auto& face = surfaces_.faces[triangle];
  const PairConstants<T>& pair = table_[asked.pair];
  ContactPoint<T>& made = piece.out->emplace_back();
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

template <class T>
std::uint64_t ContactSearch<T>::bytes() const {
  const auto of = [](const auto&... lists) { return ((lists.capacity() * sizeof(lists[0])) + ...); };
  std::uint64_t all = sizeof(*this) + near_.bytes() + normals_.bytes() + short_.bytes() + ways_.bytes() +
                      named_.bytes() + surfaces_.points.size() * sizeof(SurfacePoint) +
                      surfaces_.triangles.size() *
                          (sizeof(SurfaceTriangle) + sizeof(surfaces_.faces[0]) + 3 * sizeof(std::uint32_t)) +
                      of(overlaps_.all(), weight_[0], weight_[1], x_, v_, own_, asked_, surface_, met_,
                         places_, pieces_, contacts_, particles_, place_of_, this->share_, this->v1_);
  for (const Piece& p : pieces_) all += of(p.sights, p.around, p.by_distance, p.by_way, p.contacts, p.listed);
  return all;
}

template class ContactSearch<float>;
template class ContactSearch<double>;

}  // namespace aspic::collision

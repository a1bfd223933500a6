#include "cpu_reference/body_contact.h"

#include <algorithm>
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

template <class T>
TouchConstants<T> rounded_pair(const TouchPair& exact, double ahead_step) {
  const TouchPair pair = ahead_step > 0.0 ? seen_ahead(exact, ahead_step) : exact;
  return {static_cast<T>(pair.stiffness), static_cast<T>(pair.damping), static_cast<T>(pair.friction),
          static_cast<T>(pair.spacing),   static_cast<T>(pair.reach),   static_cast<T>(pair.sight),
          static_cast<T>(pair.depth),     static_cast<T>(pair.margin),  static_cast<T>(2e-6 * pair.spacing)};
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
T free_way(const Sight<T>& seen, const Face<T>& face, bool closed, const TouchConstants<T>& pair, T most) {
  const T first = std::min(most, seen.L - pair.sight), off = seen.L - pair.depth;
  if (!closed || first <= off) return first;
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
  for (const TouchBody* a : kinds) {
    self_.push_back(rounded_pair<T>(touch_pair(contact, *a, *a, true), ahead_step));
    for (const TouchBody* b : kinds)
      pairs_.push_back(rounded_pair<T>(touch_pair(contact, *a, *b, false), ahead_step));
  }
}

template <class T>
BodyContact<T>::BodyContact(const Model& model, double ahead_step)
    : surfaces_(touch_surfaces(model)),
      table_(model.contact, surfaces_.bodies, ahead_step),
      near_(model, surfaces_, near_slack, true),
      h_(static_cast<T>(model.simulation.timestep)),
      rubs_(table_.rubs()),
      timestep_(model.simulation.timestep),
      normals_(surfaces_),
      short_(surfaces_),
      places_(surfaces_.points.size()),
      place_of_(model.particle_count(), nowhere) {
  for (std::uint32_t p = 0; p < surfaces_.points.size(); ++p)
    if (surfaces_.points[p].single()) surface_.push_back({surfaces_.points[p].carrier[0], p});
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
    if (!begin_step(0, start) || !find(start)) return;
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
bool BodyContact<T>::begin_step(std::uint64_t step, const Particles& start) {
  time_ = static_cast<T>(static_cast<double>(step) * timestep_);
  const auto slack = static_cast<T>(near_.slack()), leeway = static_cast<T>(near_.leeway());
  const Gone gone = this->gone(start);
  if (!(gone.far <= leeway && gone.apart <= slack)) {
    // Of what was not near, nothing has come as near as short lists reach if nothing has gone much further
    // than the lists of what is near allow.
    if (!(gone.far <= leeway + T(0.2) * slack && gone.apart <= T(1.4) * slack))
      for (std::size_t n = 0; n < own_.size(); ++n) short_.begin(n, -1.0);
    known_places_.resize(surface_.size());
    for (std::size_t n = 0; n < surface_.size(); ++n) {
      const Vector<T> x = start.position(surface_[n].particle);
      known_places_[n] = x;
      places_[surface_[n].point] = {x.x(), x.y(), x.z()};
    }
    near_.make(places_);
    list_used(start);
  }
  start_ = start;
  return !near_.encounters().empty();
}

template <class T>
typename BodyContact<T>::Gone BodyContact<T>::gone(const Particles& at) const {
  constexpr T far = std::numeric_limits<T>::infinity();
  if (known_places_.size() != surface_.size()) return {far, far};
  T most = T(0);
  bool sound = true;
  for (std::size_t n = 0; n < surface_.size(); ++n) {
    const Vector<T> way = at.position(surface_[n].particle) - known_places_[n];
    const T square = dot3<T>(way, way);
    sound = sound && square < far;  // what is no number has gone anywhere
    most = square > most ? square : most;
  }
  if (!sound) return {far, far};
  using Array = Eigen::Array<T, 3, 1>;
  const auto around = [&](std::uint32_t from, std::uint32_t end) {
    std::pair<Array, Array> box = {Array::Constant(far), Array::Constant(-far)};
    for (std::uint32_t n = from; n < end; ++n) {
      const Array way = (at.position(met_[n]) - met_from_[n]).array();
      box.first = box.first.min(way);
      box.second = box.second.max(way);
    }
    return box;
  };
  T apart = T(0);
  for (const Meeting& meeting : near_.meetings()) {
    const auto a = around(meeting.first, meeting.second == meeting.first ? meeting.end : meeting.second);
    const auto b = around(meeting.second, meeting.end);
    apart = std::max({apart, (a.second - b.first).maxCoeff(), (b.second - a.first).maxCoeff()});
  }
  return {std::sqrt(most), apart};
}

/// Other encounters are near.
template <class T>
void BodyContact<T>::list_used(const Particles& at) {
  met_.clear();
  met_from_.clear();
  for (const std::uint32_t point : near_.met()) {
    met_.push_back(surfaces_.points[point].carrier[0]);
    met_from_.push_back(at.position(met_.back()));
  }
  own_.clear();
  for (const Encounter& near : near_.encounters()) own_.push_back(body_of(near.point));
  short_.reset(near_, own_, at);
  normals_.clear();
  for (std::size_t n = 0; n < own_.size(); ++n) want(n);
  normals_.sort();
}

/// What is made ahead for the short list of an encounter.
template <class T>
void BodyContact<T>::want(std::size_t encounter) {
  if (short_[encounter].count > 0) normals_.want(surfaces_.points[near_.encounters()[encounter].point]);
}

/// Whether the box of a triangle near a point holds it at the start of the step.
template <class T>
bool BodyContact<T>::is_candidate(const Encounter& near, std::uint32_t triangle) const {
  const auto& corner = surfaces_.triangles[triangle].corner;
  const Vector<T> A = start_->position(corner[0]), B = start_->position(corner[1]),
                  C = start_->position(corner[2]);
  const T margin = table_.at(body_of(near.point), near.body).margin;
  return box_holds<T>(Vector<T>(A.cwiseMin(B).cwiseMin(C)), Vector<T>(A.cwiseMax(B).cwiseMax(C)), margin,
                      place<T>(surfaces_.points[near.point], *start_));
}

template <class T>
void BodyContact<T>::find_in(std::size_t piece, const Particles& at) {
  pieces_[piece].touches.clear();
  pieces_[piece].listed.clear();
  const std::size_t end = std::min(near_.encounters().size(), (piece + 1) * piece_size);
  SightBatch<T> batch;
  for (std::size_t n = piece * piece_size; n < end; ++n) {
    const auto& list = short_[n];
    if (list.count == 0 && short_.holds(n)) continue;
    if (batch.count + list.count > SightBatch<T>::room) look(batch, pieces_[piece]);
    pieces_[piece].queue.push_back(looker(n, at));
    put(pieces_[piece].queue.back(), batch);
    pieces_[piece].ends.push_back(batch.count);
  }
  look(batch, pieces_[piece]);
}

template <class T>
typename BodyContact<T>::Looker BodyContact<T>::looker(std::size_t n, const Particles& at) const {
  const Encounter& near = near_.encounters()[n];
  const TouchPoint& point = surfaces_.points[near.point];
  const bool opposing = surfaces_.bodies[near.body].closed && surfaces_.bodies[own_[n]].closed;
  return {n,
          near,
          own_[n],
          table_.at(own_[n], near.body),
          opposing,
          place<T>(point, at),
          opposing ? over_own<T>(point, [&](std::uint32_t own) { return normals_.at(own, at); })
                   : Vector<T>(Vector<T>::Zero()),
          at};
}

/// The triangles of its short list are looked at; of one that does not hold, none.
template <class T>
void BodyContact<T>::put(const Looker& p, SightBatch<T>& batch) const {
  const auto& list = short_[p.n];
  if (!short_.holds(p.n)) return;
  batch.ask(batch.count, list.count, p.P, p.opposing ? std::optional(p.N) : std::nullopt);
  for (std::size_t n = 0; n < list.count; ++n, ++batch.count)
    batch.set_corner(batch.count, surfaces_.triangles[list.triangle[n]].corner);
}

/// Finds the contacts of those in the queue, and empties it.
template <class T>
void BodyContact<T>::look(SightBatch<T>& batch, Piece& piece) {
  if (piece.queue.empty()) return;
  if (batch.count > 0) look_(piece.queue.front().at, batch);
  for (std::size_t n = 0; n < piece.queue.size(); ++n) {
    const Looker& p = piece.queue[n];
    if (!look_at_few(p, batch, n > 0 ? piece.ends[n - 1] : 0, piece.sights)) look_at_all(p, piece);
    touch(p, piece);
  }
  piece.queue.clear();
  piece.ends.clear();
  batch.count = 0;
}

template <class T>
bool BodyContact<T>::gather() {
  touches_.clear();
  for (std::size_t n = 0; n < pieces_of(near_.encounters().size()); ++n) {
    touches_.insert(touches_.end(), pieces_[n].touches.begin(), pieces_[n].touches.end());
    for (const std::size_t listed : pieces_[n].listed) want(listed);
  }
  name_particles();
  return !touches_.empty();
}

template <class T>
std::uint32_t BodyContact<T>::body_of(std::uint32_t point) const {
  const auto after = std::ranges::upper_bound(surfaces_.bodies, point, {}, &TouchBody::first_point);
  return static_cast<std::uint32_t>(after - surfaces_.bodies.begin()) - 1;
}

template <class T>
std::uint32_t BodyContact<T>::body_of_particle(std::uint32_t particle) const {
  const auto first = [&](const TouchBody& body) { return surfaces_.points[body.first_point].carrier[0]; };
  const auto after = std::ranges::upper_bound(surfaces_.bodies, particle, {}, first);
  return static_cast<std::uint32_t>(after - surfaces_.bodies.begin()) - 1;
}

template <class T>
std::uint32_t BodyContact<T>::body_of_triangle(std::uint32_t triangle) const {
  const auto after = std::ranges::upper_bound(surfaces_.bodies, triangle, {}, &TouchBody::first_triangle);
  return static_cast<std::uint32_t>(after - surfaces_.bodies.begin()) - 1;
}

/// Whether a triangle counts for a point: between closed surfaces, if it turns to it.
template <class T>
bool BodyContact<T>::counts(const Face<T>& face, const Looker& p) const {
  return face.real && (!p.opposing || dot3<T>(p.N, face.g) < T(0));
}

/// More than distances are wrong by [m].
template <class T>
T BodyContact<T>::pad(const TouchConstants<T>& pair) const {
  return T(0.002) * pair.s + static_cast<T>(near_.pad());
}

/// Triangles farther than this [m] change nothing for a point whose nearest is `least` away.
template <class T>
T BodyContact<T>::enough(std::optional<T> least, const TouchConstants<T>& pair) const {
  const T touching = std::max(pair.sight, pair.depth) + pair.tie;
  return (least && *least <= touching ? std::max(*least, pair.sight) + pair.tie : touching) + pad(pair);
}

/// Fills in `sights` with what may matter from the short list, which the batch has from here on. Returns
/// false if it does not hold.
template <class T>
bool BodyContact<T>::look_at_few(const Looker& p, const SightBatch<T>& batch, std::size_t from,
                                 std::vector<Sight<T>>& sights) const {
  sights.clear();
  if (!short_.holds(p.n)) return false;
  const auto& list = short_[p.n];
  std::optional<T> least;
  for (std::size_t n = 0; n < list.count; ++n)
    if (batch.counts[from + n] && (!least || batch.L[from + n] < *least)) least = batch.L[from + n];
  const T matters = enough(least, p.pair);
  if (!(list.bound - short_.way(p.n) > static_cast<double>(matters))) return false;
  for (std::size_t n = 0; n < list.count; ++n)
    if (batch.counts[from + n] && batch.L[from + n] <= matters)
      sights.push_back(batch.sight(from + n, list.triangle[n], surfaces_.triangles[list.triangle[n]].side));
  return true;
}

/// The same from all that is near. Then makes the short list, of the triangles that may come to matter before
/// the zone has gone by some way.
template <class T>
void BodyContact<T>::look_at_all(const Looker& p, Piece& piece) {
  const T way = T(0.2) * p.pair.s, pad = this->pad(p.pair);
  const T far = enough(std::nullopt, p.pair) + way;
  std::vector<Sight<T>>&sights = piece.sights, &around = piece.around;
  sights.clear();
  around.clear();
  // No longer than that every triangle of the list is a candidate.
  auto& list = short_.begin(p.n, static_cast<double>(way));
  bool lasts = true;
  T idle = way;  // touches nothing until it has gone by this; most points do not
  const bool closed = surfaces_.bodies[p.near.body].closed;
  SightBatch<T> batch;
  for (auto all = near_.triangles(p.near); !all.empty(); all = all.subspan(batch.count)) {
    batch.count = std::min(all.size(), SightBatch<T>::room);
    batch.ask(0, batch.count, p.P, std::nullopt);
    for (std::size_t n = 0; n < batch.count; ++n) batch.set_corner(n, surfaces_.triangles[all[n]].corner);
    look_(p.at, batch);
    for (std::size_t n = 0; n < batch.count; ++n) {
      if (!batch.counts[n]) lasts = false;  // it may get an area
      if (!batch.counts[n] || !(batch.L[n] <= far)) continue;
      const std::uint32_t t = all[n];
      const auto& corner = surfaces_.triangles[t].corner;
      const Face<T> face =
          face_of<T>(p.at.position(corner[0]), p.at.position(corner[1]), p.at.position(corner[2]));
      around.push_back(batch.sight(n, t, surfaces_.triangles[t].side));
      if (idle > T(0)) idle = free_way<T>(around.back(), face, closed, p.pair, idle + pad) - pad;
      if (counts(face, p) && is_candidate(p.near, t)) sights.push_back(around.back());
    }
  }
  if (idle < T(0.02) * p.pair.s) idle = T(0);
  piece.listed.push_back(p.n);
  if (idle > T(0)) {
    list.spare = lasts ? std::min(static_cast<double>(idle) - short_.way(p.n), list.spare) : -1.0;
    return;
  }
  const Sight<T>* const first = nearest_of<T>(sights, p.pair.tie, [](const Sight<T>&) { return true; });
  piece.by_distance.clear();
  for (std::uint32_t n = 0; n < around.size(); ++n)
    if (around[n].L <= far) piece.by_distance.push_back({around[n].L, n});
  std::ranges::sort(piece.by_distance);
  const T most = enough(first ? std::optional(first->L) : std::nullopt, p.pair) + way;
  for (const auto& [L, n] : piece.by_distance) {
    if (L > most || list.count == short_.most) break;
    const std::uint32_t t = around[n].triangle;
    list.triangle[list.count++] = t;
    if (!is_candidate(p.near, t)) lasts = false;  // it came within this step
  }
  const bool all = list.count == piece.by_distance.size();
  const double bound = static_cast<double>(all ? far : piece.by_distance[list.count].first);
  list.bound = bound - short_.way(p.n);
  if (!lasts) list.spare = -1.0;
  std::sort(list.triangle.begin(), list.triangle.begin() + list.count);
}

/// The contacts of a point with a body, from what it sees: the first, then second sides.
template <class T>
void BodyContact<T>::touch(const Looker& p, Piece& piece) const {
  const bool closed = surfaces_.bodies[p.near.body].closed;
  const Sight<T>* const first = nearest_of<T>(piece.sights, p.pair.tie, [](const Sight<T>&) { return true; });
  if (!first) return;
  const auto gap =
      closed ? closed_gap<T>(*first, p.pair.sight, p.pair.depth) : open_gap<T>(*first, p.pair.sight);
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
      add(p, seen, *closed_gap<T>(seen, p.pair.sight, p.pair.depth), piece);
  }
}

template <class T>
void BodyContact<T>::add(const Looker& p, const Sight<T>& seen, const TouchGap<T>& gap, Piece& piece) const {
  const TouchPoint& point = surfaces_.points[p.near.point];
  const auto& corner = surfaces_.triangles[seen.triangle].corner;
  const auto& [b, c, face] = seen.at;
  Touch<T>& made = piece.touches.emplace_back();
  made.point = p.near.point;
  made.triangle = seen.triangle;
  made.carriers = point.single() ? 1 : 2;
  made.particle = {point.carrier[0], point.carrier[1], corner[0], corner[1], corner[2]};
  made.place = made.particle;  // until they are named
  made.weight = {static_cast<T>(point.weight[0]), static_cast<T>(point.weight[1]), (T(1) - b) - c, b, c};
  made.n = gap.n;
  made.d = gap.d;
  made.reach = reach_of(p.near, p.pair);
  made.k = p.pair.k;
  made.c = p.pair.c;
  made.mu = p.pair.mu;
  const auto v = [&](std::uint32_t i) { return p.at.velocity(i); };
  const T u = dot3<T>(made.n, over_carriers<T>(made, v) - over_corners<T>(made, v));
  made.rest = made.k * (made.reach - made.d);
  if (at_end_) made.rest = made.rest + made.c * u;
  made.push = push_of<T>(made, u);
}

/// ρ, or what of it has come back since the initial state, in which the bodies overlapped.
template <class T>
T BodyContact<T>::reach_of(const Encounter& encounter, const TouchConstants<T>& pair) const {
  if (eased_.empty()) return pair.reach;
  const auto key = [](const auto& of) { return std::tuple(of.point, of.body); };
  const auto found = std::ranges::lower_bound(eased_, key(encounter), {}, key);
  if (found == eased_.end() || key(*found) != key(encounter)) return pair.reach;
  const T back = found->d + pair.s * time_;
  return back < pair.reach ? back : pair.reach;
}

template <class T>
void BodyContact<T>::name_particles() {
  for (const std::uint32_t p : particles_) place_of_[p] = nowhere;
  particles_.clear();
  for (const Touch<T>& touch : touches_)
    for (const std::uint32_t p : touch.particle) place_of_[p] = 0;
  // Points of particles are in the order of these.
  if (!touches_.empty()) {
    for (const auto& [particle, point] : surface_) {
      if (place_of_[particle] == nowhere) continue;
      place_of_[particle] = static_cast<std::uint32_t>(particles_.size());
      particles_.push_back(particle);
    }
  }
  for (Touch<T>& touch : touches_)
    for (std::size_t n = 0; n < 5; ++n) touch.place[n] = place_of_[touch.particle[n]];
}

template <class T>
void BodyContact<T>::find_friction() {
  share_.assign(particles_.size(), T(0));
  share<T>(touches_, share_);
  const auto part = [&](std::uint32_t place) { return inverse_mass_[place] * share_[place]; };
  const auto v1 = [&](std::uint32_t place) { return v1_[place]; };
  for (Touch<T>& touch : touches_) {
    if (!(touch.push > T(0))) continue;
    const T W = (over_carriers<T>(touch, part) + over_corners<T>(touch, part)) / touch.push;
    touch.rub = friction_of<T>(touch, W, over_carriers<T>(touch, v1), over_corners<T>(touch, v1), h_);
  }
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
  std::uint64_t all = sizeof(*this) + near_.bytes() + normals_.bytes() + short_.bytes() +
                      surfaces_.points.size() * sizeof(TouchPoint) +
                      surfaces_.triangles.size() * (sizeof(TouchTriangle) + 3 * sizeof(std::uint32_t)) +
                      of(eased_, own_, surface_, known_places_, met_, met_from_, places_, pieces_, touches_,
                         particles_, place_of_, inverse_mass_, share_, v1_);
  for (const Piece& p : pieces_)
    all += of(p.queue, p.ends, p.sights, p.around, p.by_distance, p.touches, p.listed);
  return all;
}

template class TouchTable<float>;
template class TouchTable<double>;
template class BodyContact<float>;
template class BodyContact<double>;

}  // namespace aspic::reference

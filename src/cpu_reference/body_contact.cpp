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
      near_(model, surfaces_),
      h_(static_cast<T>(model.simulation.timestep)),
      rubs_(table_.rubs()),
      timestep_(model.simulation.timestep),
      faces_(surfaces_),
      places_(surfaces_.points.size()),
      place_of_(model.particle_count(), nowhere) {
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
  for (std::size_t p = 0; p < surfaces_.points.size(); ++p) {
    if (!surfaces_.points[p].single()) continue;
    const Vector<T> x = start.position(surfaces_.points[p].carrier[0]);
    places_[p] = {x.x(), x.y(), x.z()};
  }
  if (near_.update(places_)) list_used();
  start_ = start;
  return !near_.encounters().empty();
}

/// Which triangles and normals the lists of what is near ask for.
template <class T>
void BodyContact<T>::list_used() {
  all_near_.begin();
  own_.clear();
  NumberSet particles;
  for (const Encounter& near : near_.encounters()) {
    const TouchPoint& point = surfaces_.points[near.point];
    all_near_.add(near_.triangles(near));
    all_near_.add_carriers(point);
    own_.push_back(body_of(near.point));
    for (const std::uint32_t own : point.own) particles.add(own);
  }
  NumberSet corners;
  for (const std::uint32_t t : all_near_.added())
    for (const std::uint32_t corner : surfaces_.triangles[t].corner) corners.add(corner);
  std::vector<std::array<std::uint32_t, 2>> followed;  // body, particle
  for (const std::uint32_t own : particles.list())
    followed.push_back({body_of(own), surfaces_.points[own].carrier[0]});
  for (const std::uint32_t corner : corners.list()) followed.push_back({body_of_particle(corner), corner});
  short_.reset(near_.encounters().size(), surfaces_.bodies.size(), std::move(followed));
  all_near_.end(surfaces_);
  few_stale_ = true;
}

/// The same for the short lists.
template <class T>
void BodyContact<T>::list_short() {
  few_.begin();
  for (std::size_t n = 0; n < near_.encounters().size(); ++n) {
    const auto& list = short_[n];
    if (list.count == 0) continue;
    few_.add(std::span(list.triangle).first(list.count));
    few_.add_carriers(surfaces_.points[near_.encounters()[n].point]);
  }
  few_.end(surfaces_);
  few_stale_ = false;
}

/// Faces and normals of everything, or, where nearly all short lists hold, of what those ask for; the rest is
/// made where something asks for it.
template <class T>
void BodyContact<T>::choose_faces(const Particles& at) {
  short_.follow(at);
  const auto encounters = near_.encounters();
  std::size_t lost = 0;
  for (std::size_t n = 0; n < encounters.size(); ++n) lost += !short_.holds(n, own_[n], encounters[n].body);
  const bool few = 8 * lost < encounters.size();
  if (few && few_stale_) list_short();
  faces_.begin(few ? few_ : all_near_);
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
  const std::size_t end = std::min(near_.encounters().size(), (piece + 1) * piece_size);
  for (std::size_t n = piece * piece_size; n < end; ++n) touch(n, at, pieces_[piece]);
}

template <class T>
bool BodyContact<T>::gather() {
  touches_.clear();
  for (std::size_t n = 0; n < pieces_of(near_.encounters().size()); ++n) {
    touches_.insert(touches_.end(), pieces_[n].touches.begin(), pieces_[n].touches.end());
    few_stale_ = few_stale_ || std::exchange(pieces_[n].lists_changed, false);
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

/// Fills in `sights` from the short list. Returns false if it does not hold.
template <class T>
bool BodyContact<T>::look_at_few(const Looker& p, std::vector<Sight<T>>& sights) const {
  if (!short_.holds(p.n, p.own, p.near.body)) return false;
  const auto& list = short_[p.n];
  bool nearest_counts = list.nearest == short_.none;
  sights.clear();
  Face<T> room;
  for (std::uint32_t n = 0; n < list.count; ++n) {
    const std::uint32_t t = list.triangle[n];
    const Face<T>& f = faces_.face(t, p.at, room);
    if (!counts(f, p)) continue;
    sights.push_back(sight_of<T>(t, surfaces_.triangles[t].side, f, p.P));
    nearest_counts = nearest_counts || t == list.nearest;
  }
  return nearest_counts;
}

/// The same from all that is near. What is farther than `far` [m] touches nothing. Then makes the short list:
/// with β the way that bodies may go, no triangle comes nearer than by β, so that only those may become the
/// nearest that are no farther than 2β more than it, and only those second sides that are within β of their
/// reach.
template <class T>
void BodyContact<T>::look_at_all(const Looker& p, Piece& piece) {
  const T way = T(0.025) * p.pair.s, slack = T(0.002) * p.pair.s;
  const T far = std::max(p.pair.sight, p.pair.depth) + T(0.01) * p.pair.s;
  std::vector<Sight<T>>&sights = piece.sights, &around = piece.around;
  sights.clear();
  around.clear();
  auto& list = short_.begin(p.n, p.own, p.near.body, static_cast<double>(way));
  Face<T> room;
  for (const std::uint32_t t : near_.triangles(p.near)) {
    const Face<T>& f = faces_.face(t, p.at, room);
    if (beyond<T>(f, far + way + slack, p.P)) continue;
    if (!f.real) list.until = -1.0;  // it may get an area
    if (!f.real) continue;
    around.push_back(sight_of<T>(t, surfaces_.triangles[t].side, f, p.P));
    if (counts(f, p) && is_candidate(p.near, t)) sights.push_back(around.back());
  }
  const Sight<T>* const first = nearest_of<T>(sights, p.pair.tie, [](const Sight<T>&) { return true; });
  if (first) list.nearest = first->triangle;
  const T most = first ? std::max(first->L + T(2) * way, p.pair.sight + way) + slack : far + way + slack;
  for (const Sight<T>& seen : around) {
    if (seen.L > most) continue;
    short_.add(list, seen.triangle);
    if (!is_candidate(p.near, seen.triangle)) list.until = -1.0;  // it came within this step
  }
  piece.lists_changed = true;
}

/// The contacts of a point with a body: the first, then second sides.
template <class T>
void BodyContact<T>::touch(std::size_t n, const Particles& at, Piece& piece) {
  const Encounter& near = near_.encounters()[n];
  const bool listed = short_.holds(n, own_[n], near.body);
  if (listed && short_[n].count == 0) return;
  const TouchPoint& point = surfaces_.points[near.point];
  const bool closed = surfaces_.bodies[near.body].closed;
  const bool opposing = closed && surfaces_.bodies[own_[n]].closed;
  const Looker p = {n,
                    near,
                    own_[n],
                    table_.at(own_[n], near.body),
                    opposing,
                    place<T>(point, at),
                    opposing ? over_own<T>(point, [&](std::uint32_t own) { return faces_.normal(own, at); })
                             : Vector<T>(Vector<T>::Zero()),
                    at};
  if (!look_at_few(p, piece.sights)) look_at_all(p, piece);
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
    for (const TouchPoint& point : surfaces_.points) {
      if (!point.single() || place_of_[point.carrier[0]] == nowhere) continue;
      place_of_[point.carrier[0]] = static_cast<std::uint32_t>(particles_.size());
      particles_.push_back(point.carrier[0]);
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
  return sizeof(*this) + near_.bytes() + surfaces_.points.size() * (sizeof(TouchPoint) + sizeof(Vec3)) +
         surfaces_.triangles.size() * (sizeof(TouchTriangle) + 3 * sizeof(std::uint32_t)) +
         place_of_.capacity() * sizeof(std::uint32_t);
}

template class TouchTable<float>;
template class TouchTable<double>;
template class BodyContact<float>;
template class BodyContact<double>;

}  // namespace aspic::reference

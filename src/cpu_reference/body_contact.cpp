#include "cpu_reference/body_contact.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <type_traits>

#include "model/model.h"

namespace aspic::reference {
namespace {

constexpr std::uint32_t nowhere = 0xffffffffu;

template <class T>
TouchConstants<T> rounded_pair(const TouchPair& exact, double ahead_step) {
  const TouchPair pair = ahead_step > 0.0 ? seen_ahead(exact, ahead_step) : exact;
  return {static_cast<T>(pair.stiffness), static_cast<T>(pair.damping),       static_cast<T>(pair.spacing),
          static_cast<T>(pair.reach),     static_cast<T>(pair.sight),         static_cast<T>(pair.depth),
          static_cast<T>(pair.margin),    static_cast<T>(2e-6 * pair.spacing)};
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
      friction_(static_cast<T>(model.contact.body_friction)),
      timestep_(model.simulation.timestep),
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
  for (std::size_t n = 0; n < pieces_of(used_.size()); ++n) prepare_faces(n, start);
  prepare_normals();
  prepared_ = start.x[0];
  find_candidates(start);
  return !encounters_.empty();
}

/// Which triangles and normals the lists of what is near ask for.
template <class T>
void BodyContact<T>::list_used() {
  used_.clear();
  used_points_.clear();
  hints_.assign(near_.encounters().size(), nowhere);
  for (const Encounter& near : near_.encounters()) {
    const auto triangles = near_.triangles(near);
    used_.insert(used_.end(), triangles.begin(), triangles.end());
    for (const std::uint32_t own : surfaces_.points[near.point].own) used_points_.push_back(own);
  }
  const auto sort = [](std::vector<std::uint32_t>& list) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  sort(used_points_);
  for (const std::uint32_t point : used_points_) {
    const auto at = surfaces_.triangles_at(point);
    used_.insert(used_.end(), at.begin(), at.end());
  }
  sort(used_);
  slot_.resize(surfaces_.triangles.size());
  for (std::uint32_t n = 0; n < used_.size(); ++n) slot_[used_[n]] = n;
  faces_.resize(used_.size());
  normals_.resize(surfaces_.points.size());
}

template <class T>
void BodyContact<T>::prepare_faces(std::size_t piece, const Particles& at) {
  const std::size_t end = std::min(used_.size(), (piece + 1) * piece_size);
  for (std::size_t n = piece * piece_size; n < end; ++n) {
    const auto& corner = surfaces_.triangles[used_[n]].corner;
    faces_[n] = face_of<T>(at.position(corner[0]), at.position(corner[1]), at.position(corner[2]));
  }
}

/// Normals of particles: Σ g of the triangles at each, of which only the sign of products matters.
template <class T>
void BodyContact<T>::prepare_normals() {
  for (const std::uint32_t point : used_points_) {
    const auto triangles = surfaces_.triangles_at(point);
    Vector<T> sum = face(triangles.front()).g;
    for (const std::uint32_t t : triangles.subspan(1)) sum = sum + face(t).g;
    normals_[point] = sum;
  }
}

/// Of the triangles near a point those whose boxes hold it at the start of the step, where the faces are.
template <class T>
void BodyContact<T>::find_candidates(const Particles& start) {
  encounters_.clear();
  candidates_.clear();
  near_index_.clear();
  for (std::uint32_t n = 0; n < near_.encounters().size(); ++n) {
    const Encounter& near = near_.encounters()[n];
    const Vector<T> P = place<T>(surfaces_.points[near.point], start);
    const T margin = table_.at(body_of(near.point), near.body).margin;
    const auto first = static_cast<std::uint32_t>(candidates_.size());
    for (const std::uint32_t t : near_.triangles(near))
      if (box_holds<T>(face(t), margin, P)) candidates_.push_back(t);
    const auto count = static_cast<std::uint32_t>(candidates_.size()) - first;
    if (count == 0) continue;
    encounters_.push_back({near.point, near.body, first, count});
    near_index_.push_back(n);
  }
}

template <class T>
void BodyContact<T>::find_in(std::size_t piece, const Particles& at) {
  pieces_[piece].touches.clear();
  const std::size_t end = std::min(encounters_.size(), (piece + 1) * piece_size);
  for (std::size_t n = piece * piece_size; n < end; ++n)
    touch(encounters_[n], hints_[near_index_[n]], at, pieces_[piece]);
}

template <class T>
bool BodyContact<T>::gather() {
  touches_.clear();
  for (std::size_t n = 0; n < pieces_of(encounters_.size()); ++n)
    touches_.insert(touches_.end(), pieces_[n].touches.begin(), pieces_[n].touches.end());
  name_particles();
  return !touches_.empty();
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

/// Whether a triangle counts for a point whose normal is N: between closed surfaces, if it turns to it.
template <class T>
bool BodyContact<T>::counts(const Face<T>& face, bool opposing, const Vector<T>& N) const {
  return face.real && (!opposing || dot3<T>(N, face.g) < T(0));
}

/// Fills in `sights`: what the point sees of its candidates. What is farther than `far` [m] touches nothing,
/// nor does what is farther than the nearest and than ρ, which both are known to be within what the triangle
/// of the last look, `hint`, says; a hundredth of a spacing is left for what ties.
template <class T>
void BodyContact<T>::look(const Encounter& encounter, const TouchConstants<T>& pair, std::uint32_t hint,
                          bool opposing, const Vector<T>& P, std::vector<Sight<T>>& sights) const {
  const auto candidates = this->candidates(encounter);
  const TouchPoint& point = surfaces_.points[encounter.point];
  const Vector<T> N = opposing ? over_own<T>(point, [&](std::uint32_t own) { return normals_[own]; })
                               : Vector<T>(Vector<T>::Zero());
  const auto see = [&](std::uint32_t t) { return sight_of<T>(t, surfaces_.triangles[t].side, face(t), P); };
  T far = std::max(pair.sight, pair.depth);
  if (std::ranges::binary_search(candidates, hint) && counts(face(hint), opposing, N))
    far = std::min(far, std::max(pair.sight, see(hint).L));
  far += T(0.01) * pair.s;
  sights.clear();
  for (const std::uint32_t t : candidates)
    if (!beyond<T>(face(t), far, P) && counts(face(t), opposing, N)) sights.push_back(see(t));
}

/// The contacts of a point with a body: the first, then second sides.
template <class T>
void BodyContact<T>::touch(const Encounter& encounter, std::uint32_t& hint, const Particles& at,
                           Piece& piece) const {
  const std::uint32_t own = body_of(encounter.point);
  const TouchConstants<T>& pair = table_.at(own, encounter.body);
  const bool closed = surfaces_.bodies[encounter.body].closed;
  look(encounter, pair, hint, closed && surfaces_.bodies[own].closed,
       place<T>(surfaces_.points[encounter.point], at), piece.sights);
  const Sight<T>* const first = nearest_of<T>(piece.sights, pair.tie, [](const Sight<T>&) { return true; });
  if (!first) return;
  hint = first->triangle;
  const auto gap = closed ? closed_gap<T>(*first, pair.sight, pair.depth) : open_gap<T>(*first, pair.sight);
  if (gap) piece.touches.push_back(contact(encounter, *first, *gap, at));
  if (!closed) return;
  const auto next_side = [&](std::uint32_t least) {
    std::uint32_t side = nowhere;
    for (const Sight<T>& seen : piece.sights)
      if (seen.side >= least && seen.side != first->side) side = std::min(side, seen.side);
    return side;
  };
  for (std::uint32_t side = next_side(0); side != nowhere; side = next_side(side + 1)) {
    const Sight<T>& seen =
        *nearest_of<T>(piece.sights, pair.tie, [&](const Sight<T>& each) { return each.side == side; });
    if (straight_in_front<T>(seen, pair.sight))
      piece.touches.push_back(contact(encounter, seen, *closed_gap<T>(seen, pair.sight, pair.depth), at));
  }
}

template <class T>
Touch<T> BodyContact<T>::contact(const Encounter& encounter, const Sight<T>& seen, const TouchGap<T>& gap,
                                 const Particles& at) const {
  const TouchPoint& point = surfaces_.points[encounter.point];
  const auto& corner = surfaces_.triangles[seen.triangle].corner;
  const TouchConstants<T>& pair = table_.at(body_of(encounter.point), encounter.body);
  const auto& [b, c, face] = seen.at;
  Touch<T> made;
  made.point = encounter.point;
  made.triangle = seen.triangle;
  made.carriers = point.single() ? 1 : 2;
  made.particle = {point.carrier[0], point.carrier[1], corner[0], corner[1], corner[2]};
  made.place = made.particle;  // until they are named
  made.weight = {static_cast<T>(point.weight[0]), static_cast<T>(point.weight[1]), (T(1) - b) - c, b, c};
  made.n = gap.n;
  made.d = gap.d;
  made.reach = reach_of(encounter, pair);
  made.k = pair.k;
  made.c = pair.c;
  const auto v = [&](std::uint32_t p) { return at.velocity(p); };
  const T u = dot3<T>(made.n, over_carriers<T>(made, v) - over_corners<T>(made, v));
  made.rest = made.k * (made.reach - made.d);
  if (at_end_) made.rest = made.rest + made.c * u;
  made.push = push_of<T>(made, u);
  return made;
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
    touch.rub =
        friction_of<T>(touch, W, over_carriers<T>(touch, v1), over_corners<T>(touch, v1), friction_, h_);
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

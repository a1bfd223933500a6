#include "cpu_reference/body_contact.h"

#include <numeric>

#include "model/model.h"

namespace aspic::reference {

template <class T>
BodyContact<T>::BodyContact(const Model& model, double ahead_step) : BodyContact(model, ahead_step, false) {
  overlaps_ = {model, surfaces_, BodyContact<double>(model, 0.0, true)};
}

template <class T>
BodyContact<T>::BodyContact(const Model& model, double ahead_step, bool initial)
    : ContactForces<T>(model.simulation.timestep),
      model_(model),
      surfaces_(contact_surfaces(model)),
      table_(model.contact, surfaces_.bodies, ahead_step),
      initial_(initial) {
  this->friction_ = table_.has_friction();
  this->particles_.resize(model.particle_count());
  std::iota(this->particles_.begin(), this->particles_.end(), 0u);
}

template <class T>
bool BodyContact<T>::begin_step(std::uint64_t step, const Particles& start) {
  const double time = static_cast<double>(step) * model_.simulation.timestep;
  overlaps_.begin_step(surfaces_, table_, static_cast<T>(time));
  groups_.clear();
  candidates_.clear();
  const auto take = [&](std::uint32_t point, std::uint32_t body, std::uint32_t triangle) {
    if (groups_.empty() || groups_.back().point != point || groups_.back().body != body)
      groups_.push_back({point, body, static_cast<std::uint32_t>(candidates_.size()), 0});
    ++groups_.back().count;
    candidates_.push_back(triangle);
  };
  for_each_candidate<T>(model_, surfaces_, table_, start, take);
  return !groups_.empty();
}

template <class T>
Face<T> BodyContact<T>::face_at(std::uint32_t triangle, const Particles& at) const {
  const auto& corner = surfaces_.triangles[triangle].corner;
  return face_of<T>(at.position(corner[0]), at.position(corner[1]), at.position(corner[2]));
}

/// N_P: the sum of the area normals around each carrier, weighted.
template <class T>
Vector<T> BodyContact<T>::normal_of(const SurfacePoint& point, const Particles& at) const {
  const auto around = [&](std::uint32_t own) {
    const auto triangles = surfaces_.triangles_at(own);
    Vector<T> sum = face_at(triangles.front(), at).g;
    for (const std::uint32_t t : triangles.subspan(1)) sum = sum + face_at(t, at).g;
    return sum;
  };
  if (point.single()) return around(point.own[0]);
  return static_cast<T>(point.weight[0]) * around(point.own[0]) +
         static_cast<T>(point.weight[1]) * around(point.own[1]);
}

template <class T>
bool BodyContact<T>::find(const Particles& at) {
  this->contacts_.clear();
  std::vector<ClosestPoint<T>> closest;
  for (const Group& group : groups_) {
    const SurfacePoint& point = surfaces_.points[group.point];
    const PairConstants<T>& pair = table_.at(surfaces_.body_of_point(group.point), group.body);
    const Vector<T> P = position_of<T>(point, at);
    const Vector<T> N = pair.opposing ? normal_of(point, at) : Vector<T>(Vector<T>::Zero());
    closest.clear();
    for (std::uint32_t n = group.first; n < group.first + group.count; ++n) {
      const std::uint32_t t = candidates_[n];
      const Face<T> face = face_at(t, at);
      if (counts<T>(face, pair, N))
        closest.push_back(closest_point<T>(t, surfaces_.triangles[t].side, face, P));
    }
    const T depth = initial_ ? pair.eased : overlaps_.depth(group.point, group.body, pair);
    select_contacts<T>(closest, pair, depth, [&](const ClosestPoint<T>& seen, const ContactGap<T>& gap) {
      add(group, seen, gap, at);
    });
  }
  return !this->contacts_.empty();
}

template <class T>
void BodyContact<T>::add(const Group& group, const ClosestPoint<T>& seen, const ContactGap<T>& gap,
                         const Particles& at) {
  const SurfacePoint& point = surfaces_.points[group.point];
  const auto& corner = surfaces_.triangles[seen.triangle].corner;
  const PairConstants<T>& pair = table_.at(surfaces_.body_of_point(group.point), group.body);
  const T b = seen.at.b, c = seen.at.c;
  ContactPoint<T>& made = this->contacts_.emplace_back();
  made.point = group.point;
  made.triangle = seen.triangle;
  made.carriers = point.single() ? 1 : 2;
  made.place = {point.carrier[0], point.carrier[1], corner[0], corner[1], corner[2]};
  made.weight = {static_cast<T>(point.weight[0]), static_cast<T>(point.weight[1]), (T(1) - b) - c, b, c};
  made.k = pair.k;
  made.c = pair.c;
  made.mu = pair.mu;
  made.n = gap.n;
  made.d = gap.d;
  made.reach = overlaps_.reach(group.point, group.body, pair);
  const auto v = [&](std::uint32_t particle) { return at.velocity(particle); };
  set_normal_force<T>(made, dot3<T>(made.n, over_carriers<T>(made, v) - over_corners<T>(made, v)), at_end_);
}

template class BodyContact<float>;
template class BodyContact<double>;

}  // namespace aspic::reference

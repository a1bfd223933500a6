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

/// Slack of the candidate lists [spacings]: larger ones take longer to make and hold longer.
constexpr double list_slack = 0.5;
/// Displacement for which cache entries are made [spacings]; triangles outside the lists stay irrelevant.
constexpr float cache_reach = 0.3f;
/// Least displacement for which a point counts as separated [spacings].
constexpr float least_separation = 0.04f;

/// P, or N_P, from the values at the carriers.
template <class T, class Value>
Vector<T> over_own(const SurfacePoint& point, const Value& value) {
  if (point.single()) return value(point.own[0]);
  return static_cast<T>(point.weight[0]) * value(point.own[0]) +
         static_cast<T>(point.weight[1]) * value(point.own[1]);
}

/// Displacement relative to each corner of a triangle, up to `most`, before which a point cannot touch it
/// from either side [m]; may be negative.
template <class T>
T free_displacement(const ClosestPoint<T>& seen, const Face<T>& face, const PairConstants<T>& pair, T most) {
  const T first = std::min(most, seen.L - pair.range), off = seen.L - pair.eased;
  if (!pair.closed || first <= off) return first;
  // What remains is contact from inside, which needs −z ≥ 0.7 L. A displacement of the corners moves the
  // plane at the point's projection by up to κ times as much, κ being the sum of the absolute barycentric
  // coordinates there, and turns N.
  const T ab = norm3<T>(face.B - face.A), ac = norm3<T>(face.C - face.A), bc = norm3<T>(face.C - face.B);
  const T area = norm3<T>(face.g), longest = (ab + ac + bc) - std::min({ab, ac, bc});
  const T aside = std::sqrt(std::max(seen.L * seen.L - seen.z * seen.z, T(0)));
  const T kappa = T(1) + T(2.01) * aside * longest / area;
  for (T displacement = first; displacement > T(0.02) * pair.s; displacement *= T(0.8)) {
    const T turn = T(4) * displacement * (ab + ac + T(2) * displacement) / area;
    if (seen.z + T(0.7) * seen.L >
        std::abs(seen.z) * std::min(T(0.5) * turn * turn, T(2)) + displacement * (kappa + T(0.7)))
      return std::max(displacement, off);
  }
  return off;
}

}  // namespace

template <class T>
ContactSearch<T>::ContactSearch(const Model& model, double ahead_step)
    : ContactSearch(model, ahead_step, false) {
  overlaps_ = {model, surfaces_, ContactSearch<double>(model, 0.0, true)};
}

template <class T>
ContactSearch<T>::ContactSearch(const Model& model, double ahead_step, bool initial)
    : ContactForces<T>(model.simulation.timestep),
      surfaces_(contact_surfaces(model)),
      table_(model.contact, surfaces_.bodies, ahead_step),
      lists_(model, surfaces_, list_slack, true),
      timestep_(model.simulation.timestep),
      initial_(initial),
      displacements_(surfaces_),
      normals_(surfaces_),
      cache_(surfaces_),
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
bool ContactSearch<T>::begin_with_displacements(std::uint64_t step, const Particles& start) {
  if (!displacements_.hold(lists_)) {
    // If limits are exceeded by little, no triangle outside the lists has come within the reach of entries.
    if (!displacements_.hold(lists_, 0.2 * lists_.slack()))
      for (std::size_t n = 0; n < own_.size(); ++n) cache_.begin(n, -1.0);
    for (const auto& [particle, point] : surface_) {
      const Vector<T> x = start.position(particle);
      places_[point] = {x.x(), x.y(), x.z()};
    }
    lists_.make(places_);
    displacements_.begin(start);
    take_lists(start);
  }
  laid_out_ = true;
  start_ = start;
  overlaps_.begin_step(surfaces_, table_, static_cast<T>(static_cast<double>(step) * timestep_));
  return !lists_.candidate_groups().empty();
}

/// Takes the candidate groups of new lists.
template <class T>
void ContactSearch<T>::take_lists(const Particles& at) {
  involve(lists_.pair_points());
  pair_points_.clear();
  for (const std::uint32_t p : involved_.added()) pair_points_.push_back({surfaces_.points[p].carrier[0], p});
  lay_out(at, one_by_one);
  own_.clear();
  inputs_.clear();
  std::uint32_t own = 0;  // ascending
  for (const CandidateGroup& near : lists_.candidate_groups()) {
    const SurfacePoint& point = surfaces_.points[near.point];
    while (own + 1 < surfaces_.bodies.size() && surfaces_.bodies[own + 1].first_point <= near.point) ++own;
    own_.push_back(own);
    inputs_.push_back(
        {point.own, {weight_[0][near.point], weight_[1][near.point]}, table_.of(own_.back(), near.body)});
  }
  cache_.reset(lists_, own_, x_);
  involve(cache_.tracked());
  particles_.clear();
  for (const std::uint32_t p : involved_.added()) {
    place_of_[p] = static_cast<std::uint32_t>(particles_.size());
    particles_.push_back(surfaces_.points[p].carrier[0]);
  }
  normals_.clear();
  for (std::size_t n = 0; n < own_.size(); ++n) request_normals(n);
  normals_.sort();
}

/// Sets the points that contacts may refer to.
template <class T>
void ContactSearch<T>::involve(std::span<const std::uint32_t> points) {
  involved_.clear();
  for (const std::uint32_t p : points) involved_.add(p);
  involved_.sort();
}

/// Requests the normals that the cached query of a group needs.
template <class T>
void ContactSearch<T>::request_normals(std::size_t candidate_group) {
  if (cache_[candidate_group].count > 0 && !cache_[candidate_group].separated)
    normals_.request(surfaces_.points[lists_.candidate_groups()[candidate_group].point]);
}

/// The definition of candidates (physics/contact/candidates.h).
template <class T>
bool ContactSearch<T>::is_candidate(const CandidateGroup& near, const PairConstants<T>& pair,
                                    std::uint32_t triangle) const {
  return box_of<T>(surfaces_.triangles[triangle], *start_)
      .holds(pair.margin, position_of<T>(surfaces_.points[near.point], *start_));
}

template <class T>
void ContactSearch<T>::run_task(std::size_t number) {
  Task& task = tasks_[number];
  const bool in_order = done_in_order_.load(std::memory_order_acquire) == number;
  task.out = in_order ? &contacts_ : &task.contacts;
  task.contacts.clear();
  task.cached.clear();
  const std::size_t first = number * groups_per_task,
                    end = std::min(lists_.candidate_groups().size(), first + groups_per_task);
  ContactBatch<T> batch;
  if (batch_kernel_ != nullptr && !overlaps_.active() && !initial_) {
    collect(first, end, batch);
    if (batch.count > 0) batch_kernel_(tables(), batch);
  }
  std::size_t asked = 0;
  for (std::size_t n = first; n < end; ++n) {
    const bool side_by_side =
        asked < batch.count && static_cast<std::size_t>(batch.candidate_group[asked]) == n;
    const std::size_t place = side_by_side ? asked++ : 0;
    if (side_by_side && batch.answer[place] != batch.undecided) {
      if (batch.answer[place] == batch.contacts) add(n, batch, place, task);
    } else if (cache_.may_contact(n)) {
      const Query p = query_of(n);
      if (stays_separated(p)) continue;
      if (!query_cached(p, task.closest)) query_all(p, task);
      contact(p, task);
    }
  }
  if (in_order) done_in_order_.store(number + 1, std::memory_order_release);
}

/// Collects the groups of a range whose cache entries are valid and hold triangles.
template <class T>
void ContactSearch<T>::collect(std::size_t first, std::size_t end, ContactBatch<T>& batch) const {
  for (std::size_t n = first; n < end; ++n) {
    if (!cache_.holds(n) || !cache_.may_contact(n)) continue;
    const std::uint32_t cached = cache_[n].count;
    const std::size_t place = batch.count++;
    batch.candidate_group[place] = static_cast<std::int32_t>(n);
    batch.pair[place] = static_cast<std::int32_t>(inputs_[n].pair);
    for (std::size_t each = 0; each < 2; ++each) {
      batch.own[each][place] = static_cast<std::int32_t>(inputs_[n].own[each]);
      batch.weight[each][place] = inputs_[n].weight[each];
    }
    batch.cached[place] = static_cast<std::int32_t>(cached);
    batch.limit[place] = static_cast<T>(cache_.limit(n)) - static_cast<T>(lists_.rounding());
  }
  if (batch.count == 0) return;
  // Fills the lanes behind the last query.
  const auto repeat = [&](auto& lane) {
    std::fill_n(lane.begin() + static_cast<std::ptrdiff_t>(batch.count), batch_behind, lane[batch.count - 1]);
  };
  repeat(batch.candidate_group);
  repeat(batch.pair);
  for (std::size_t each = 0; each < 2; ++each) {
    repeat(batch.own[each]);
    repeat(batch.weight[each]);
  }
  repeat(batch.cached);
  repeat(batch.limit);
}

template <class T>
ContactTables<T> ContactSearch<T>::tables() const {
  const auto& entries = cache_.entries();
  static_assert(sizeof(entries[0]) % sizeof(entries[0].triangle[0]) == 0);
  return {x_.data(),
          v_.data(),
          normals_.rows(),
          surfaces_.faces.data(),
          entries[0].triangle.data(),
          sizeof(entries[0]) / sizeof(entries[0].triangle[0]),
          table_.pairs().data(),
          static_cast<T>(lists_.rounding()),
          at_end_};
}

template <class T>
typename ContactSearch<T>::Query ContactSearch<T>::query_of(std::size_t n) const {
  const CandidateGroup& near = lists_.candidate_groups()[n];
  const auto place = [&](std::uint32_t own) { return vector_of(x_[own]); };
  return {n, near, table_[inputs_[n].pair], over_own<T>(surfaces_.points[near.point], place)};
}

/// N_P, or zero where it is not needed.
template <class T>
Vector<T> ContactSearch<T>::normal_of(const Query& p) const {
  if (!p.pair.opposing) return Vector<T>::Zero();
  return over_own<T>(surfaces_.points[p.near.point], [&](std::uint32_t own) { return normals_.at(own, x_); });
}

template <class T>
void ContactSearch<T>::gather() {
  const std::size_t tasks = tasks_of(lists_.candidate_groups().size());
  for (std::size_t n = done_in_order_; n < tasks; ++n)
    contacts_.insert(contacts_.end(), tasks_[n].contacts.begin(), tasks_[n].contacts.end());
  for (std::size_t n = 0; n < tasks; ++n)
    for (const std::size_t cached : tasks_[n].cached) request_normals(cached);
}

/// Upper bound of the rounding error of a distance [m].
template <class T>
T ContactSearch<T>::rounding(const PairConstants<T>& pair) const {
  return T(0.002) * pair.s + static_cast<T>(lists_.rounding());
}

/// Distance beyond which triangles do not matter to a point whose nearest is `least` away [m].
template <class T>
T ContactSearch<T>::relevant_distance(std::optional<T> least, const PairConstants<T>& pair) const {
  const T in_contact = std::max(pair.range, pair.eased) + pair.tie;
  return (least && *least <= in_contact ? std::max(*least, pair.range) + pair.tie : in_contact) +
         rounding(pair);
}

/// Whether a separated point stays so, by the triangles that it can touch first. Extends the entry.
template <class T>
bool ContactSearch<T>::stays_separated(const Query& p) {
  const auto& entry = cache_[p.n];
  if (!entry.separated) return false;
  const T displacement = cache_reach * p.pair.s, rounding = this->rounding(p.pair);
  double separated = cache_.limit(p.n);
  for (std::size_t n = 0; n < entry.count; ++n) {
    const Face<T> face = faces()[entry.triangle[n]];
    if (!face.real) return false;
    const ClosestPoint<T> seen = closest_point<T>(entry.triangle[n], 0, face, p.P);
    separated = std::min(
        separated,
        static_cast<double>(free_displacement<T>(seen, face, p.pair, displacement + rounding) - rounding));
  }
  if (!(separated >= static_cast<double>(least_separation * p.pair.s))) return false;
  cache_.extend(p.n, separated);
  return true;
}

/// Fills in `closest` from the cache entry. Returns false if the entry does not suffice.
template <class T>
bool ContactSearch<T>::query_cached(const Query& p, std::vector<ClosestPoint<T>>& closest) const {
  closest.clear();
  if (!cache_.holds(p.n)) return false;
  const auto& entry = cache_[p.n];
  const Vector<T> N = normal_of(p);
  std::optional<T> least;
  for (std::size_t n = 0; n < entry.count; ++n) {
    const std::uint32_t t = entry.triangle[n];
    const Face<T> face = faces()[t];
    if (!counts<T>(face, p.pair, N)) continue;
    closest.push_back(closest_point<T>(t, surfaces_.triangles[t].side, face, p.P));
    if (!least || closest.back().L < *least) least = closest.back().L;
  }
  const T matters = relevant_distance(least, p.pair);
  std::erase_if(closest, [&](const ClosestPoint<T>& seen) { return !(seen.L <= matters); });
  return cache_.limit(p.n) > static_cast<double>(matters);
}

/// Fills in `closest` from all candidates and makes a new cache entry: of the triangles that can matter
/// within a displacement, or, for a point that is separated until then, of those that it can touch first.
template <class T>
void ContactSearch<T>::query_all(const Query& p, Task& task) {
  const T displacement = cache_reach * p.pair.s, rounding = this->rounding(p.pair);
  const T far = relevant_distance(std::nullopt, p.pair) + displacement;
  std::vector<ClosestPoint<T>>&closest = task.closest, &around = task.around;
  closest.clear();
  around.clear();
  task.by_distance.clear();
  // Within this displacement every triangle of the entry is a candidate.
  auto& entry = cache_.begin(p.n, static_cast<double>(displacement));
  bool lasts = true;
  ClosestPointBatch<T> batch;
  batch.P = p.P;
  for (auto all = lists_.triangles(p.near); !all.empty(); all = all.subspan(batch.count)) {
    batch.count = std::min(all.size(), batch_room);
    for (std::size_t n = 0; n < batch.count; ++n) batch.triangle[n] = static_cast<std::int32_t>(all[n]);
    kernel_(faces(), batch);
    for (std::size_t n = 0; n < batch.count; ++n) {
      if (!batch.real[n]) lasts = false;  // it may gain an area
      if (!batch.real[n] || !(batch.L[n] <= far)) continue;
      task.by_distance.push_back({batch.L[n], static_cast<std::uint32_t>(around.size())});
      around.push_back(batch.point(n, surfaces_.triangles[all[n]].side));
    }
  }
  std::ranges::sort(task.by_distance);
  task.cached.push_back(p.n);
  // Most points are separated.
  task.by_displacement.clear();
  T separated = displacement;
  for (std::size_t n = 0; n < around.size() && separated >= least_separation * p.pair.s; ++n) {
    const ClosestPoint<T>& seen = around[task.by_distance[n].second];
    const T free =
        free_displacement<T>(seen, faces()[seen.triangle], p.pair, displacement + rounding) - rounding;
    separated = std::min(separated, free);
    if (free < displacement) task.by_displacement.push_back({free, task.by_distance[n].second});
  }
  if (separated >= least_separation * p.pair.s) {
    entry.separated = lasts;
    entry.valid_until = lasts ? static_cast<double>(separated) - cache_.displacement(p.n) : -1.0;
    std::ranges::sort(task.by_displacement);
    entry.clearance =
        cache_first(p, task.by_displacement, displacement, displacement, around) - cache_.displacement(p.n);
    return;
  }
  const Vector<T> N = normal_of(p);
  for (const ClosestPoint<T>& seen : around)
    if (counts<T>(faces()[seen.triangle], p.pair, N) && is_candidate(p.near, p.pair, seen.triangle))
      closest.push_back(seen);
  const ClosestPoint<T>* const first =
      nearest_of<T>(closest, p.pair.tie, [](const ClosestPoint<T>&) { return true; });
  const T most = relevant_distance(first ? std::optional(first->L) : std::nullopt, p.pair) + displacement;
  entry.clearance = cache_first(p, task.by_distance, most, far, around) - cache_.displacement(p.n);
  for (std::size_t n = 0; n < entry.count; ++n)
    if (!is_candidate(p.near, p.pair, entry.triangle[n])) lasts = false;  // it became one within this step
  if (!lasts) entry.valid_until = -1.0;
  std::sort(entry.triangle.begin(), entry.triangle.begin() + entry.count);
}

/// Caches the first triangles by distance, up to `most`. Returns the distance of the next one, or `beyond` if
/// there is none [m].
template <class T>
double ContactSearch<T>::cache_first(const Query& p, const Order& order, T most, T beyond,
                                     const std::vector<ClosestPoint<T>>& around) {
  auto& entry = cache_.entry(p.n);
  for (const auto& [distance, n] : order) {
    if (distance > most || entry.count == most_cached) return static_cast<double>(distance);
    entry.triangle[entry.count++] = around[n].triangle;
  }
  return static_cast<double>(beyond);
}

template <class T>
void ContactSearch<T>::contact(const Query& p, Task& task) const {
  const T depth = initial_ ? p.pair.eased : overlaps_.depth(p.near.point, p.near.body, p.pair);
  select_contacts<T>(task.closest, p.pair, depth,
                     [&](const ClosestPoint<T>& seen, const ContactGap<T>& gap) { add(p, seen, gap, task); });
}

template <class T>
void ContactSearch<T>::add(const Query& p, const ClosestPoint<T>& seen, const ContactGap<T>& gap,
                           Task& task) const {
  ContactPoint<T>& made = begin_contact(p.n, seen.triangle, seen.at.b, seen.at.c, task);
  made.n = gap.n;
  made.d = gap.d;
  made.reach = overlaps_.reach(p.near.point, p.near.body, p.pair);
  const auto v = [&](std::uint32_t place) { return vector_of(v_[involved_.added()[place]]); };
  set_normal_force<T>(made, dot3<T>(made.n, over_carriers<T>(made, v) - over_corners<T>(made, v)), at_end_);
}

/// Adds a contact found in vector lanes.
template <class T>
void ContactSearch<T>::add(std::size_t candidate_group, const ContactBatch<T>& batch, std::size_t place,
                           Task& task) const {
  ContactPoint<T>& made = begin_contact(candidate_group, static_cast<std::uint32_t>(batch.triangle[place]),
                                        batch.b[place], batch.c[place], task);
  made.n = {batch.n[0][place], batch.n[1][place], batch.n[2][place]};
  made.d = batch.d[place];
  made.reach = table_[inputs_[candidate_group].pair].reach;
  made.static_force = batch.static_force[place];
  made.normal_force = batch.normal_force[place];
}

template <class T>
ContactPoint<T>& ContactSearch<T>::begin_contact(std::size_t candidate_group, std::uint32_t triangle, T b,
                                                 T c, Task& task) const {
  const QueryInput& asked = inputs_[candidate_group];
  const auto& face = surfaces_.faces[triangle];
  const PairConstants<T>& pair = table_[asked.pair];
  ContactPoint<T>& made = task.out->emplace_back();
  made.point = lists_.candidate_groups()[candidate_group].point;
  made.triangle = triangle;
  made.carriers = asked.own[0] == asked.own[1] ? 1 : 2;
  made.place = {place_of_[asked.own[0]], place_of_[asked.own[1]], place_of_[face[0]], place_of_[face[1]],
                place_of_[face[2]]};
  assert(is_involved(asked.own[0]) && is_involved(asked.own[1]) &&
         std::ranges::all_of(std::span(face).first(3), [&](std::uint32_t p) { return is_involved(p); }));
  made.weight = {asked.weight[0], asked.weight[1], (T(1) - b) - c, b, c};
  made.k = pair.k;
  made.c = pair.c;
  made.mu = pair.mu;
  return made;
}

template <class T>
std::uint64_t ContactSearch<T>::bytes() const {
  const auto of = [](const auto&... entries) { return ((entries.capacity() * sizeof(entries[0])) + ...); };
  std::uint64_t all =
      sizeof(*this) + lists_.bytes() + normals_.bytes() + cache_.bytes() + displacements_.bytes() +
      involved_.bytes() + surfaces_.points.size() * sizeof(SurfacePoint) +
      surfaces_.triangles.size() *
          (sizeof(SurfaceTriangle) + sizeof(surfaces_.faces[0]) + 3 * sizeof(std::uint32_t)) +
      of(overlaps_.all(), weight_[0], weight_[1], x_, v_, own_, inputs_, surface_, pair_points_, places_,
         tasks_, contacts_, particles_, place_of_, this->share_, this->v1_);
  for (const Task& p : tasks_)
    all += of(p.closest, p.around, p.by_distance, p.by_displacement, p.contacts, p.cached);
  return all;
}

template class ContactSearch<float>;
template class ContactSearch<double>;

}  // namespace aspic::collision

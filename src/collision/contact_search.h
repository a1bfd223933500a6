#pragma once
// The search for contacts between bodies, and of a body with itself, in the force evaluations of a step
// (docs/contact.md). It gives the bits of reference::BodyContact. The cpu backend runs it on its own arrays.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "collision/candidate_cache.h"
#include "collision/candidate_lists.h"
#include "collision/closest_points.h"
#include "collision/contact_batch.h"
#include "collision/displacement_bounds.h"
#include "collision/number_set.h"
#include "collision/pieces.h"
#include "collision/vertex_normals.h"
#include "model/contact_surface.h"
#include "physics/contact/candidates.h"
#include "physics/contact/forces.h"
#include "physics/contact/geometry.h"
#include "physics/contact/overlap.h"
#include "physics/contact/selection.h"
#include "physics/particle_view.h"

namespace aspic::collision {

template <class T>
class ContactSearch : public ContactForces<T> {
 public:
  using typename ContactForces<T>::Particles;

  /// Of a model whose has_body_contact(). Bodies that overlap in its initial state are eased apart.
  /// With an `ahead_step` h [s] normal forces are those at the end of a step (docs/contact.md, "Implicit
  /// Euler"): contacts are found from contact_range spacings on, and k·h replaces the damping.
  explicit ContactSearch(const Model& model, double ahead_step = 0.0);
  ContactSearch(const ContactSearch&) = delete;
  ContactSearch& operator=(const ContactSearch&) = delete;

  /// Begins the step from the state of this number; `start` must stay valid until it ends. Returns whether
  /// there may be contacts.
  bool begin_step(std::uint64_t step, const Particles& start) { return begin_step(step, start, one_by_one); }
  /// The same on many threads: run(count, task) calls task(n) for n below count, in any order.
  template <class Run>
  bool begin_step(std::uint64_t step, const Particles& start, const Run& run) {
    lay_out(start, run);
    displacements_.measure(lists_, start, x_, run);
    return begin_with_displacements(step, start);
  }

  /// The candidates of this step: calls take(point, triangle), ascending by point, body and triangle.
  template <class Take>
  void for_candidates(const Take& take) const {
    for (const CandidateGroup& near : lists_.candidate_groups())
      for (const std::uint32_t t : lists_.triangles(near))
        if (is_candidate(near, table_.at(surfaces_.body_of_point(near.point), near.body), t))
          take(near.point, t);
  }

  /// Finds the contacts of a force evaluation. Returns whether there are any.
  bool find(const Particles& at) { return find(at, one_by_one); }
  /// The same on many threads, as begin_step().
  template <class Run>
  bool find(const Particles& at, const Run& run) {
    if (!std::exchange(laid_out_, false) || at.x != start_->x || at.v != start_->v) lay_out(at, run);
    cache_.update(x_, run);
    normals_.make(x_, run);
    const std::size_t tasks = tasks_of(lists_.candidate_groups().size());
    tasks_.resize(std::max(tasks_.size(), tasks));
    contacts_.clear();
    done_in_order_ = 0;
    run(tasks, [&](std::size_t n) { run_task(n); });
    gather();
    return !contacts_.empty();
  }
  /// Sets kernels in vector lanes for closest points and for cached queries, with the bits of
  /// closest_points_one_by_one() and of queries one by one.
  using Kernel = void (*)(const FacesInSpace<T>&, ClosestPointBatch<T>&);
  void set_kernels(Kernel closest, ContactBatchKernel<T> contact) {
    kernel_ = closest;
    batch_kernel_ = contact;
  }
  /// With an ahead_step: whether find() sees the end of a step instead of its start.
  void set_at_end(bool on) { at_end_ = on; }
  /// As in ContactForces, on many threads.
  template <class InverseMass, class Run>
  void add_normal_forces(const Particles& start, const InverseMass& inverse_mass, std::vector<Vector<T>>& f,
                         const Run& run) {
    this->begin_friction(start, inverse_mass, f);
    if (this->friction_)
      run_pieces(contacts_.size(), task_size, run, [&](std::size_t n) { this->find_friction(contacts_[n]); });
  }
  using ContactForces<T>::add_normal_forces;
  template <class InverseMass, class Run>
  void add_forces(const Particles& start, const InverseMass& inverse_mass, std::vector<Vector<T>>& f,
                  const Run& run) {
    add_normal_forces(start, inverse_mass, f, run);
    this->add_friction(f);
  }
  using ContactForces<T>::add_forces;
  /// Largest distance of the boxes of two bodies in contact [m].
  double most_margin() const { return lists_.most_margin(); }

  const std::vector<InitialOverlap<T>>& initial_overlaps() const { return overlaps_.all(); }
  std::uint64_t bytes() const;

 private:
  using ContactForces<T>::contacts_;
  using ContactForces<T>::particles_;
  template <class U>
  friend class ContactSearch;
  ContactSearch(const Model& model, double ahead_step, bool initial);
  bool is_candidate(const CandidateGroup& near, const PairConstants<T>& pair, std::uint32_t triangle) const;
  /// The query of a candidate group in find().
  struct Query {
    std::size_t n;  // number of the group
    const CandidateGroup& near;
    const PairConstants<T>& pair;
    Vector<T> P;
  };
  using Order = std::vector<std::pair<T, std::uint32_t>>;  // numbers, by distance or displacement [m]
  /// The data of one task of find().
  struct Task {
    std::vector<ClosestPoint<T>> closest, around;
    Order by_distance, by_displacement;           // of `around`
    std::vector<ContactPoint<T>>* out = nullptr;  // contacts_, or
    std::vector<ContactPoint<T>> contacts;        // this one while earlier tasks are running
    std::vector<std::size_t> cached;              // groups with new cache entries
  };
  static constexpr std::size_t groups_per_task = batch_room;
  static std::size_t tasks_of(std::size_t count) { return (count + groups_per_task - 1) / groups_per_task; }
  /// Particles, or contacts, per task.
  static constexpr std::size_t task_size = 512;
  bool begin_with_displacements(std::uint64_t step, const Particles& start);
  void take_lists(const Particles& at);
  void involve(std::span<const std::uint32_t> points);
  /// Whether contacts may refer to this point while the lists hold.
  bool is_involved(std::uint32_t point) const {
    return place_of_[point] < involved_.added().size() && involved_.added()[place_of_[point]] == point;
  }
  void request_normals(std::size_t candidate_group);
  void run_task(std::size_t task);
  /// Gathers places and velocities of the points of body pairs.
  template <class Run>
  void lay_out(const Particles& at, const Run& run) {
    run_pieces(pair_points_.size(), task_size, run, [&](std::size_t n) {
      const auto& [particle, point] = pair_points_[n];
      x_[point] = row_of<T>(at.position(particle));
      v_[point] = row_of<T>(at.velocity(particle));
    });
  }
  void collect(std::size_t first, std::size_t end, ContactBatch<T>& batch) const;
  ContactTables<T> tables() const;
  void gather();
  FacesInSpace<T> faces() const { return {surfaces_.faces, x_}; }
  T rounding(const PairConstants<T>& pair) const;
  T relevant_distance(std::optional<T> least, const PairConstants<T>& pair) const;
  Query query_of(std::size_t candidate_group) const;
  Vector<T> normal_of(const Query& p) const;
  bool stays_separated(const Query& p);
  bool query_cached(const Query& p, std::vector<ClosestPoint<T>>& closest) const;
  void query_all(const Query& p, Task& task);
  double cache_first(const Query& p, const Order& order, T most, T beyond,
                     const std::vector<ClosestPoint<T>>& around);
  void contact(const Query& p, Task& task) const;
  void add(const Query& p, const ClosestPoint<T>& seen, const ContactGap<T>& gap, Task& task) const;
  void add(std::size_t candidate_group, const ContactBatch<T>& batch, std::size_t place, Task& task) const;
  ContactPoint<T>& begin_contact(std::size_t candidate_group, std::uint32_t triangle, T b, T c,
                                 Task& task) const;

  ContactSurfaces surfaces_;
  PairTable<T> table_;
  CandidateLists lists_;
  double timestep_;
  bool at_end_ = false;
  Kernel kernel_ = closest_points_one_by_one<T>;
  ContactBatchKernel<T> batch_kernel_ = nullptr;
  InitialOverlaps<T> overlaps_;
  bool initial_;  // finds the initial overlaps
  std::optional<Particles> start_;
  bool laid_out_ = false;  // x_ and v_ are those of the start
  DisplacementBounds<T> displacements_;
  VertexNormals<T> normals_;
  CandidateCache<T> cache_;
  std::vector<Row<T>> x_, v_;  // by point, of body pairs
  /// The constants of a group's query.
  struct QueryInput {
    std::array<std::uint32_t, 2> own;
    std::array<T, 2> weight;
    std::uint32_t pair;
  };
  std::vector<QueryInput> inputs_;        // by group
  std::array<std::vector<T>, 2> weight_;  // of carriers, by point
  std::vector<std::uint32_t> own_;        // by group: the point's body
  struct SurfaceParticle {
    std::uint32_t particle, point;
  };
  std::vector<SurfaceParticle> surface_;      // ascending by both
  std::vector<SurfaceParticle> pair_points_;  // of body pairs, ascending
  NumberSet involved_;                        // points that contacts may refer to, ascending
  std::vector<std::uint32_t> place_of_;       // index in particles_, by point
  std::vector<Vec3> places_;                  // by point
  std::vector<Task> tasks_;
  std::atomic<std::size_t> done_in_order_ = 0;  // earlier tasks have stored their contacts
};

// Compiled once, in contact_search.cpp.
extern template class ContactSearch<float>;
extern template class ContactSearch<double>;

}  // namespace aspic::collision

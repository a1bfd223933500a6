#pragma once
// Contact between bodies, and of a body with itself, in the force evaluations of a step (docs/contact.md).
// The particles may lie anywhere: the cpu backend runs this on its own arrays.
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

  /// Of a model whose has_body_contact(). Bodies that overlap in its initial state are eased apart. With an
  /// `ahead_step` h [s] pushes are those at the end of a step (docs/contact.md, "Implicit Euler"): contacts
  /// are found from contact_range spacings on, and k·h takes the place of the damper.
  explicit ContactSearch(const Model& model, double ahead_step = 0.0);
  ContactSearch(const ContactSearch&) = delete;
  ContactSearch& operator=(const ContactSearch&) = delete;

  /// A step from the state of this number begins here, where the particles stay until it ends. Returns
  /// whether anything may touch in it.
  bool begin_step(std::uint64_t step, const Particles& start) { return begin_step(step, start, one_by_one); }
  /// The same on many threads: run(count, task) calls task(n) for n below count, in any order.
  template <class Run>
  bool begin_step(std::uint64_t step, const Particles& start, const Run& run) {
    lay_out(start, run);
    ways_.measure(near_, start, x_, run);
    return begin_measured(step, start);
  }

  /// The candidates of this step: calls take(point, triangle), ascending by point, body and triangle.
  template <class Take>
  void for_candidates(const Take& take) const {
    for (const PointCandidates& near : near_.encounters())
      for (const std::uint32_t t : near_.triangles(near))
        if (is_candidate(near, table_.at(surfaces_.body_of_point(near.point), near.body), t))
          take(near.point, t);
  }

  /// Finds the contacts at a place of the step, for forces there and those below. Returns whether there is
  /// one.
  bool find(const Particles& at) { return find(at, one_by_one); }
  /// The same on many threads, as begin_step().
  template <class Run>
  bool find(const Particles& at, const Run& run) {
    if (!std::exchange(laid_out_, false) || at.x != start_->x || at.v != start_->v) lay_out(at, run);
    short_.follow(x_, run);
    normals_.make(x_, run);
    const std::size_t pieces = pieces_of(near_.encounters().size());
    pieces_.resize(std::max(pieces_.size(), pieces));
    contacts_.clear();
    in_turn_ = 0;
    run(pieces, [&](std::size_t n) { find_in(n); });
    gather();
    return !contacts_.empty();
  }
  /// How what is seen is computed, to the same bits as look_one_by_one(); and what points touch whose short
  /// lists hold, which without the second are looked at one by one.
  using Look = void (*)(const FacesInSpace<T>&, ClosestPointBatch<T>&);
  void set_side_by_side(Look look, ContactBatchKernel<T> contact) {
    look_ = look;
    side_by_side_ = contact;
  }
  /// With an ahead_step: whether find() looks where the step may end, not where it begins.
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
  /// Bodies whose boxes are farther apart than this do not touch [m].
  double most_margin() const { return near_.most_margin(); }

  const std::vector<InitialOverlap<T>>& initial_overlaps() const { return overlaps_.all(); }
  std::uint64_t bytes() const;

 private:
  using ContactForces<T>::contacts_;
  using ContactForces<T>::particles_;
  template <class U>
  friend class ContactSearch;
  ContactSearch(const Model& model, double ahead_step, bool initial);
  bool is_candidate(const PointCandidates& near, const PairConstants<T>& pair, std::uint32_t triangle) const;
  /// A point and a body, in the middle of a find().
  struct Looker {
    std::size_t n;  // of the encounter
    const PointCandidates& near;
    const PairConstants<T>& pair;
    Vector<T> P;
  };
  using Order = std::vector<std::pair<T, std::uint32_t>>;  // numbers, by something [m]
  /// What one task of find() works with.
  struct Piece {
    std::vector<ClosestPoint<T>> sights, around;
    Order by_distance, by_way;                    // those around
    std::vector<ContactPoint<T>>* out = nullptr;  // contacts go there:
    std::vector<ContactPoint<T>> contacts;        // until all before are with contacts_, here
    std::vector<std::size_t> listed;              // encounters whose short lists are new
  };
  static constexpr std::size_t piece_size = batch_room;
  static std::size_t pieces_of(std::size_t count) { return (count + piece_size - 1) / piece_size; }
  /// Particles, and contacts, of a task.
  static constexpr std::size_t task_size = 512;
  bool begin_measured(std::uint64_t step, const Particles& start);
  void list_used(const Particles& at);
  void name(std::span<const std::uint32_t> points);
  /// Whether contacts may name this point while the lists are those that there are.
  bool named(std::uint32_t point) const {
    return place_of_[point] < named_.added().size() && named_.added()[place_of_[point]] == point;
  }
  void want(std::size_t encounter);
  void find_in(std::size_t piece);
  /// Places and velocities of all that may touch, one after the other.
  template <class Run>
  void lay_out(const Particles& at, const Run& run) {
    run_pieces(met_.size(), task_size, run, [&](std::size_t n) {
      const auto& [particle, point] = met_[n];
      x_[point] = row_of<T>(at.position(particle));
      v_[point] = row_of<T>(at.velocity(particle));
    });
  }
  void ask(std::size_t first, std::size_t end, ContactBatch<T>& batch) const;
  ContactTables<T> tables() const;
  void gather();
  FacesInSpace<T> faces() const { return {surfaces_.faces, x_}; }
  T pad(const PairConstants<T>& pair) const;
  T enough(std::optional<T> least, const PairConstants<T>& pair) const;
  Looker looker(std::size_t encounter) const;
  Vector<T> normal_of(const Looker& p) const;
  bool stays_apart(const Looker& p);
  bool look_at_few(const Looker& p, std::vector<ClosestPoint<T>>& sights) const;
  void look_at_all(const Looker& p, Piece& piece);
  double list_first(const Looker& p, const Order& order, T most, T beyond,
                    const std::vector<ClosestPoint<T>>& around);
  void contact(const Looker& p, Piece& piece) const;
  void add(const Looker& p, const ClosestPoint<T>& seen, const ContactGap<T>& gap, Piece& piece) const;
  void add(std::size_t encounter, const ContactBatch<T>& batch, std::size_t place, Piece& piece) const;
  ContactPoint<T>& begin_contact(std::size_t encounter, std::uint32_t triangle, T b, T c, Piece& piece) const;

  ContactSurfaces surfaces_;
  PairTable<T> table_;
  CandidateLists near_;
  double timestep_;
  bool at_end_ = false;
  Look look_ = look_one_by_one<T>;
  ContactBatchKernel<T> side_by_side_ = nullptr;
  InitialOverlaps<T> overlaps_;
  bool initial_;  // finds these
  std::optional<Particles> start_;
  bool laid_out_ = false;  // they are laid out as they are at the start
  DisplacementBounds<T> ways_;
  VertexNormals<T> normals_;
  CandidateCache<T> short_;
  std::vector<Row<T>> x_, v_;  // by point, of those that meetings name
  /// Of an encounter, what a batch asks with.
  struct Asked {
    std::array<std::uint32_t, 2> own;
    std::array<T, 2> weight;
    std::uint32_t pair;
  };
  std::vector<Asked> asked_;              // by encounter
  std::array<std::vector<T>, 2> weight_;  // of carriers, by point
  std::vector<std::uint32_t> own_;        // by encounter: the point's body
  struct SurfaceParticle {
    std::uint32_t particle, point;
  };
  std::vector<SurfaceParticle> surface_;  // ascending by both
  std::vector<SurfaceParticle> met_;      // those that meetings name, ascending
  NumberSet named_;                       // points that contacts may name, ascending
  std::vector<std::uint32_t> place_of_;   // where it is among these, by point
  std::vector<Vec3> places_;              // by point
  std::vector<Piece> pieces_;
  std::atomic<std::size_t> in_turn_ = 0;  // all pieces before this one are with contacts_
};

// Compiled once, in body_contact.cpp.
extern template class ContactSearch<float>;
extern template class ContactSearch<double>;

}  // namespace aspic::collision

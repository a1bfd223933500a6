#pragma once
// Contact between bodies, and of a body with itself, in the force evaluations of a step (docs/contact.md).
// The particles may lie anywhere: the cpu backend runs this on its own arrays.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cpu_reference/ball_particles.h"
#include "cpu_reference/near_triangles.h"
#include "cpu_reference/touch_geometry.h"
#include "cpu_reference/touch_normals.h"
#include "cpu_reference/touch_rule.h"
#include "cpu_reference/touch_shortlists.h"
#include "cpu_reference/touch_sights.h"
#include "model/touch_surface.h"

namespace aspic::reference {

/// Constants of every pair of bodies, held once for bodies that are alike.
template <class T>
class TouchTable {
 public:
  TouchTable(const ContactSettings& contact, const std::vector<TouchBody>& bodies, double ahead_step);
  const TouchConstants<T>& at(std::uint32_t point_of, std::uint32_t face_of) const {
    const std::uint32_t a = kind_[point_of], b = kind_[face_of];
    return point_of == face_of ? self_[a] : pairs_[a * self_.size() + b];
  }
  /// Whether any pair has friction.
  bool rubs() const {
    return std::ranges::any_of(pairs_, [](const TouchConstants<T>& pair) { return pair.mu > T(0); });
  }

 private:
  std::vector<std::uint32_t> kind_;              // by body
  std::vector<TouchConstants<T>> self_, pairs_;  // by kind; by kinds
};

template <class T>
class BodyContact {
 public:
  using Particles = ParticleView<const T>;

  /// A point that touches a body in the initial state, where pushes begin at its distance there and come back
  /// to ρ with time.
  struct Eased {
    std::uint32_t point, body;
    T d;  ///< [m]
  };

  /// Of a model whose bodies_touch(). Bodies that overlap in its initial state are eased apart. With an
  /// `ahead_step` h [s] pushes are those at the end of a step (docs/contact.md, "Implicit Euler"): contacts
  /// are found from touch_ahead spacings on, and k·h takes the place of the damper.
  explicit BodyContact(const Model& model, double ahead_step = 0.0);
  BodyContact(const BodyContact&) = delete;
  BodyContact& operator=(const BodyContact&) = delete;

  /// A step from the state of this number begins here, where the particles stay until it ends. Returns
  /// whether anything may touch in it.
  bool begin_step(std::uint64_t step, const Particles& start);

  /// The candidates of this step: calls take(point, triangle), ascending by point, body and triangle.
  template <class Take>
  void for_candidates(const Take& take) const {
    for (const Encounter& near : near_.encounters())
      for (const std::uint32_t t : near_.triangles(near))
        if (is_candidate(near, t)) take(near.point, t);
  }

  /// Finds the contacts at a place of the step, for forces there and those below. Returns whether there is
  /// one.
  bool find(const Particles& at) {
    return find(at, [](std::size_t count, const auto& task) {
      for (std::size_t n = 0; n < count; ++n) task(n);
    });
  }
  /// The same on many threads: run(count, task) calls task(n) for n below count, in any order.
  template <class Run>
  bool find(const Particles& at, const Run& run) {
    short_.follow(at, run);
    normals_.make(at, run);
    const std::size_t pieces = pieces_of(near_.encounters().size());
    pieces_.resize(std::max(pieces_.size(), pieces));
    run(pieces, [&](std::size_t n) { find_in(n, at); });
    return gather();
  }
  /// How what is seen is computed, to the same bits as look_one_by_one().
  using Look = void (*)(const Particles&, SightBatch<T>&);
  void set_look(Look look) { look_ = look; }
  /// With an ahead_step: whether find() looks where the step may end, not where it begins.
  void set_at_end(bool on) { at_end_ = on; }
  /// Those of find(), ascending by point, body of the triangle, and first contact before second sides.
  std::span<const Touch<T>> touches() const { return touches_; }
  /// The particles that they name, ascending.
  std::span<const std::uint32_t> particles() const { return particles_; }

  /// Adds pushes and friction to the forces [N] of particles(), which gravity, springs and pulls have made.
  /// `start`: of the step; inverse_mass(particle) [1/kg].
  template <class InverseMass>
  void act(const Particles& start, const InverseMass& inverse_mass, std::vector<Vector<T>>& f) {
    push(start, inverse_mass, f);
    if (rubs_) spread<T>(touches_, f, [](const Touch<T>& touch) { return touch.rub; });
  }

  /// The same with pushes alone; friction is found, but not added.
  template <class InverseMass>
  void push(const Particles& start, const InverseMass& inverse_mass, std::vector<Vector<T>>& f) {
    spread<T>(touches_, f, [](const Touch<T>& touch) { return Vector<T>(touch.push * touch.n); });
    if (!rubs_) return;
    inverse_mass_.clear();
    v1_.clear();
    for (std::size_t n = 0; n < particles_.size(); ++n) {
      inverse_mass_.push_back(inverse_mass(particles_[n]));
      v1_.push_back(start.velocity(particles_[n]) + (h_ * inverse_mass_[n]) * f[n]);
    }
    find_friction();
  }
  /// Bodies whose boxes are farther apart than this do not touch [m].
  double most_margin() const { return near_.most_margin(); }

  /// Ascending by point and body.
  const std::vector<Eased>& eased() const { return eased_; }
  /// Σ ½k·max(0, ρ − d)² of the contacts of find() [J].
  T energy() const;
  std::uint64_t bytes() const;

 private:
  void ease_apart(const Model& model, bool ahead);
  bool is_candidate(const Encounter& near, std::uint32_t triangle) const;
  /// A point and a body, in the middle of a find().
  struct Looker {
    std::size_t n;  // of the encounter
    const Encounter& near;
    std::uint32_t own;  // the point's body
    const TouchConstants<T>& pair;
    bool opposing;
    Vector<T> P, N;  // the point and, where only faces count that turn to it, its normal
    const Particles& at;
  };
  /// What one task of find() works with.
  struct Piece {
    std::vector<Looker> queue;      // whose listed triangles are looked at together
    std::vector<std::size_t> ends;  // where those of each end in the batch
    std::vector<Sight<T>> sights, around;
    std::vector<std::pair<T, std::uint32_t>> by_distance;  // of those around
    std::vector<Touch<T>> touches;
    std::vector<std::size_t> listed;  // encounters whose short lists are new
  };
  static constexpr std::size_t piece_size = 256;
  static std::size_t pieces_of(std::size_t count) { return (count + piece_size - 1) / piece_size; }
  /// How far particles have gone since lists of what is near were made, and against each other where bodies
  /// meet [m].
  struct Gone {
    T far, apart;
  };
  Gone gone(const Particles& at) const;
  void list_used(const Particles& at);
  void want(std::size_t encounter);
  void find_in(std::size_t piece, const Particles& at);
  bool gather();
  bool counts(const Face<T>& face, const Looker& p) const;
  T pad(const TouchConstants<T>& pair) const;
  T enough(std::optional<T> least, const TouchConstants<T>& pair) const;
  Looker looker(std::size_t encounter, const Particles& at) const;
  void put(const Looker& p, SightBatch<T>& batch) const;
  void look(SightBatch<T>& batch, Piece& piece);
  bool look_at_few(const Looker& p, const SightBatch<T>& batch, std::size_t from,
                   std::vector<Sight<T>>& sights) const;
  void look_at_all(const Looker& p, Piece& piece);
  void touch(const Looker& p, Piece& piece) const;
  void add(const Looker& p, const Sight<T>& seen, const TouchGap<T>& gap, Piece& piece) const;
  void name_particles();
  void find_friction();
  std::uint32_t body_of(std::uint32_t point) const;
  std::uint32_t body_of_particle(std::uint32_t particle) const;  ///< of a surface
  std::uint32_t body_of_triangle(std::uint32_t triangle) const;
  T reach_of(const Encounter& encounter, const TouchConstants<T>& pair) const;

  TouchSurfaces surfaces_;
  TouchTable<T> table_;
  NearTriangles near_;
  T h_;
  bool rubs_;  // any pair has friction
  double timestep_;
  bool at_end_ = false;
  Look look_ = look_one_by_one<T>;
  std::vector<Eased> eased_;  // ascending by point and body
  T time_ = T(0);             // since the initial state [s]
  std::optional<Particles> start_;
  TouchNormals<T> normals_;
  TouchShortlists<T> short_;
  std::vector<std::uint32_t> own_;  // by encounter: the point's body
  struct SurfaceParticle {
    std::uint32_t particle, point;
  };
  std::vector<SurfaceParticle> surface_;  // ascending by both
  std::vector<Vector<T>> known_places_;   // of these, when the lists of what is near were made
  std::vector<std::uint32_t> met_;        // particles that meetings name
  std::vector<Vector<T>> met_from_;       // where they were then
  std::vector<Vec3> places_;              // by point
  std::vector<Piece> pieces_;
  std::vector<Touch<T>> touches_;
  std::vector<std::uint32_t> particles_, place_of_;
  std::vector<T> inverse_mass_, share_;  // by place among the particles, as v1_
  std::vector<Vector<T>> v1_;
};

// Compiled once, in body_contact.cpp.
extern template class TouchTable<float>;
extern template class TouchTable<double>;
extern template class BodyContact<float>;
extern template class BodyContact<double>;

}  // namespace aspic::reference

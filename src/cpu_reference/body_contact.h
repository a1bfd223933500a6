#pragma once
// Contact between bodies, and of a body with itself, in the force evaluations of a step (docs/contact.md).
// The particles may lie anywhere: the cpu backend runs this on its own arrays.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cpu_reference/ball_particles.h"
#include "cpu_reference/near_triangles.h"
#include "cpu_reference/touch_geometry.h"
#include "cpu_reference/touch_rule.h"
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

  /// A step from the state of this number begins here: what may touch in it is decided. Returns whether
  /// anything may.
  bool begin_step(std::uint64_t step, const Particles& start);

  /// The points that may touch in this step, and what: ascending by point, body and triangle.
  std::span<const Encounter> encounters() const { return encounters_; }
  std::span<const std::uint32_t> candidates(const Encounter& of) const {
    return std::span(candidates_).subspan(of.first, of.count);
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
    const bool prepared = prepared_ == at.x[0];  // the first stage of a step is at its start
    prepared_ = nullptr;
    if (!prepared) run(pieces_of(used_.size()), [&](std::size_t n) { prepare_faces(n, at); });
    if (!prepared) prepare_normals();
    pieces_.resize(std::max(pieces_.size(), pieces_of(encounters_.size())));
    run(pieces_of(encounters_.size()), [&](std::size_t n) { find_in(n, at); });
    return gather();
  }
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
    if (friction_ > T(0)) spread<T>(touches_, f, [](const Touch<T>& touch) { return touch.rub; });
  }

  /// The same with pushes alone; friction is found, but not added.
  template <class InverseMass>
  void push(const Particles& start, const InverseMass& inverse_mass, std::vector<Vector<T>>& f) {
    spread<T>(touches_, f, [](const Touch<T>& touch) { return Vector<T>(touch.push * touch.n); });
    if (!(friction_ > T(0))) return;
    inverse_mass_.clear();
    v1_.clear();
    for (std::size_t n = 0; n < particles_.size(); ++n) {
      inverse_mass_.push_back(inverse_mass(particles_[n]));
      v1_.push_back(start.velocity(particles_[n]) + (h_ * inverse_mass_[n]) * f[n]);
    }
    find_friction();
  }
  /// μ
  T friction() const { return friction_; }

  /// Ascending by point and body.
  const std::vector<Eased>& eased() const { return eased_; }
  /// Σ ½k·max(0, ρ − d)² of the contacts of find() [J].
  T energy() const;
  std::uint64_t bytes() const;

 private:
  void ease_apart(const Model& model, bool ahead);
  void find_candidates(const Particles& start);
  /// What one task of find() works with.
  struct Piece {
    std::vector<Sight<T>> sights;
    std::vector<Touch<T>> touches;
  };
  static constexpr std::size_t piece_size = 256;
  static std::size_t pieces_of(std::size_t count) { return (count + piece_size - 1) / piece_size; }
  void list_used();
  void prepare_faces(std::size_t piece, const Particles& at);
  void prepare_normals();
  void find_in(std::size_t piece, const Particles& at);
  bool gather();
  const Face<T>& face(std::uint32_t triangle) const { return faces_[slot_[triangle]]; }
  bool counts(const Face<T>& face, bool opposing, const Vector<T>& N) const;
  void look(const Encounter& encounter, const TouchConstants<T>& pair, std::uint32_t hint, bool opposing,
            const Vector<T>& P, std::vector<Sight<T>>& sights) const;
  void touch(const Encounter& encounter, std::uint32_t& hint, const Particles& at, Piece& piece) const;
  Touch<T> contact(const Encounter& encounter, const Sight<T>& seen, const TouchGap<T>& gap,
                   const Particles& at) const;
  void name_particles();
  void find_friction();
  std::uint32_t body_of(std::uint32_t point) const;
  std::uint32_t body_of_triangle(std::uint32_t triangle) const;
  T reach_of(const Encounter& encounter, const TouchConstants<T>& pair) const;

  TouchSurfaces surfaces_;
  TouchTable<T> table_;
  NearTriangles near_;
  T h_, friction_;
  double timestep_;
  bool at_end_ = false;
  std::vector<Eased> eased_;  // ascending by point and body
  T time_ = T(0);             // since the initial state [s]
  // Of what is near: triangles and where their faces are, points of carriers with their normals, the nearest
  // triangle of each encounter when it was last looked at.
  std::vector<std::uint32_t> used_, slot_, used_points_, hints_;
  std::vector<Face<T>> faces_;
  std::vector<Vector<T>> normals_;  // by point
  const T* prepared_ = nullptr;     // the places that faces_ are of, if these may not have changed since
  std::vector<std::uint32_t> near_index_;  // of encounters_
  std::vector<Encounter> encounters_;
  std::vector<std::uint32_t> candidates_;
  std::vector<Vec3> places_;
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

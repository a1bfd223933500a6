#pragma once
// Contact between bodies, and of a body with itself, by its definition (docs/contact.md): every point looks
// at every candidate in every force evaluation, and nothing is kept from one step to the next.
#include <cstdint>
#include <vector>

#include "model/contact_surface.h"
#include "physics/contact/candidates.h"
#include "physics/contact/forces.h"
#include "physics/contact/overlap.h"
#include "physics/contact/selection.h"

namespace aspic::reference {

using namespace physics;

template <class T>
class BodyContact : public ContactForces<T> {
 public:
  using typename ContactForces<T>::Particles;

  /// Of a model whose has_body_contact(), which must outlive it. With an `ahead_step` h [s] normal forces are
  /// those at the end of a step (docs/contact.md, "Implicit Euler").
  explicit BodyContact(const Model& model, double ahead_step = 0.0);

  /// The step from the state of this number begins: finds the candidates. Returns whether there are any.
  bool begin_step(std::uint64_t step, const Particles& start);
  /// Finds the contacts of a force evaluation. Returns whether there are any.
  bool find(const Particles& at);
  /// With an ahead_step: whether find() sees the end of a step instead of its start.
  void set_at_end(bool on) { at_end_ = on; }

  const std::vector<InitialOverlap<T>>& initial_overlaps() const { return overlaps_.all(); }

 private:
  /// The candidates of a point on one body.
  struct Group {
    std::uint32_t point, body, first, count;  // in candidates_
  };
  template <class U>
  friend class BodyContact;
  BodyContact(const Model& model, double ahead_step, bool initial);
  Vector<T> normal_of(const SurfacePoint& point, const Particles& at) const;
  Face<T> face_at(std::uint32_t triangle, const Particles& at) const;
  void add(const Group& group, const ClosestPoint<T>& seen, const ContactGap<T>& gap, const Particles& at);

  const Model& model_;
  ContactSurfaces surfaces_;
  PairTable<T> table_;
  InitialOverlaps<T> overlaps_;
  bool at_end_ = false;
  bool initial_ = false;  // finds initial overlaps
  std::vector<Group> groups_;
  std::vector<std::uint32_t> candidates_;  // triangles
};

// Compiled once, in body_contact.cpp.
extern template class BodyContact<float>;
extern template class BodyContact<double>;

}  // namespace aspic::reference

#pragma once
// Forces of contact between bodies on their particles at a state, in double precision.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "analysis/particle_force.h"

namespace aspic {

namespace collision {
template <class T>
class ContactSearch;
}

/// Normal forces and friction of other bodies on one particle, as carrier of points and as corner of faces
/// (docs/contact.md).
struct BodyContactForce {
  std::uint32_t particle = 0;
  Vec3 normal;  ///< unit, direction of the sum of normal forces; zero where they balance
  Vec3 force;   ///< [N]
};

class BodyContactForces {
 public:
  /// Finds nothing in a model without contact between bodies. The model must outlive it.
  explicit BodyContactForces(const Model& model);
  /// The same, with the forces of a state.
  BodyContactForces(const Model& model, const SpringFinder& springs, const State& state,
                    const Inputs& inputs);
  ~BodyContactForces();

  /// Finds the forces that the step has which begins with this state; under implicit Euler those with which
  /// its first solve begins. `springs` and `inputs` as in particle_force().
  void find(const SpringFinder& springs, const State& state, const Inputs& inputs);
  /// One for each particle with a normal force, in ascending order.
  std::span<const BodyContactForce> forces() const { return forces_; }
  /// On one particle [N].
  Vec3 on(std::uint32_t particle) const;

 private:
  const Model& model_;
  std::unique_ptr<collision::ContactSearch<double>> contact_;  // null: no contact between bodies
  std::vector<BodyContactForce> forces_;
};

}  // namespace aspic

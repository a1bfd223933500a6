#pragma once
// What bodies that touch do to each other's particles at a state, in double precision.
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

/// Pushes and friction of other bodies on one particle, of those whose points it carries and those that touch
/// faces at it (docs/contact.md).
struct BodyContactForce {
  std::uint32_t particle = 0;
  Vec3 normal;  ///< unit, the direction of the pushes' sum; zero where they balance
  Vec3 force;   ///< [N]
};

class BodyContactForces {
 public:
  /// Finds nothing where the model's bodies cannot touch. The model must outlive it.
  explicit BodyContactForces(const Model& model);
  /// The same, with the forces of a state.
  BodyContactForces(const Model& model, const SpringFinder& springs, const State& state,
                    const Inputs& inputs);
  ~BodyContactForces();

  /// Finds the forces that the step has which begins with this state; under implicit Euler those with which
  /// its first solve begins. `springs` and `inputs` as in particle_force().
  void find(const SpringFinder& springs, const State& state, const Inputs& inputs);
  /// Of particles that are pushed, ascending.
  std::span<const BodyContactForce> forces() const { return forces_; }
  /// On one particle [N].
  Vec3 on(std::uint32_t particle) const;

 private:
  const Model& model_;
  std::unique_ptr<collision::ContactSearch<double>> contact_;  // none where no bodies can touch
  std::vector<BodyContactForce> forces_;
};

}  // namespace aspic

#pragma once
// Bodies that touch in a step of implicit Euler: what contact adds to forces, to diagonal blocks and to
// products with the matrix, for every particle.
#include <array>
#include <cstdint>
#include <functional>

#include "collision/contact_search.h"
#include "cpu_parallel/particles.h"
#include "cpu_parallel/workers.h"
#include "physics/contact/implicit.h"

namespace aspic::parallel {

class ImplicitBodyContact {
 public:
  using Vector = physics::Vector<float>;
  using Force = std::function<Vector(std::uint32_t)>;  ///< gravity, springs and pulls on a particle [N]

  /// Of a model whose has_body_contact(). The last two must outlive it.
  ImplicitBodyContact(const Model& model, const FloatArray& inverse_mass, Workers& workers);

  /// A step from the state of this number begins. Returns whether anything is near enough to touch in it.
  bool start(std::uint64_t step, const Particles& start, const Force& force);
  /// The same where the step may end, with velocities v' [m/s].
  bool search_again(const Particles& start, const VectorArray& v, float h, const Force& force);

  /// At the trial velocities [m/s]; `held`: forces to be added to [N], or nullptr. Returns whether any
  /// contact acts.
  bool react(const VectorArray& trial, const VectorArray* held);
  const VectorArray& force() const { return force_; }  ///< with `held` [N]
  /// xx, yy, zz, xy, xz, yz [kg]
  const std::array<FloatArray, 6>& blocks() const { return blocks_; }
  /// The matrix of contacts times a direction: product().
  void multiply(const VectorArray& p);
  const VectorArray& product() const { return product_; }

  std::uint64_t bytes() const;

 private:
  template <class Search>
  bool begin(const Search& search);
  void clear();

  physics::ImplicitContact<float, collision::ContactSearch<float>> contact_;
  const FloatArray& inverse_mass_;
  Workers& workers_;
  std::size_t count_;
  VectorArray force_, product_, end_;  // end_: where the step may end [m]
  std::array<FloatArray, 6> blocks_;
  std::vector<std::uint32_t> filled_;  // particles whose numbers are not those of the rest
};

}  // namespace aspic::parallel

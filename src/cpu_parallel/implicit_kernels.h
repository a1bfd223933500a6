#pragma once
// The inner loops of implicit Euler, compiled for every instruction set as those of kernels.h are. Each lane
// does what cpu_reference/implicit_euler.h does for one particle, in the same order.
#include <array>
#include <cstdint>
#include <vector>

#include "cpu_parallel/particles.h"
#include "cpu_parallel/springs.h"
#include "physics/body_force.h"

namespace aspic::parallel {

/// Consecutive particles of one body, of a lattice also of one plane; those of a reduction's block or fewer.
struct Segment {
  std::size_t body;
  std::size_t plane;  ///< of a lattice
  Range own;          ///< within the plane or the body
  std::size_t first;  ///< among all particles
};

/// What every spring needs to be linearized: the step's start, the trial velocity there, and the step.
struct Linearization {
  const VectorArray* x;  ///< [m]
  const VectorArray* v;  ///< v' [m/s]
  const float* mass;     ///< [kg]
  const physics::BodyForce<float>* body_force;
  float h;  ///< [s]
};

/// −h·∂f/∂v' of a body's springs: H·d = across·d + (along − across)·n(n·d). `along` is the springs' own; n
/// and across of every spring are kept from one evaluation for the products that follow, or recomputed in
/// each.
class Jacobians {
 public:
  Jacobians(const LatticeStencil& lattice, float h, bool keep);
  Jacobians(const SpringLists& lists, float h, bool keep);
  /// Of the same springs with other constants.
  void set_constants(const LatticeStencil& lattice, float h);
  void set_constants(const SpringLists& lists, float h);

  /// By direction of a lattice, by class of the model in lists [kg].
  const float* along() const { return along_.data(); }
  /// across, n_x, n_y, n_z of the springs from `plane` in upward direction number `up`, one row each, by the
  /// particle within the plane; nothing if they are not kept.
  float* row(std::size_t plane, std::size_t up) { return at((plane * ups_ + up) * 4 * row_size_); }
  const float* row(std::size_t plane, std::size_t up) const {
    return const_cast<Jacobians*>(this)->row(plane, up);
  }
  std::size_t row_size() const { return row_size_; }
  /// The same of a slot of lists, numbered through all of them: rows of `slice`.
  float* slot(std::size_t n) { return at(n * 4 * slice); }
  const float* slot(std::size_t n) const { return const_cast<Jacobians*>(this)->slot(n); }
  bool kept() const { return kept_; }
  std::uint64_t bytes() const { return bytes_of(along_) + bytes_of(values_); }

 private:
  float* at(std::size_t n) { return kept_ ? values_.data() + n : nullptr; }

  bool kept_;
  std::size_t ups_ = 0, row_size_ = slice;
  std::vector<float> along_;
  FloatArray values_;
};

/// Force on each particle of a segment [N], without contact and pull, and the diagonal block of the matrix:
/// xx, yy, zz, xy, xz, yz [kg].
struct LinearizedForces {
  std::array<float*, 3> force;
  std::array<float*, 6> block;
};

void linearize(const LatticeStencil& lattice, Jacobians& jacobians, const Linearization& at,
               const Segment& segment, const LinearizedForces& out);
void linearize(const SpringLists& lists, Jacobians& jacobians, const Linearization& at,
               const Segment& segment, const LinearizedForces& out);

/// m·p and the springs' part of A·p [kg·m/s], on each particle of a segment.
void multiply(const LatticeStencil& lattice, const Jacobians& jacobians, const Linearization& at,
              const VectorArray& p, const Segment& segment, const std::array<float*, 3>& out);
void multiply(const SpringLists& lists, const Jacobians& jacobians, const Linearization& at,
              const VectorArray& p, const Segment& segment, const std::array<float*, 3>& out);

/// Particles of one reduction at most (physics/reductions.h).
inline constexpr std::size_t block_size = 256;
/// A number for each particle of a block.
struct BlockNumbers {
  alignas(64) float of[block_size + slice];
};
using BlockVectors = std::array<BlockNumbers, 3>;

/// The linear system A·δ = r, and the velocities that its solution leads to.
struct LinearSystem {
  VectorArray base;                   ///< [m/s]
  VectorArray delta;                  ///< [m/s]
  VectorArray r;                      ///< [kg·m/s]
  VectorArray z;                      ///< A·p, then B⁻¹·r
  VectorArray p;                      ///< search direction
  std::array<FloatArray, 6> inverse;  ///< B⁻¹: xx, yy, zz, xy, xz, yz [1/kg]

  LinearSystem() = default;
  LinearSystem(std::size_t count, std::size_t margin);
  std::uint64_t bytes() const {
    return bytes_of(base) + bytes_of(delta) + bytes_of(r) + bytes_of(z) + bytes_of(p) + bytes_of(inverse);
  }
};

/// A block at a trial velocity. All ranges from here on are blocks: they begin at a multiple of block_size.
struct BlockResidual {
  const VectorArray *start_v, *trial;
  const VectorArray* held;  ///< a force besides [N]; nothing: none
  const float *mass, *inverse_mass;
  float h;
  /// Square of how far [m²] a particle may go in the step without meeting ground; nothing: there is none.
  const float* clearance;
};

/// From the forces f and `held`: r of the linear system, R and the free velocity v + h·a of every particle.
/// `meets` tells those that may meet ground, by another number than 0. Returns whether there are any.
bool residuals(const BlockResidual& at, Range range, const BlockVectors& f, VectorArray& r, BlockVectors& R,
               BlockVectors& free, BlockNumbers& meets);

/// A block's part in a Trial (cpu_reference/implicit_newton.h), as the trees over blocks have it.
struct ResidualShare {
  float largest, merit, falling;
};
ResidualShare share_of(const BlockVectors& R, const float* inverse_mass, const std::array<float, 3>& fall,
                       std::size_t count);

/// B⁻¹ of every particle from the blocks.
void invert(const std::array<BlockNumbers, 6>& blocks, Range range, LinearSystem& system);

/// What happens to δ and r when A times a direction is known (in z).
enum class Update {
  none,        ///< nothing: δ = 0
  prescribed,  ///< r −= z: δ was the direction
  first,       ///< δ = α·p, r −= α·z
  further      ///< δ += α·p, r −= α·z
};
/// Then z = B⁻¹·r.
void update(LinearSystem& system, Range range, Update how, float alpha);

/// Σ a·b over a block, as the tree over it has it.
float dot(const VectorArray& a, const VectorArray& b, Range range);

/// p = z + β·p; at the `first` direction p = z.
void turn(LinearSystem& system, Range range, bool first, float beta);

/// trial = base + λ·δ; `onwards`: the base becomes the trial before that.
void try_velocity(LinearSystem& system, VectorArray& trial, Range range, bool onwards, float lambda);

/// x' = x + h·v'.
void drift(const VectorArray& x, const VectorArray& v, float h, VectorArray& to, Range range);

}  // namespace aspic::parallel

// Implicit Euler's blocks of particles: which segments of bodies each has, and what is known of it ahead of a
// solve.
#include <algorithm>
#include <limits>

#include "cpu_parallel/implicit.h"

namespace aspic::parallel {

std::uint64_t ImplicitEuler::bytes() const {
  std::uint64_t sum = sizeof(*this) + system_.bytes() + bytes_of(held_force_) + bytes_of(clearance_) +
                      bytes_of(blocks_) + bytes_of(sums_) + bytes_of(largest_) + bytes_of(falling_) +
                      bytes_of(jacobians_);
  for (const Block& block : blocks_) sum += bytes_of(block.segments) + bytes_of(block.held);
  for (const Jacobians& each : jacobians_) sum += each.bytes();
  return bodies_ ? sum + bodies_->bytes() : sum;
}

void ImplicitEuler::cut_into_blocks() {
  for (std::size_t at = 0; at < model_->particle_count(); at += block_size)
    blocks_.push_back(
        {{at, std::min<std::size_t>(block_size, model_->particle_count() - at)}, {}, {}, false, false});
  const auto cut = [&](std::size_t body, std::size_t plane, std::size_t first, std::size_t count) {
    for (std::size_t at = first; at < first + count;) {
      const std::size_t end = std::min(first + count, (at / block_size + 1) * block_size);
      blocks_[at / block_size].segments.push_back({body, plane, {at - first, end - at}, at});
      at = end;
    }
  };
  for (std::size_t b = 0; b < springs_.size(); ++b) {
    if (const auto* const lattice = std::get_if<LatticeStencil>(&springs_[b])) {
      for (std::size_t plane = 0; plane < lattice->planes(); ++plane)
        cut(b, plane, lattice->first() + plane * lattice->plane_size(), lattice->plane_size());
    } else {
      const auto& lists = std::get<SpringLists>(springs_[b]);
      cut(b, 0, lists.first(), lists.count());
    }
  }
}

/// Square of the way [m²] that a particle at x may go in this step without meeting ground; negative if it may
/// meet some however slowly it moves.
float ImplicitEuler::clearance(const Vector& x) const {
  float least = std::numeric_limits<float>::infinity();
  for (const physics::Ground<float>& ground : dynamics_.grounds()) {
    float d = physics::distance<float>(ground, ground.start, x);
    if (ground.end.moves) d -= 1.001f * (h_ * physics::norm3<float>(ground.end.velocity));
    if (!(d >= least)) least = d;
  }
  return least > 0.0f ? least * least : -1.0f;
}

}  // namespace aspic::parallel

#pragma once
// Rest lengths that follow signals, as the springs' kernels read them.
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cpu_parallel/bands.h"
#include "cpu_parallel/springs.h"
#include "cpu_reference/dynamics.h"
#include "model/actuation.h"

namespace aspic::parallel {

using Springs = std::variant<LatticeStencil, Bands, SpringLists>;

/// Puts them into a solver's springs, by body.
class MovingLengths {
 public:
  /// Of the model, which must outlive it or give way to another by set_model().
  MovingLengths(const Model& model, std::vector<Springs>& springs) : springs_(springs) { set_model(model); }
  /// Another with the same springs and drives; the springs have constants of it.
  void set_model(const Model& model);
  /// Whether any follow signals.
  bool any() const { return lengths_.has_value(); }
  /// The springs have those of that share of the step which `dynamics` is in. No thread may be at work with
  /// them.
  void set(const reference::Dynamics<float>& dynamics, double share);
  std::uint64_t bytes() const { return bytes_of(bodies_); }

 private:
  std::vector<Springs>& springs_;
  const Model* model_ = nullptr;
  std::optional<RestLengths> lengths_;
  std::vector<std::uint32_t> bodies_;  // of each actuated class
};

}  // namespace aspic::parallel

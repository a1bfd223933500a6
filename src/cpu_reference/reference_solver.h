#pragma once
// The readable solver: one thread, Eigen, written to be read next to docs/physics.md. It proves the others
// right.
#include <memory>
#include <utility>

#include "aspic/solver.h"
#include "base/flush_denormals.h"
#include "model/model.h"

namespace aspic {

/// A reference solver at the model's initial state, in single or double precision. Error (scene_rejected):
/// there is no memory left for its fields.
Result<std::unique_ptr<Solver>> make_reference_solver(SharedModel model, Precision precision,
                                                      Denormals denormals = Denormals::flushed);
/// With a model of its own: a copy, or what is moved here.
inline Result<std::unique_ptr<Solver>> make_reference_solver(Model model, Precision precision) {
  return make_reference_solver(shared(std::move(model)), precision);
}

/// Bytes a reference solver of the model holds at most during a step.
std::uint64_t reference_bytes(const Model& model, Precision precision);

}  // namespace aspic

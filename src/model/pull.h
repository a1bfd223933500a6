#pragma once
// A pull as a solver takes it.
#include <optional>

#include "aspic/error.h"
#include "aspic/inputs.h"
#include "aspic/state.h"
#include "model/model.h"

namespace aspic {

/// The pull as a solver of that precision takes it: rounded, −0 read as +0. Errors (usage): the model has no
/// such particle or ball, a number is not finite (or too large for the precision), stiffness or damping is
/// negative.
Result<std::optional<Pull>> rounded_pull(const Model& model, const std::optional<Pull>& pull,
                                         Precision precision);

}  // namespace aspic

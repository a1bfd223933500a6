#pragma once
// A pull as a solver takes it.

#include "aspic/error.h"
#include "aspic/inputs.h"
#include "aspic/state.h"
#include "model/model.h"

namespace aspic {

/// The pull as a solver of that precision takes it: rounded, −0 read as +0. Errors (usage): the model has no
/// such particle or ball, a number is not finite (or too large for the precision), stiffness or damping is
/// negative.
Result<Pull> rounded_pull(const Model& model, const Pull& pull, Precision precision);

/// x as a solver of that precision holds it, infinite where it is too large for it; −0 read as +0.
double rounded_number(double x, Precision precision);

}  // namespace aspic

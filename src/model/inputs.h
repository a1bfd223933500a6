#pragma once
// Inputs as solvers take them.
#include <cstdint>

#include "aspic/error.h"
#include "aspic/inputs.h"
#include "aspic/state.h"
#include "model/model.h"
#include "model/particle_data.h"
#include "model/pull.h"

namespace aspic {

/// Inputs as a solver of that precision takes them: numbers rounded, −0 read as +0, pins in ascending order.
/// Errors (usage), which name the list and the index in it: those of rounded_pull; a particle that the model
/// does not have, or that is listed twice; a released one that the scene does not pin; a channel that is not
/// finite; more than there may be.
Result<Inputs> rounded_inputs(const Model& model, const Inputs& inputs, Precision precision);

/// w [1/kg] of a particle under inputs that rounded_inputs() returned for the model.
double inverse_mass_of(const Model& model, const Inputs& inputs, std::uint32_t particle);
/// w [1/kg] of every particle under inputs that rounded_inputs() returned for the model.
Runs<double> inverse_mass_under(const Model& model, const Inputs& inputs);

/// Error: that of rounded_inputs() for the first entry that a solver of the model would refuse, with its
/// step.
Status check_log(const Model& model, const InputLog& log, Precision precision);

}  // namespace aspic

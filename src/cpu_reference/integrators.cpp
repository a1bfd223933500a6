#include "cpu_reference/integrators.h"

#include "cpu_reference/step_dynamics.h"

namespace aspic::reference {

template Phase<float> explicit_step(Integrator, const StepDynamics<float>&, const Phase<float>&, double);
template Phase<double> explicit_step(Integrator, const StepDynamics<double>&, const Phase<double>&, double);

}  // namespace aspic::reference

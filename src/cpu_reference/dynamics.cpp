#include "cpu_reference/dynamics.h"

namespace aspic::reference {

template class Dynamics<float>;
template class Dynamics<double>;
template class StepDynamics<float>;
template class StepDynamics<double>;

}  // namespace aspic::reference

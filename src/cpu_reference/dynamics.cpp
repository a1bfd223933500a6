#include "cpu_reference/dynamics.h"

namespace aspic::reference {

template class Dynamics<float>;
template class Dynamics<double>;

}  // namespace aspic::reference

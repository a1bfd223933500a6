#include "cpu_reference/implicit_euler.h"

namespace aspic::reference {

template class ImplicitEuler<float>;
template class ImplicitEuler<double>;

}  // namespace aspic::reference

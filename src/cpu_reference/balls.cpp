#include "cpu_reference/balls.h"

namespace aspic::reference {

template class Balls<float>;
template class Balls<double>;

}  // namespace aspic::reference

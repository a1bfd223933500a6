// In place of what is not compiled: Highway's library, and which force paths the methods of the gpu backend
// take.
#include <hwy/targets.h>

#include "gpu_solver/device_solver.h"
#include "model/integrator.h"

namespace hwy {

// With HWY_COMPILE_ONLY_STATIC there is one instruction set.
int64_t SupportedTargets() {
  return HWY_STATIC_TARGET;
}
void SetSupportedTargetsForTest(int64_t) {}

}  // namespace hwy

namespace aspic {

const DeviceMethod& device_method(Integrator integrator, std::uint64_t) {
  static const DeviceMethod staged = {nullptr, [](const ForcePathRow&) { return true; }, nullptr, 0, true};
  static const DeviceMethod newton = {nullptr, [](const ForcePathRow& path) { return path.implicit; },
                                      nullptr, 0, false};
  return row_of(integrator).staged() ? staged : newton;
}

}  // namespace aspic

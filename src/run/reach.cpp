#include "run/reach.h"

namespace aspic {

std::optional<DeviceReach> device_reach(Integrator integrator) {
  const auto context = gl::Context::create_headless();
  if (!context) return std::nullopt;
  const gl::DeviceInfo& info = (*context)->info();
  return DeviceReach{info.renderer, largest_cubes(info.limits, (*context)->free_memory(), integrator)};
}

std::string limit_text(const CubeReach& reach) {
  switch (reach.limit) {
    case ReachLimit::memory:
      return "the device's free memory";
    case ReachLimit::words:
      return "words of 32 bits";
    case ReachLimit::block:
      break;
  }
  return "the device's largest storage block";
}

}  // namespace aspic

#include "run/reach.h"

#include "base/memory.h"

namespace aspic {

std::optional<DeviceReach> device_reach(Integrator integrator) {
  const auto context = gl::Context::create_headless();
  if (!context) return std::nullopt;
  const gl::DeviceInfo& info = (*context)->info();
  // A software rasteriser's memory is the machine's.
  const auto free = info.is_software ? available_memory() : (*context)->free_memory();
  return DeviceReach{info.renderer, largest_cubes(info.limits, free, integrator)};
}

std::string limit_text(const CubeReach& reach) {
  switch (reach.limit) {
    case ReachLimit::memory:
      return "free memory";
    case ReachLimit::words:
      return "words of 32 bits";
    case ReachLimit::buffer:
      return "the device's largest buffer";
    case ReachLimit::block:
      break;
  }
  return "the device's largest storage block";
}

}  // namespace aspic

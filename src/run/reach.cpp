#include "run/reach.h"

#include "base/memory.h"

namespace aspic {

std::optional<std::uint64_t> free_bytes(gl::Context& context) {
  return context.info().is_software ? available_memory() : context.free_memory();
}

std::optional<DeviceReach> device_reach(Integrator integrator) {
  const auto context = gl::Context::create_headless();
  if (!context) return std::nullopt;
  const gl::DeviceInfo& info = (*context)->info();
  return DeviceReach{info.renderer, largest_cubes(info.limits, free_bytes(**context), integrator)};
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

#include "run/capacity.h"

#include "base/memory.h"

namespace aspic {

std::optional<std::uint64_t> free_bytes(gl::Context& context) {
  return context.info().is_software ? available_memory() : context.free_memory();
}

std::optional<DeviceCapacity> device_capacity(Integrator integrator) {
  const auto context = gl::Context::create_headless();
  if (!context) return std::nullopt;
  const gl::DeviceInfo& info = (*context)->info();
  return DeviceCapacity{info.renderer, largest_cubes(info.limits, free_bytes(**context), integrator)};
}

std::string limit_text(const CubeCapacity& capacity) {
  switch (capacity.limit) {
    case CapacityLimit::memory:
      return "free memory";
    case CapacityLimit::words:
      return "words of 32 bits";
    case CapacityLimit::buffer:
      return "the device's largest buffer";
    case CapacityLimit::block:
      break;
  }
  return "the device's largest storage block";
}

}  // namespace aspic

#pragma once
// Where the moving things of a picture lie on the device.
#include <cstdint>

#include "gpu/buffer.h"

namespace aspic {

/// A state on the device. The buffers must outlive every use of it.
struct DeviceState {
  /// The model's particles, 32 bytes each: position and inverse mass, velocity and mass
  /// (GpuSolver::particles() is such a buffer).
  const gl::Buffer* particles = nullptr;
  /// The model's balls from item first_ball on, 64 bytes each, as GpuSolver::balls() describes them. Null
  /// draws none; not looked at where the model has none.
  const gl::Buffer* balls = nullptr;
  std::uint32_t first_ball = 0;
  std::uint64_t step = 0;  ///< steps since the run's start: how far balls have turned since the last picture
};

}  // namespace aspic

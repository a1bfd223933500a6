#pragma once
// Where the moving things of a picture lie on the device.
#include <cstdint>

#include "device/spring_buffers.h"
#include "gpu/buffer.h"

namespace aspic {

/// A state on the device. The buffers must outlive every use of it.
struct DeviceState {
  const gl::Buffer* particles = nullptr;  ///< the model's: layout::Particle each
  /// The model's balls from item first_ball on: layout::Ball each. Null draws none; not looked at where the
  /// model has none.
  const gl::Buffer* balls = nullptr;
  std::uint32_t first_ball = 0;
  std::uint64_t step = 0;  ///< steps since the run's start: how far balls have turned since the last picture
  /// The model's springs, for colours that show what they do; null, or with words that name springs: pictures
  /// make their own.
  const SpringBuffers* springs = nullptr;
};

}  // namespace aspic

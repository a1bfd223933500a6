#pragma once
// Invocations of a work group, by device.
#include <algorithm>
#include <cstdint>

#include "gpu/device_info.h"

namespace aspic {

/// What explicit methods take unless they are told. Milliseconds of the forces of `cube-plane` by particles
/// per edge, on an NVIDIA H200 (driver 580.159.04), path lattice, quick corrected arithmetic:
///
///   invocations    64³      100³     128³
///   32             0.0514   0.1355   0.2540
///   64             0.0438   0.1281   0.2381
///   128            0.0563   0.1251   0.2367
///   256            0.0398   0.1226   0.2281
///
/// Software rasterizers run the invocations of a group one vector after the other on one thread: small groups
/// share out small scenes.
inline std::uint32_t group_size_on(const gl::DeviceInfo& device) {
  const std::uint32_t wanted = device.is_software ? 64 : 256;
  return std::min({wanted, device.limits.group_invocations, device.limits.group_size[0]});
}

}  // namespace aspic

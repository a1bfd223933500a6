#pragma once
// How often a kernel may loop. Some drivers end the loops of an invocation without a word after so many
// rounds in all (Mesa's llvmpipe after 65,535), so what could take more is refused by name
// (docs/determinism.md).
#include <cstdint>
#include <string_view>

#include "base/result.h"

namespace aspic::gl {

/// Rounds of one loop; a kernel has at most three such loops. MAX_ROUNDS of shaders/compute/layout.glsl.
inline constexpr std::uint32_t max_rounds = 20000;

/// The error (no_device) for `kernel`, which would loop more often over `rounds`, as in "the springs of one
/// particle".
inline Error loop_error(std::string_view kernel, std::string_view rounds) {
  return advised(
      fail(ErrorCode::no_device, "The kernel {} would loop over {} more often than every device guarantees.",
           kernel, rounds),
      {use_backend("cpu"), advice("make the scene smaller")});
}

/// loop_error() where `count` is more than max_rounds. For kernels that loop over lists the host has made.
inline Status check_loop(std::string_view kernel, std::string_view rounds, std::uint64_t count) {
  return count <= max_rounds ? Status() : loop_error(kernel, rounds);
}

}  // namespace aspic::gl

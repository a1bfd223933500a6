#include "gpu/loop_bound.h"

#include <fmt/format.h>

namespace aspic::gl {

Error loop_error(std::string_view kernel, std::string_view rounds) {
  return fail(ErrorCode::no_device,
              "The kernel {} would loop over {} more often than every device guarantees. Make "
              "the scene smaller, or use --backend reference.",
              kernel, rounds);
}

Status check_loop(std::string_view kernel, std::string_view rounds, std::uint64_t count) {
  if (count <= max_rounds) return {};
  return loop_error(kernel, rounds);
}

}  // namespace aspic::gl

#pragma once
// Which process this is: threads and drivers of a parent are not in a child of fork().
#include <cstdint>

namespace aspic {

/// Forks between the start of the program and this process. What was made at another count has lost its
/// threads.
std::uint64_t forks();

}  // namespace aspic

#pragma once
// Figures as people read them.
#include <cstdint>
#include <string>

namespace aspic {

/// "1.5 MiB", "512 bytes": a size for a sentence.
std::string human_bytes(std::uint64_t bytes);

}  // namespace aspic

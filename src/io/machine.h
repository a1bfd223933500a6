#pragma once
// What a result says of the machine it was measured on.
#include <cstdint>
#include <string>

namespace aspic {

/// The processor's name as the system has it; empty if it says none.
std::string processor_name();

/// Memory of the machine [bytes].
std::uint64_t memory_bytes();

}  // namespace aspic

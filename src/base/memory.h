#pragma once
// How much memory there is to have, for sizes that are checked before anything is allocated.
#include <cstdint>
#include <optional>

namespace aspic {

/// Bytes of memory this process could still take: the memory available to the system (MemAvailable of
/// /proc/meminfo), and no more than its limit on address space (ulimit -v) leaves. Nothing where the system
/// does not say.
std::optional<std::uint64_t> available_memory();

/// Bytes of address space that the limit of this process (RLIMIT_AS, ulimit -v) leaves; nothing without a
/// limit.
std::optional<std::uint64_t> address_space_left();

}  // namespace aspic

#pragma once
// What the processor does at best: the bounds in docs/performance.md.
#include <cstddef>

namespace aspic::bench {

enum class Operation { add, multiply, fused, root, quotient, reciprocal_root };

/// Applies an operation to `rounds` times eight independent vectors of single-precision numbers in registers;
/// returns how many numbers that were. The instruction set is the best that Highway
/// supports at the time.
std::size_t repeat(Operation operation, std::size_t rounds);

}  // namespace aspic::bench

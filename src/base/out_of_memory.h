#pragma once
// What becomes of a computation for which there is no memory.
#include <new>

namespace aspic {

/// The result of `compute`, or where it runs out of memory that of `otherwise`. A program that is compiled
/// without exceptions, as for browsers, ends there instead.
template <class Compute, class Otherwise>
auto unless_out_of_memory(const Compute& compute, [[maybe_unused]] const Otherwise& otherwise)
    -> decltype(compute()) {
#ifdef __cpp_exceptions
  try {
    return compute();
  } catch (const std::bad_alloc&) {
    return otherwise();
  }
#else
  return compute();
#endif
}

}  // namespace aspic

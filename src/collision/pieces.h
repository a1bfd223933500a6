#pragma once
// Work that may be shared out among threads.
#include <algorithm>
#include <cstddef>

namespace aspic::collision {

/// Tasks one after the other: run(count, task) calls task(n) for n below count; others do so on many threads,
/// in any order.
inline constexpr auto one_by_one = [](std::size_t count, const auto& task) {
  for (std::size_t n = 0; n < count; ++n) task(n);
};

/// Calls use(n) for n below `count`, so many to a task.
template <class Run, class Use>
void run_pieces(std::size_t count, std::size_t size, const Run& run, const Use& use) {
  run((count + size - 1) / size, [&](std::size_t piece) {
    for (std::size_t n = piece * size; n < std::min(count, (piece + 1) * size); ++n) use(n);
  });
}

}  // namespace aspic::collision

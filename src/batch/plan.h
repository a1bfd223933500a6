#pragma once
// Which instances of a batch are stepped together, and by which thread.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "batch/unit.h"

namespace aspic::batch {

/// Where an instance is.
struct Place {
  std::size_t unit = 0, slot = 0;
};

struct Plan {
  std::vector<std::unique_ptr<Unit>> units;  ///< those that take longest first
  std::vector<Place> places;                 ///< by instance
  std::uint64_t shared_bytes = 0;            ///< of what units share
};

/// Models that may be in one stack are put into stacks where that is faster on so many threads. A model alone
/// whose step is so long that the other threads would wait for it in the end has helpers. Error
/// (scene_rejected): no memory.
Result<Plan> make_units(const std::vector<SharedModel>& models, unsigned threads);

/// Calls act with the number of every unit, on all threads, in their order; who finds none left helps those
/// that are at work. Returns the first error, in the order of units.
Status for_each_unit(parallel::Workers& pool, const std::vector<std::unique_ptr<Unit>>& units,
                     const std::function<Status(std::size_t)>& act);

}  // namespace aspic::batch

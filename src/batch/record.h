#pragma once
// The arrays of a recorded run of a batch.
#include <atomic>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "aspic/analysis.h"
#include "aspic/batch.h"
#include "batch/unit.h"

namespace aspic::batch {

/// In place of an instance: the slot's has gone.
inline constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();

class Recording {
 public:
  /// Errors: those of Batch::run().
  static Result<Recording> plan(const std::vector<SharedModel>& models, double duration, double interval,
                                const BatchQuantities& quantities);

  /// Advances a unit to the end and writes the rows of its instances, which `instances` has by slot. Units
  /// may be taken at the same time by several threads. Ends early where `*flag` is true.
  Status take(Unit& unit, std::span<const std::size_t> instances, const std::atomic<bool>* flag);
  /// When all are taken.
  BatchRecord record() && { return std::move(record_); }

 private:
  void write(const Unit& unit, std::size_t slot, std::size_t instance, std::size_t row);

  BatchRecord record_;
  BatchQuantities quantities_;
  std::vector<Meter> meters_;         ///< of each instance, where energies are recorded
  std::vector<ActuatorWork> works_;   ///< of each instance, where they are recorded
  std::vector<double> times_;         ///< from the start [s]
  std::vector<std::uint32_t> first_;  ///< of each instance's body whose positions are recorded
};

}  // namespace aspic::batch

#pragma once
// Which time steps and stiffnesses are stable for a scene, measured in the background.
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "aspic/scene.h"
#include "playback/worker.h"

namespace aspic {

/// What is known of a cell of the map.
enum class Stability : char { unknown, stable, unstable };

/// A map of time steps by stiffnesses.
struct StabilityCells {
  std::vector<double> steps, stiffness;  ///< centers of cells [s], [N/m], ascending in constant ratios
  std::vector<double> limit;             ///< largest stable step in theory for each stiffness [s]; 0: none
  std::vector<Stability> cells;          ///< row by row from the lowest stiffness

  /// The cell nearest to a time step and a stiffness; nothing outside the map.
  std::optional<std::size_t> cell_at(double step, double stiffness) const;
};

/// All calls from one thread.
class StabilityMap {
 public:
  /// Once for each image that shows it: measures again where the scene is another but for its time step and
  /// stiffness, or where these have left the map. Fewer than 20,000 particles are run; of more there is
  /// theory alone.
  void update(const Scene& scene);

  /// Of the scene last updated; null where it has no springs with a separate stiffness.
  const StabilityCells* cells() const { return map_.steps.empty() ? nullptr : &map_; }
  /// Where the scene is on it.
  double step() const { return step_; }
  double stiffness() const { return stiffness_; }
  /// Cells are still being measured.
  bool busy() const { return worker_.busy(); }

 private:
  struct News {
    std::size_t generation = 0;
    StabilityCells map;  ///< with what is known so far
  };
  void begin(const Scene& scene);

  StabilityCells map_;
  double step_ = 0.0, stiffness_ = 0.0;
  std::string text_, key_;  ///< of the scene last seen; what of it the map depends on
  std::size_t generation_ = 0;
  Mailbox<News> news_;
  Worker worker_;  // goes first
};

}  // namespace aspic

#pragma once
// The energy of a run, against what it had and the most that inputs, actuators and moving terrain can add.
//
// E is the energy in motion and in springs, pulls included. Between two looks √E rises by at most
//   √(½ Σ k·Δr²)                     for rest lengths that change by Δr, since √(½ Σ k·s²) is a norm of s;
//   √(½k)·|Δa|                       for the anchor of a pull that moves by Δa;
//   √(½ Σ k)·|Δo|                    for terrain that moves by Δo and the springs of what it can touch;
//   √(½ Σ m)·(|V₀| + Σ|ΔV| + |V₁|)   for the velocities V of terrain and the masses of what it can touch.
// S is their sum. The terrain also does F = Σ m·|g|·|Δo| on weights and ¼ Σ c·|Δo|²/h on dampers, which see
// neither rest lengths nor anchors. Gravity raises √E by G = |g|·t·√(½M) from potential energy. So the total
// energy rises by at most
//   F + (R + S)² − R²,   R = √(E + F) + G.
// What terrain can touch is what it can at either look; both are added.
#include <cstdint>
#include <optional>
#include <vector>

#include "aspic/analysis.h"
#include "aspic/inputs.h"
#include "aspic/state.h"
#include "model/model.h"

namespace aspic {

/// Energy that nothing accounts for.
struct EnergyRise {
  double total = 0.0, excess = 0.0;  ///< [J]
  std::uint64_t since = 0;           ///< the step with which the state was compared
  bool driven = false;               ///< something did work since
};

class EnergyWatch {
 public:
  /// The model must outlive it. `interval`: between looks as a rule [s].
  EnergyWatch(const Model& model, double interval);

  /// Compares later states with this one.
  void begin(const State& state, const InputLog& inputs);
  /// Compares a state with those before; begins with the first and where time went back. `inputs`: of all
  /// steps since the last one, and of the next. Nothing: it has no more energy than it can have.
  std::optional<EnergyRise> look(const State& state, const InputLog& inputs);

 private:
  /// What a moving terrain can touch: stiffness [N/m], damping [N·s/m] and mass [kg].
  struct Reach {
    double stiffness = 0.0, damping = 0.0, mass = 0.0;
  };
  struct Energy {
    std::uint64_t step = 0;
    double total = 0.0, moving = 0.0;  // with pulls; E alone [J]
    std::vector<Reach> reach;          // by terrain
  };
  struct Work;

  Energy energy(const State& state, const InputLog& inputs);
  Reach reach(const Terrain& terrain, const State& state) const;
  Work work(const Energy& from, const Energy& to, const InputLog& inputs) const;

  const Model& model_;
  double interval_;
  bool driven_;        // by actuators or terrain
  double mass_ = 0.0;  // of everything [kg]
  Reach all_;          // of every spring and particle
  std::optional<Meter> meter_;
  std::optional<Energy> last_;
  double base_ = 0.0;  // what it may have without further work [J]
  std::uint64_t base_step_ = 0;
};

}  // namespace aspic

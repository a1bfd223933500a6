#pragma once
// Whether a run has more energy than it had and than inputs, actuators and moving terrain can have added.
//
// E is the energy in motion and in springs, those of pulls included. Three things bound the work W between
// two looks:
// - Actuators that change rest lengths by Δr raise √E by √(½ Σ k·Δr²) at most, since √(½ Σ k·s²) is a norm of
//   the stretches s. A pull whose anchor moves by Δa raises it by √(½k)·|Δa|. Dampers do not see either.
// - Terrain that moves by Δo shifts the ends of the springs that it touches, which raises √E by √(½ Σ
// k)·|Δo|.
//   It also does |g|·m·|Δo| on the weight of what it touches, ¼c·|Δo|²/h on each damper in a step, and
//   with its own velocity V it raises √E by √(½ Σ m)·(|V| at both ends and all |ΔV| between).
// - Gravity raises √E by |g|·√(½M)·t = G. It does so with potential energy and adds nothing to W.
// A sum S of the raises gives W = (√E + G + S)² − (√E + G)².
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

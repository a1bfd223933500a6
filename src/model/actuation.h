#pragma once
// Rest lengths that follow signals (docs/actuation.md). What an actuated model holds: which spring classes
// have such lengths, and what they are at a time. Every backend takes the numbers from rest_lengths(), in
// double precision, rounded once; no kernel computes a signal.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "aspic/settings.h"

namespace aspic {

struct Model;

/// An actuator's law, without what it acts on.
struct Actuator {
  std::string name;  ///< for people: its own, or `actuator[0]`
  BodyAxis axis = BodyAxis::none;
  double amplitude = 0.0;  ///< a
  Signal signal = Signal::sine;
  double frequency = 0.0;  ///< f [Hz]
  SignalTable table = {};
  double start = 0.0, ramp = 0.0;  ///< [s]
  std::uint32_t channel = 0;       ///< of the inputs; of Signal::input
};

/// An actuator at a phase, which makes one number w at a time.
struct Drive {
  std::uint32_t actuator = 0;
  double phase = 0.0;  ///< φ [cycles]
};

/// What acts on some cells alike: their stretch along each axis is 1 + Σ a·w of these drives.
struct CellStretch {
  std::vector<std::uint32_t> drives;  ///< ascending

  friend bool operator==(const CellStretch&, const CellStretch&) = default;
};

/// Of a spring's stiffness, the share that is that of cells which stretch alike.
struct StretchShare {
  std::uint32_t stretch = 0;
  double share = 0.0;  ///< 0 … 1
};

/// A spring class whose rest length changes: r = r₀·(1 + Σ share·e), with e = λ − 1 where the cells stretch
/// by λ every way, and else e = √(1 + Σ nᵢ²·(λᵢ² − 1)) − 1 of a spring in the direction n.
struct ActuatedClass {
  std::uint32_t spring_class = 0;
  std::array<double, 3> squares = {};  ///< nᵢ²; of no account where all cells stretch every way alike
  std::uint32_t first_share = 0, share_count = 0;
};

/// Model::actuation; empty in most.
struct Actuation {
  std::vector<Actuator> actuators;  ///< in file order
  std::vector<Drive> drives;        ///< ascending by actuator
  std::vector<CellStretch> stretches;
  std::vector<StretchShare> shares;
  std::vector<ActuatedClass> classes;  ///< ascending by class
  std::uint32_t channels = 0;          ///< that it reads: actuators with Signal::input, in file order

  bool empty() const { return classes.empty(); }
  std::uint64_t bytes() const;  ///< on the heap
};

/// Whether both have the same drives and the same springs follow them: all but constants.
bool same_structure(const Actuation& a, const Actuation& b);

/// Least stretch λ of a cell: less counts as this, whatever signals say.
inline constexpr double least_stretch = 0.01;

/// sin 2πu, within two units of 1e-16, by + − × alone and so the same on every machine.
double sine_of_turns(double u);

/// w of an actuator's drive `time` [s] after the start of a run; `channel`: its number in the inputs.
double signal_at(const Actuator& actuator, double phase, double time, double channel);

/// Rest lengths of a model's actuated classes at one time after another. Holds its results, so that none
/// needs memory.
class RestLengths {
 public:
  /// Of the model, which must outlive it.
  explicit RestLengths(const Model& model);
  /// By Actuation::classes [m], at the time step·h + share·h. `channels`: Inputs::channels, which hold for
  /// that step; those that are missing are 0.
  std::span<const double> at(std::uint64_t step, double share, std::span<const double> channels);
  /// w by drive, as of the last at().
  std::span<const double> signals() const { return signals_; }

 private:
  struct Cells {
    std::array<double, 3> e = {};  // λ − 1 along each axis
    bool same = true;              // every way
  };
  const Model* model_;
  std::vector<double> signals_;
  std::vector<Cells> cells_;
  std::vector<double> lengths_;
};

/// Rest lengths of all the model's spring classes at the time step·h + share·h [m].
std::vector<double> rest_lengths(const Model& model, std::uint64_t step, double share,
                                 std::span<const double> channels);

/// By spring class, the least rest length that its signals let it have, and the most [m]; of inputs w is −1
/// … 1.
struct LengthRange {
  double least = 0.0, most = 0.0;
};
std::vector<LengthRange> rest_length_ranges(const Model& model);

}  // namespace aspic

#pragma once
// Inputs: what acts on a run from outside and may change from step to step, the same on every backend.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "aspic/export.h"
#include "aspic/vec.h"

namespace aspic {

/// A damped spring of rest length 0 from a particle to a fixed anchor, as a hand pulls at the jelly. Its
/// force is that of a spring (docs/physics.md, section 1) whose other end rests at the anchor,
///   e = x − anchor,  f = −[k·|e| + c(v·e)/|e|]·e/|e|,
/// nothing where e = 0, and is added to the particle's sum after its springs and before contact. On a ball it
/// acts at the center, is added to gravity, and is that of the step's start throughout the step, since balls
/// fly under a constant force (docs/balls.md).
struct Pull {
  std::uint32_t particle = 0;  ///< global index, of a ball where `ball`; a pinned particle feels it and stays
  Vec3 anchor;                 ///< [m]
  double stiffness = 0.0;      ///< k [N/m], ≥ 0
  double damping = 0.0;        ///< c [N·s/m], ≥ 0
  bool ball = false;           ///< pulls a ball instead of a particle

  friend bool operator==(const Pull&, const Pull&) = default;
};

/// Inputs at most: what a solver's tables have room for.
inline constexpr std::size_t most_pulls = 256;
inline constexpr std::size_t most_channels = 65536;  ///< numbers

/// Valid from the beginning of a step until others take their place. A step's result depends on its inputs
/// alone, not on those before.
struct Inputs {
  /// Added in this order, several to one particle or ball too. At most most_pulls.
  std::vector<Pull> pulls = {};
  /// Particles that are pinned where they are, in addition to the scene's: like every pinned particle, one
  /// that moves stops at the beginning of the step. Global indices, each once.
  std::vector<std::uint32_t> pinned = {};
  /// Particles that the scene pins and that are free: w = 1/m. Global indices, each once, none of `pinned`.
  std::vector<std::uint32_t> released = {};
  /// Numbers by channel: signals w of the actuators with Signal::input, in the order of input_names()
  /// (aspic/model.h). Those that are missing are 0; more than a scene with actuators reads are refused. At
  /// most most_channels.
  std::vector<double> channels = {};

  /// Whether nothing acts.
  bool empty() const { return pulls.empty() && pinned.empty() && released.empty() && channels.empty(); }
  /// Whether particles are pinned and released by equal lists, whose order counts.
  bool same_pins(const Inputs& other) const { return pinned == other.pinned && released == other.released; }
  friend bool operator==(const Inputs&, const Inputs&) = default;
};

/// The step nearest to the time of `step` when the time step changes from `from` to `to` [s]; 2⁵³ at most.
ASPIC_API std::uint64_t step_at_same_time(std::uint64_t step, double from, double to);

/// The inputs of one hand; nothing: none.
ASPIC_API Inputs inputs_of(const std::optional<Pull>& hand);

/// The inputs of a run by step: with them it repeats to the bit. Plain data: one thread changes it, or
/// several read.
class ASPIC_API InputLog {
 public:
  /// Inputs, and the step they begin at.
  struct Entry {
    std::uint64_t step = 0;  ///< valid from the step that begins with the state of this number
    Inputs inputs;           ///< until the next entry
    friend bool operator==(const Entry&, const Entry&) = default;
  };

  /// Before the first entry there are no inputs.
  bool empty() const { return entries_.empty(); }
  /// Ascending; neighbors differ.
  std::span<const Entry> entries() const { return entries_; }
  /// Inputs from this step on; those of this step and later ones are forgotten.
  void set(std::uint64_t step, Inputs inputs);
  /// Forgets all from this step on.
  void forget_from(std::uint64_t step);
  /// Those of the step that begins with the state of this number.
  const Inputs& at(std::uint64_t step) const;
  /// The first step after this one with other inputs.
  std::optional<std::uint64_t> next_change(std::uint64_t step) const;
  /// The same inputs in a run with another time step: each from step_at_same_time() on. Both [s].
  InputLog with_timestep(double from, double to) const;
  /// 64-bit FNV-1a of all entries; the same for equal logs only, so far as hashes go.
  std::uint64_t hash() const;
  std::string hash_text() const;  ///< hash() as 16 lower-case hexadecimal digits
  /// Bytes it holds on the heap.
  std::uint64_t bytes() const;

  friend bool operator==(const InputLog&, const InputLog&) = default;

 private:
  std::vector<Entry> entries_;
};

}  // namespace aspic

#pragma once
// What a state is worth: energies and extremes in double precision whatever the state's own, differences of
// two states, and the largest stable time step.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/error.h"
#include "aspic/export.h"
#include "aspic/inputs.h"
#include "aspic/model.h"
#include "aspic/state.h"

namespace aspic {

/// What a series row holds of one state.
struct Measures {
  double kinetic = 0.0;  ///< Σ ½ m v², of balls also ½ I ω² [J]
  /// Springs: Σ ½ k (L − r)² with r at the state's time; contact: Σ ½ k (ρ − d)² [J].
  double elastic = 0.0;
  std::optional<double> contact;     ///< of it, the energy of contact [J]; absent without contact of bodies
  double gravitational = 0.0;        ///< −Σ m g·x [J], zero at the origin
  std::optional<double> drag_power;  ///< [W] that drag dissipates, Σ γ m v²; nothing without drag
  Vec3 momentum;                     ///< Σ m v [N·s]
  double max_speed = 0.0;            ///< [m/s]
  double min_height = 0.0;           ///< lowest y of all particles and balls' centers [m]; 0 without any

  ASPIC_API double total() const;  ///< kinetic, elastic and gravitational [J]
};

/// The first figure that is not finite, in words such as `the kinetic energy`; nothing if all are.
ASPIC_API std::optional<std::string_view> first_not_finite(const Measures& measures);

/// Measures a state of the model, which has its numbers of particles and balls. Pinned particles count for
/// potential energies and height, and balls once launched. `inputs`: those that hold, for actuators.
ASPIC_API Measures measure(const Model& model, const State& state, const Inputs& inputs = {});
/// The same without elastic energy, which stays 0: looks at neither springs nor contacts.
ASPIC_API Measures measure_motion(const Model& model, const State& state);

/// Measures states of one model, with one search for contacts for all of them, where measure() makes one for
/// each. Calls may come from any thread, one at a time.
class ASPIC_API Meter {
 public:
  explicit Meter(const Model& model);  ///< which must outlive it
  Meter(Meter&&) noexcept;
  ~Meter();
  Measures measure(const State& state, const Inputs& inputs = {});  ///< as the function does

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The work of actuators over a run, added up from its states [J]: −∫ Σ k(L − r) dr by the trapezoidal rule
/// from each state to the next, with the rest lengths that measure() takes; exact where lengths hold still,
/// else its error is of second order in the time between. Calls may come from any thread, one at a time.
class ASPIC_API ActuatorWork {
 public:
  /// The work from the first state that was added to this one, the next of the run; negative where springs
  /// drive signals. Nothing without actuators. Where `model` has other constants than before, their change
  /// counts; where it has other actuated classes, nothing is added. The rest as for measure().
  std::optional<double> add(const Model& model, const State& state, const Inputs& inputs = {});
  /// Appends what a work of one state alone holds, the next of the run: states may be measured apart, on any
  /// thread, and added up in their order later. The rest as for add(); nothing where `next` has no state.
  std::optional<double> append(const ActuatorWork& next);

 private:
  struct Load {
    double length, pull;  // of a class: r [m], Σ k(L − r) [N]
  };
  std::vector<Load> before_;
  double sum_ = 0.0;
};

/// What springs would hold at the largest |w| of their signals, the body kept as at rest [J]; 0 without any.
ASPIC_API double largest_actuation_energy(const Model& model);

/// What particles and springs do in a state, in double precision whatever its own. By particle:
struct StateQuantities {
  std::vector<double> speed;           ///< |v| [m/s]
  std::vector<double> mean_strain;     ///< mean |L/r − 1| of its springs, as images show it; 0 without any
  std::vector<double> mean_actuation;  ///< mean r/r₀ − 1 of its springs; empty without actuators
  std::vector<Vec3> force;             ///< net, with contact [N]: zero at rest, and of pinned particles
  std::vector<Vec3> contact_force;     ///< of terrain and bodies [N]; a bounce is an impulse, in no state
  std::vector<std::uint8_t> contact;   ///< 1: it touches terrain or a body; of pinned particles 0
  /// L/r − 1 by spring, in the order of spring_facts(), with the rest length r that it has at the time; 0
  /// where r = 0
  std::vector<double> strain;
  /// r/r₀ − 1 by spring: how far actuators have moved its rest length; empty without any
  std::vector<double> actuation;
  std::vector<double> tension;  ///< k(L − r) + c·dL/dt [N], positive where it pulls; 0 of a slack cord
};
/// `state` has the model's numbers of particles and balls; `inputs` are Solver::inputs().
ASPIC_API StateQuantities quantities_of(const Model& model, const State& state, const Inputs& inputs = {});

/// The largest differences in one quantity. With no difference all members are 0.
struct QuantityDifference {
  double absolute = 0.0;             ///< largest |a − b| of any component, in the quantity's unit
  std::uint32_t absolute_index = 0;  ///< the particle or ball it was found at, the lowest if several
  std::uint64_t ulp = 0;             ///< largest distance of any component in units in the last place
  std::uint32_t ulp_index = 0;       ///< where, as absolute_index
};

/// Where two states differ most, by quantity.
struct StateDifference {
  QuantityDifference position;                                             ///< [m]
  QuantityDifference velocity;                                             ///< [m/s]
  QuantityDifference ball_position, ball_velocity, ball_angular_velocity;  ///< [m], [m/s], [rad/s]

  /// Whether every bit is the same: −0 and +0 differ.
  bool identical() const { return largest_ulp() == 0; }
  /// Of all five quantities.
  std::uint64_t largest_ulp() const {
    return std::max(
        {position.ulp, velocity.ulp, ball_position.ulp, ball_velocity.ulp, ball_angular_velocity.ulp});
  }
  /// Of all five, whatever their units.
  double largest_absolute() const {
    return std::max({position.absolute, velocity.absolute, ball_position.absolute, ball_velocity.absolute,
                     ball_angular_velocity.absolute});
  }
};

/// Compares component by component. ULPs are counted in the states' own precision; where the two differ, in
/// single precision, to which the other is rounded. Error (usage): another number of particles or balls.
ASPIC_API Result<StateDifference> compare_states(const State& a, const State& b);

/// Steps from one representable number to the other; −0 and +0 are one step apart. Finite numbers only.
ASPIC_API std::uint64_t ulp_distance(float a, float b);
ASPIC_API std::uint64_t ulp_distance(double a, double b);

/// A stable step.
struct StabilityLimit {
  /// Largest stable h [s]; infinite when nothing limits it (implicit Euler, no springs); nothing when some
  /// mode grows at any step (undamped springs under explicit Euler or midpoint).
  std::optional<double> step;
  /// False: the true limit is this or larger.
  bool exact = true;
};

/// How much time the estimate may take.
enum class StabilityEffort {
  quick,    ///< milliseconds for a thousand particles: before every run
  thorough  ///< dense solves of bodies with up to 600 degrees of freedom: for reports
};

/// Called now and then on the caller's thread with the share of the work that is done at most; false ends
/// the work, and what it had not reached is bounded instead.
using StabilityWatch = std::function<bool(double)>;

/// The smallest limit of all bodies, springs linearized at rest: exact, or a bound that the true limit is not
/// below (src/analysis/stability.h). 0, not exact: k/m is beyond double precision.
ASPIC_API StabilityLimit stability_limit(const Model& model, Integrator integrator,
                                         StabilityEffort effort = StabilityEffort::thorough,
                                         const StabilityWatch& watch = {});

/// The limits of several integrators, sharing what they have in common; in the order of `integrators`.
ASPIC_API std::vector<StabilityLimit> stability_limits(const Model& model,
                                                       std::span<const Integrator> integrators,
                                                       StabilityEffort effort = StabilityEffort::thorough,
                                                       const StabilityWatch& watch = {});

/// A sentence where the time step is above the estimated largest stable one (of effort quick); else empty.
ASPIC_API std::string unstable_step_warning(const Model& model, const StabilityWatch& watch = {});

}  // namespace aspic

#pragma once
// What contact between bodies means for a model's users (docs/contact.md): constants of its pairs, speeds and
// heights up to which it holds, and the time steps that are stable while bodies touch.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "aspic/analysis.h"
#include "model/contact_surface.h"
#include "model/model.h"

namespace aspic {

/// Bodies whose contacts have the same constants.
struct ContactKind {
  std::vector<std::uint32_t> bodies;  ///< indices in Model::bodies, ascending
  ContactBody body;                   ///< constants of each
  double sound = 0.0;                 ///< speed of sound c₀ = s·√(E·s/m) [m/s]
  bool damped = false;                ///< its springs are, c ≥ 0.9·√(k·m)
  bool thin = false;                  ///< it has an inside, and is one cell thick somewhere
  /// How high a stack of boxes may be before it leans over by its own weight: 0.8 of Greenhill's height [m].
  /// Nothing for other bodies, and without gravity.
  std::optional<double> stack;

  /// Of its speed of sound, up to which it is turned back by what is as heavy.
  double share() const { return !damped ? 0.3 : thin ? 0.5 : 0.9; }
};

/// Points of either of two kinds, or of one body, with the faces of the other.
struct ContactPairing {
  std::size_t a = 0, b = 0;  ///< kinds, a ≤ b
  bool self = false;         ///< a body with itself
  ContactPair pair;          ///< of two closed bodies; of others the smaller ρ
  double sound_speed = 0.0;  ///< up to which nothing passes, by the speed of sound [m/s]
  double step_speed = 0.0;   ///< the same, by the way in a step [m/s]
  double sheet_speed = 0.0;  ///< the same, by the energy that contact with an open surface holds [m/s]
  double least_zeta = 0.0;   ///< ζ below which explicit Euler gains energy in an impact: hω/2

  double speed() const { return std::min({sound_speed, step_speed, sheet_speed}); }
};

struct ContactFacts {
  std::vector<ContactKind> kinds;        ///< in the order of their first bodies
  std::vector<ContactPairing> pairings;  ///< those that may touch
};
/// Nothing at all of a model whose bodies cannot touch.
ContactFacts contact_facts(const Model& model);

/// How bodies lie on each other: contact adds 4·k·w of its stiffness k to an eigenvalue where flat faces
/// meet, and 12·k·w where sharp edges lie on each other.
enum class Meeting { faces, edges };

/// The largest stable steps while bodies touch, of which each is at least that, in the order of
/// `integrators`; as stability_limits().
std::vector<StabilityLimit> contact_limits(const Model& model, std::span<const Integrator> integrators,
                                           Meeting meeting, StabilityEffort effort,
                                           const StabilityWatch& watch = {});

}  // namespace aspic

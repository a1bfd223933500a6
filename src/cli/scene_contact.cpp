#include "cli/scene_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "analysis/body_overlap.h"
#include "analysis/stability.h"
#include "aspic/run.h"
#include "model/integrator.h"
#include "scene/follow.h"

namespace aspic::cli {
namespace {

/// Pairs of kinds that are printed.
constexpr std::size_t most_pairings = 8;

/// "cube[0]", "cube[0], cube[2]", "28 bodies, cube[0] to cube[27]".
std::string names_of(const ContactKind& kind, const std::vector<std::string>& names) {
  const std::vector<std::uint32_t>& b = kind.bodies;
  if (b.size() > 3)
    return fmt::format("{} bodies, {} {} {}", b.size(), names[b.front()],
                       b.back() - b.front() + 1 == b.size() ? "to" : "…", names[b.back()]);
  std::string text;
  for (const std::uint32_t each : b) text += (text.empty() ? "" : ", ") + names[each];
  return text;
}

std::string pairing_name(const ContactPairing& pairing, const ContactFacts& facts,
                         const std::vector<std::string>& names) {
  const std::string a = names_of(facts.kinds[pairing.a], names);
  if (pairing.self)
    return a + (facts.kinds[pairing.a].bodies.size() > 1 ? " with themselves" : " with itself");
  if (pairing.a == pairing.b) return a;
  return fmt::format("{} with {}", a, names_of(facts.kinds[pairing.b], names));
}

/// Up to where nothing passes, and why.
std::string speed_text(const ContactPairing& pairing, const ContactFacts& facts) {
  const std::string upto = fmt::format("no penetration below {:.3g} m/s, ", pairing.speed());
  if (pairing.speed() == pairing.step_speed) return upto + "limited by the distance per step";
  if (pairing.speed() == pairing.sheet_speed) return upto + "limited by the normal force of a sheet";
  const ContactKind &a = facts.kinds[pairing.a], &b = facts.kinds[pairing.b];
  const ContactKind& slower = a.share() * a.sound <= b.share() * b.sound ? a : b;
  return upto + fmt::format("{:.2g} of the speed of sound {:.3g} m/s", pairing.sound_speed / slower.sound,
                            slower.sound);
}

std::vector<std::string> body_names(const Scene& scene) {
  return followable(scene.model, 0);
}

/// ζ of pushes below which explicit Euler gains energy in an impact, the largest of all pairs; 0 with other
/// methods.
double least_zeta(const Model& model, const ContactFacts& facts) {
  double least = 0.0;
  if (model.simulation.integrator == Integrator::explicit_euler)
    for (const ContactPairing& pairing : facts.pairings) least = std::max(least, pairing.least_zeta);
  return least;
}

}  // namespace

std::string contact_text(const Scene& scene, const Model& model, const ContactFacts& facts) {
  std::string text;
  const auto line = [&](const std::string& words) { text += fmt::format("contact      {}\n", words); };
  const std::vector<std::string> names = body_names(scene);
  for (std::size_t n = 0; n < std::min(facts.pairings.size(), most_pairings); ++n) {
    const ContactPairing& pairing = facts.pairings[n];
    const ContactPair& pair = pairing.pair;
    line(fmt::format("{}: k {:.4g} N/m, c {:.4g} N·s/m, ρ {:.3g} m, D {:.3g} m, μ {:g}; {}",
                     pairing_name(pairing, facts, names), pair.stiffness,
                     row_of(model.simulation.integrator).staged() ? pair.damping : 0.0, pair.reach,
                     pair.depth, pair.friction, speed_text(pairing, facts)));
  }
  if (facts.pairings.size() > most_pairings)
    line(fmt::format("and {} more pairs of kinds", facts.pairings.size() - most_pairings));
  for (const ContactKind& kind : facts.kinds)
    if (kind.stack && model.contact.bodies)
      line(
          fmt::format("{}: a stack of these is stable up to {:.3g} m\n", names_of(kind, names), *kind.stack));
  return text;
}

Json contact_json(const Scene& scene, const Model& model, const ContactFacts& facts,
                  const ContactLimits& limits) {
  if (facts.pairings.empty()) return {};
  const std::vector<std::string> names = body_names(scene);
  const auto named = [&](const ContactKind& kind) {
    Json all = Json::array();
    for (const std::uint32_t b : kind.bodies) all.push_back(names[b]);
    return all;
  };
  Json kinds = Json::array(), pairs = Json::array(), steps = Json::object(), overlaps = Json::array();
  for (const ContactKind& kind : facts.kinds) {
    Json made = {{"bodies", named(kind)}, {"speed_of_sound", kind.sound}, {"damped", kind.damped}};
    made["stack"] = kind.stack ? Json(*kind.stack) : Json();
    kinds.push_back(std::move(made));
  }
  for (const ContactPairing& pairing : facts.pairings)
    pairs.push_back({{"kinds", Json{pairing.a, pairing.b}},
                     {"self", pairing.self},
                     {"stiffness", pairing.pair.stiffness},
                     {"damping", pairing.pair.damping},
                     {"gap", pairing.pair.reach},
                     {"depth", pairing.pair.depth},
                     {"friction", pairing.pair.friction},
                     {"speed", pairing.speed()}});
  for (std::size_t i = 0; i < limits.faces.size(); ++i)
    steps[std::string(name_of(explicit_integrators[i]))] = {{"faces", limits.faces[i].step.value_or(0.0)},
                                                            {"edges", limits.edges[i].step.value_or(0.0)}};
  for (const BodyOverlap& each : overlaps_of(model, initial_state(model, Precision::double_)))
    overlaps.push_back({{"bodies", Json{names[each.a], names[each.b]}},
                        {"deepest", each.deepest},
                        {"energy", each.energy},
                        {"too_deep", each.locked()}});
  return {{"kinds", kinds}, {"pairs", pairs}, {"stable_steps", steps}, {"overlaps", overlaps}};
}

std::vector<std::string> contact_warnings(const Model& model, const ContactFacts& facts,
                                          const ContactLimits& limits) {
  std::vector<std::string> warnings;
  const SimulationSettings& simulation = model.simulation;
  if (const double zeta = least_zeta(model, facts); zeta > model.contact.body_damping)
    warnings.push_back(fmt::format(
        "impacts of bodies gain energy under explicit-euler: contact.body-damping is {:g}, and this time "
        "step needs {:.2g}. Raise it, lower simulation.timestep, or use symplectic-euler.",
        model.contact.body_damping, zeta));
  const auto at = std::ranges::find(explicit_integrators, simulation.integrator);
  if (at == std::end(explicit_integrators) || limits.faces.empty()) return warnings;
  const StabilityLimit& limit = limits.faces[static_cast<std::size_t>(at - std::begin(explicit_integrators))];
  if (exceeds(simulation.timestep, limit))
    warnings.push_back(fmt::format("during contact of bodies, {}",
                                   unstable_sentence(simulation.timestep, simulation.integrator, limit)));
  return warnings;
}

}  // namespace aspic::cli

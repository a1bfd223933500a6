#include "analysis/contact_facts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/integrator.h"

namespace aspic {
namespace {

/// c₀ = s·√(E·s/m), where E·s is κ.
double sound_of(const ContactBody& body) {
  return body.spacing * std::sqrt(body.stiffness / body.mass);
}

/// 0.8 of (7.84·c₀²·i²/g)^⅓, with i² = s²(n² − 1)/12 of the narrower of a box's horizontal edges (Greenhill,
/// 1881: a column that bends under its own weight).
std::optional<double> stack_of(const Model& model, const Body& body, const ContactBody& contact) {
  const double g = length(model.simulation.gravity);
  if (!body.box() || !(g > 0.0)) return std::nullopt;
  const double n = std::min(body.box()->particles[0], body.box()->particles[2]);
  const double sound = sound_of(contact),
               i_squared = contact.spacing * contact.spacing * (n * n - 1.0) / 12.0;
  return 0.8 * std::cbrt(7.84 * sound * sound * i_squared / g);
}

/// Whether a full cell has no full one at either of two opposite faces.
bool one_cell_thick(const Body& body) {
  if (!body.lattice) return false;
  if (const Lattice* const box = body.box())
    return std::ranges::min(box->particles) == 2 && body.style == SurfaceStyle::flesh;
  const Lattice& lattice = *body.lattice;
  const auto alone = [&](Lattice::Place cell, std::size_t axis) {
    Lattice::Place before = cell, after = cell;
    --before[axis];
    ++after[axis];
    return lattice.full(cell) && !lattice.full(before) && !lattice.full(after);
  };
  for (std::size_t n = 0; n < lattice.points(); ++n)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (alone(lattice.place(n), axis)) return true;
  return false;
}

/// Share of the speed at which a point alone has all energy that contact with a sheet can hold: that of a
/// point with masses behind it.
constexpr double sheet_share = 0.9;

ContactPairing pairing_of(const Model& model, const ContactFacts& facts, std::size_t a, std::size_t b,
                          bool self) {
  const ContactKind &one = facts.kinds[a], &other = facts.kinds[b];
  const double h = model.simulation.timestep;
  ContactPairing made = {a, b, self, contact_pair(model.contact, one.body, other.body, self)};
  made.sheet_speed = std::numeric_limits<double>::infinity();
  // An open surface exerts no force on points that have passed its reach.
  double way = 0.5 * made.pair.spacing;
  if (!row_of(model.simulation.integrator).staged()) way = 0.3 * made.pair.spacing;
  for (const auto& [points, faces] : {std::pair(&one, &other), std::pair(&other, &one)}) {
    const ContactPair pair = contact_pair(model.contact, points->body, faces->body, self);
    if (!faces->body.closed) {
      way = std::min(way, pair.reach);
      // ½·m·v² against ½·k·reach²; other points of the body load this one.
      made.sheet_speed = std::min(made.sheet_speed,
                                  sheet_share * pair.reach * std::sqrt(pair.stiffness / points->body.mass));
    }
    made.pair.reach = std::min(made.pair.reach, pair.reach);
  }
  made.step_speed = way / h;
  const auto [light, heavy] = std::minmax(one.body.mass, other.body.mass);
  made.sound_speed =
      (heavy > 2.0 * light ? 0.8 : 1.0) * std::min(one.share() * one.sound, other.share() * other.sound);
  const double omega = std::sqrt(made.pair.stiffness * (1.0 / one.body.mass + 1.0 / other.body.mass));
  made.least_zeta = 0.5 * h * omega;
  return made;
}

}  // namespace

ContactFacts contact_facts(const Model& model) {
  ContactFacts facts;
  if (!has_body_contact(model)) return facts;
  const ContactSurfaces surfaces = contact_surfaces(model);
  for (const ContactBody& body : surfaces.bodies) {
    const std::optional<double> stack = stack_of(model, model.bodies[body.body], body);
    const bool thin = body.closed && one_cell_thick(model.bodies[body.body]);
    const auto same = [&](const ContactKind& kind) {
      return kind.body.alike(body) && kind.body.damping == body.damping && kind.stack == stack &&
             kind.thin == thin;
    };
    auto kind = std::ranges::find_if(facts.kinds, same);
    if (kind == facts.kinds.end()) {
      const double k = body.stiffness / lattice_stiffness_share;
      facts.kinds.push_back(
          {{}, body, sound_of(body), body.damping >= 0.9 * std::sqrt(k * body.mass), thin, stack});
      kind = facts.kinds.end() - 1;
    }
    kind->bodies.push_back(body.body);
  }
  for (std::size_t a = 0; a < facts.kinds.size(); ++a) {
    if (model.contact.self) facts.pairings.push_back(pairing_of(model, facts, a, a, true));
    for (std::size_t b = a; b < facts.kinds.size() && model.contact.bodies; ++b)
      if (a != b || facts.kinds[a].bodies.size() > 1)
        facts.pairings.push_back(pairing_of(model, facts, a, b, false));
  }
  return facts;
}

}  // namespace aspic

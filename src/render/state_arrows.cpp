#include "render/state_arrows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/particle_contact.h"
#include "analysis/particle_force.h"
#include "model/implicit.h"
#include "model/integrator.h"

namespace aspic {
namespace {

constexpr std::uint32_t most_along = 12, most_of_body = 1000;
/// Length of the longest arrow, in distances between those that are drawn.
constexpr double longest_arrow = 3.0;
/// Relative error of positions and velocities in single precision after many steps.
constexpr double rounding = 64.0 * std::numeric_limits<float>::epsilon();

/// Which particles of a body have arrows.
class Thinning {
 public:
  explicit Thinning(const Body& body)
      : first_(body.first_particle),
        box_(body.box()),
        stride_(box_ ? (longest_edge(*box_) + most_along - 1) / most_along
                     : (body.particle_count + most_of_body - 1) / most_of_body) {}

  std::uint32_t stride() const { return stride_; }
  /// `at_surface`: one of the three places in a lattice does not count, since all are on one face.
  bool shows(std::uint32_t particle, bool at_surface) const {
    const std::uint32_t local = particle - first_;
    if (!box_) return local % stride_ == 0;
    const Lattice::Place place = box_->place(local);
    int places = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::uint32_t>(place[axis]),
                 count = static_cast<std::uint32_t>(box_->particles[axis]);
      places += at % stride_ == (count - 1) % stride_ / 2;
    }
    return places >= (at_surface ? 2 : 3);
  }

 private:
  static std::uint32_t longest_edge(const Lattice& box) {
    return static_cast<std::uint32_t>(std::ranges::max(box.particles));
  }

  std::uint32_t first_;
  const Lattice* box_;
  std::uint32_t stride_;
};

double largest(const std::vector<Vec3>& vectors) {
  double most = 0.0;
  for (const Vec3& v : vectors) most = std::max({most, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return most;
}

/// What errors of positions and velocities mean for the stiffest springs, and those of a solve [N].
double noise_of(const Model& model, const State& state) {
  double stiffness = 0.0, damping = 0.0;
  for (const SpringClass& c : model.spring_classes) {
    stiffness = std::max(stiffness, c.stiffness);
    damping = std::max(damping, c.damping);
  }
  const double rounded = rounding * (stiffness * largest(state.position) + damping * largest(state.velocity));
  if (row_of(model.simulation.integrator).kind() != MethodKind::newton) return rounded;
  // A solve leaves up to m·tolerance in a step.
  const double mass = model.mass.empty() ? 0.0 : std::ranges::max(model.mass);
  const double left = implicit_tolerance(model.simulation.implicit, Precision::single);
  return rounded + mass * left / model.simulation.timestep;
}

}  // namespace

ArrowSet arrows_of(const Model& model, const State& state, const ArrowSettings& wanted,
                   const Inputs& inputs) {
  ArrowSet set;
  if (!wanted.any()) return set;
  double spacing = 0.0;
  for (const SpringClass& c : model.spring_classes)
    if (c.rest_length > 0.0 && (spacing == 0.0 || c.rest_length < spacing)) spacing = c.rest_length;
  std::uint32_t stride = 1;
  std::vector<Thinning> bodies(model.bodies.begin(), model.bodies.end());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (model.bodies[b].box()) stride = std::max(stride, bodies[b].stride());
  set.room = longest_arrow * (spacing > 0.0 ? spacing : 1.0) * stride;
  set.noise = noise_of(model, state);
  const SpringFinder springs(model);
  BodyContactForces body_contacts(model);
  if (wanted.contacts || wanted.net) body_contacts.find(springs, state, inputs);
  const auto add = [&](bool shown, std::uint32_t particle, const Vec3& value, ArrowKind kind) {
    if (shown) set.arrows.push_back({state.position[particle], value, kind});
  };
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (std::uint32_t i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
      if (!(wanted.springs || wanted.external || wanted.net) || !bodies[b].shows(i, false)) continue;
      const ParticleForce f = particle_force(model, springs, state, i, inputs, &body_contacts);
      add(wanted.springs, i, f.springs, ArrowKind::springs);
      add(wanted.external, i, external_force(f), ArrowKind::external);
      add(wanted.net, i, f.net, ArrowKind::net);
    }
  }
  if (!wanted.contacts) return set;
  std::size_t b = 0;
  for (const ParticleContact& c : contacts_of(model, springs, state, inputs, &body_contacts)) {
    while (b < bodies.size() && c.particle - model.bodies[b].first_particle >= model.bodies[b].particle_count)
      ++b;
    if (b < bodies.size() && !bodies[b].shows(c.particle, true)) continue;
    add(c.normal != Vec3{}, c.particle, c.normal, ArrowKind::normal);
    add(c.force != Vec3{}, c.particle, c.force, ArrowKind::contact);
  }
  return set;
}

}  // namespace aspic

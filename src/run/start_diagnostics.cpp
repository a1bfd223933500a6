#include "run/start_diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "aspic/analysis.h"
#include "model/contact_surface.h"
#include "model/terrain.h"
#include "run/named_bodies.h"

namespace aspic {
namespace {

/// A body with what its lengths are compared with.
struct Extent {
  std::uint32_t body = 0;
  double spacing = 0.0;   ///< least rest length of its structural springs [m]
  double farthest = 0.0;  ///< largest coordinate at the start [m]
  double speed = 0.0;     ///< largest at the start [m/s]
  bool pinned = false;    ///< some particles are
};

std::vector<Extent> extents_of(const Model& model) {
  std::vector<Extent> all;
  for (const Body& body : model.bodies) {
    Extent made = {static_cast<std::uint32_t>(&body - model.bodies.data()),
                   std::numeric_limits<double>::infinity(), 0.0, 0.0, false};
    for (std::uint32_t c = body.first_class; c < body.first_class + body.class_count; ++c)
      if (const SpringClass& springs = model.spring_classes[c];
          springs.type == SpringType::structural && springs.rest_length > 0.0)
        made.spacing = std::min(made.spacing, springs.rest_length);
    for (std::uint32_t i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
      const Vec3 x = model.initial_position[i];
      made.farthest = std::max({made.farthest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
      made.speed = std::max(made.speed, length(model.initial_velocity[i]));
      made.pinned = made.pinned || !(model.inverse_mass[i] > 0.0);
    }
    if (std::isfinite(made.spacing)) all.push_back(made);
  }
  return all;
}

class StartCheck {
 public:
  StartCheck(const ModelSettings& settings, const Model& model, Precision precision)
      : model_(model),
        precision_(precision),
        names_(followable_bodies(settings)),
        extents_(extents_of(model)) {
    for (const Terrain& terrain : model.terrain)
      terrain_.push_back(terrain_at(terrain, model.simulation.timestep, 0));
  }

  std::vector<Diagnostic> all() {
    within_terrain();
    fine_terrain();
    lost_digits();
    resting_distance();
    impact_speed();
    return std::move(found_);
  }

 private:
  /// Names the bodies for which of(extent) has words.
  template <class Of>
  void name(std::string_view id, std::string_view before, std::string_view after, const Of& of) {
    std::vector<std::string> parts;
    std::string where;
    for (const Extent& extent : extents_) {
      const std::optional<std::string> words = of(extent);
      if (!words) continue;
      if (where.empty()) where = names_[extent.body];
      parts.push_back(names_[extent.body] + *words);
    }
    if (!parts.empty())
      found_.push_back(
          {std::string(id), where, fmt::format("{}{}", before, listed(parts)), std::string(after)});
  }

  void within_terrain() {
    const State start = initial_state(model_, Precision::double_);
    State lifted = start;
    std::vector<double> deepest(model_.bodies.size(), 0.0);
    for (const Extent& extent : extents_) {
      const Body& body = model_.bodies[extent.body];
      for (std::uint32_t i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
        if (!(model_.inverse_mass[i] > 0.0)) continue;
        Vec3& x = lifted.position[i];
        for (const Terrain& terrain : terrain_) {
          const TerrainGap<double> gap = terrain_gap(terrain, x);
          if (!(gap.d < -1e-3 * extent.spacing)) continue;
          deepest[extent.body] = std::max(deepest[extent.body], -gap.d);
          x = x - gap.d * gap.n;
        }
      }
    }
    if (std::ranges::none_of(deepest, [](double d) { return d > 0.0; })) return;
    const double energy = measure(model_, lifted).elastic - measure(model_, start).elastic;
    name("within-terrain", "within terrain at the start: ",
         fmt::format("The first steps move their particles to its surface, which stores {:.3g} J in springs; "
                     "move the bodies out in the scene",
                     std::max(energy, 0.0)),
         [&](const Extent& extent) -> std::optional<std::string> {
           if (!(deepest[extent.body] > 0.0)) return std::nullopt;
           return fmt::format(" by {:.3g} m", deepest[extent.body]);
         });
  }

  /// Particles alone meet terrain.
  void fine_terrain() {
    for (std::size_t t = 0; t < model_.terrain.size(); ++t) {
      const Terrain& terrain = model_.terrain[t];
      double radius = 0.0;
      if (terrain.shape == TerrainShape::sphere) radius = terrain.geometry.numbers[0];
      if (terrain.shape == TerrainShape::torus) radius = terrain.geometry.numbers[1];
      if (!(radius > 0.0)) continue;
      const std::string_view what =
          terrain.shape == TerrainShape::sphere ? "sphere's radius" : "ring's tube's radius";
      name("fine-terrain",
           fmt::format("terrain[{}] may pass between particles: the {} is {:.3g} m, ", t, what, radius),
           fmt::format("Only particles collide with terrain: the radius must be 0.7 spacings, which holds up "
                       "to {:.3g} m/s at this time step; use more particles, or a larger radius",
                       2.0 * radius / model_.simulation.timestep),
           [&](const Extent& extent) -> std::optional<std::string> {
             if (!(radius < 0.7 * extent.spacing)) return std::nullopt;
             return fmt::format(" has a spacing of {:.3g} m", extent.spacing);
           });
    }
  }

  /// Where a float's spacing is too large for a body's lengths, or for its way in a step.
  void lost_digits() {
    if (precision_ == Precision::double_) return;
    const double h = model_.simulation.timestep, fall = 0.1 * length(model_.simulation.gravity);
    name(
        "far-from-origin", "single precision is too coarse for the position of bodies: ",
        "Move the scene to the origin, use a larger time step, or use double precision",
        [&](const Extent& extent) -> std::optional<std::string> {
          const auto place = static_cast<float>(extent.farthest);
          const double step = static_cast<double>(std::nextafter(place, 2.0f * place) - place);
          const double speed = std::max(extent.speed, fall);
          if (step > 1e-3 * extent.spacing)
            return fmt::format(
                ", {:.3g} m from the origin, has a resolution of {:.2g} m, and its spacing is {:.2g} m",
                extent.farthest, step, extent.spacing);
          if (speed > 0.0 && step > 0.1 * h * speed)
            return fmt::format(
                ", {:.3g} m from the origin, has a resolution of {:.2g} m, and moves {:.2g} m in a time step",
                extent.farthest, step, h * speed);
          return std::nullopt;
        });
  }

  void resting_distance() {
    const double distance = model_.contact.distance;
    if (terrain_.empty() || extents_.empty()) return;
    const double smallest = std::ranges::min(extents_, {}, &Extent::spacing).spacing;
    name("resting-distance",
         fmt::format("contact.distance, {:.3g} m, is more than a tenth of a spacing: ", distance),
         fmt::format(
             "Bodies may rest this far above terrain; set contact.distance to {:.2g}, a fiftieth of it",
             0.02 * smallest),
         [&](const Extent& extent) -> std::optional<std::string> {
           if (extent.pinned || !(distance > (0.1 + 1e-9) * extent.spacing)) return std::nullopt;
           return fmt::format(" has a spacing of {:.3g} m", extent.spacing);
         });
  }

  /// With what a body has at the start and what it gains on its way to the terrain below its middle.
  void impact_speed() {
    if (terrain_.empty()) return;
    const ContactSurfaces surfaces = contact_surfaces(model_);
    const double g = length(model_.simulation.gravity);
    name("impact-speed", "impacts on terrain may flatten cells permanently: ",
         "Slower, stiffer or lighter bodies recover their shape",
         [&](const Extent& extent) -> std::optional<std::string> {
           const Body& body = model_.bodies[extent.body];
           const auto contact = std::ranges::find(surfaces.bodies, extent.body, &ContactBody::body);
           if (contact == surfaces.bodies.end() || !contact->closed || !body.lattice || extent.pinned)
             return std::nullopt;
           Vec3 sum;
           for (std::uint32_t i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
             sum = sum + model_.initial_position[i];
           }
           const Vec3 middle = (1.0 / body.particle_count) * sum;
           double drop = std::numeric_limits<double>::infinity();
           for (const Terrain& terrain : terrain_) drop = std::min(drop, signed_distance(terrain, middle));
           const double speed = std::sqrt(extent.speed * extent.speed + 2.0 * g * std::max(drop, 0.0));
           const double sound = contact->spacing * std::sqrt(contact->stiffness / contact->mass);
           if (!(speed > 1.1 * sound)) return std::nullopt;
           return fmt::format(" may arrive at {:.3g} m/s, and its speed of sound is {:.3g} m/s", speed,
                              sound);
         });
  }

  const Model& model_;
  Precision precision_;
  std::vector<std::string> names_;
  std::vector<Extent> extents_;
  std::vector<Terrain> terrain_;
  std::vector<Diagnostic> found_;
};

}  // namespace

std::vector<Diagnostic> start_diagnostics(const ModelSettings& settings, const Model& model,
                                          Precision precision) {
  return StartCheck(settings, model, precision).all();
}

}  // namespace aspic

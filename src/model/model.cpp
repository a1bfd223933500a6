#include "model/model.h"

#include <algorithm>

#include "base/result.h"
#include "model/actuators.h"
#include "model/bodies.h"
#include "model/contact_surface.h"
#include "model/counts.h"
#include "model/integrator.h"
#include "model/springs.h"
#include "model/terrain.h"

namespace aspic {
namespace {

/// x + 0 turns −0 into +0 and leaves every other number alone.
double without_negative_zero(double x) {
  return x + 0.0;
}
Vec3 without_negative_zero(const Vec3& v) {
  return {without_negative_zero(v.x), without_negative_zero(v.y), without_negative_zero(v.z)};
}

/// x in single precision. A function that is called: g++ 12 drops the way to float and back where it
/// vectorizes it.
[[gnu::noinline]] double in_single(double x) {
  return static_cast<double>(static_cast<float>(x));
}

Vec3 rounded_to(const Vec3& v, Precision precision) {
  if (precision == Precision::double_) return without_negative_zero(v);
  // A tiny negative double may round to −0 as a float: the sign is taken off after rounding.
  return without_negative_zero({in_single(v.x), in_single(v.y), in_single(v.z)});
}

}  // namespace

QuadMesh surface_of(const Body& body) {
  const Lattice* const box = body.box();
  if (body.style == SurfaceStyle::cords) return {};
  return box ? surface_of(*box, body.first_particle) : body.listed_surface;
}

Result<Model> build_model(const ModelSettings& settings) {
  const ModelCounts predicted = predict_counts(settings);
  if (predicted.particles + predicted.balls > most_indices) {
    return fail(
        ErrorCode::scene_rejected,
        "the scene has {} particles and {} balls, which exceeds 32-bit indices; use fewer particles-per-edge",
        predicted.particles, predicted.balls);
  }
  Model model;
  model.simulation = settings.simulation;
  model.simulation.gravity = without_negative_zero(settings.simulation.gravity);
  model.contact = settings.contact;
  for (const TerrainSettings& terrain : settings.terrain) {
    Terrain made = make_terrain(terrain, settings.contact);
    for (Vec3& v : made.geometry.vectors) v = without_negative_zero(v);
    if (made.motion) made.motion->direction = without_negative_zero(made.motion->direction);
    model.terrain.push_back(made);
  }
  model.listed_springs.reserve(predicted.listed);
  model.balls.reserve(predicted.balls);
  for (std::size_t a = 0; a < settings.actuators.size(); ++a) {
    if (const auto fault = fault_of(settings, a))
      return fail(ErrorCode::scene_rejected, "actuator[{}].{}: {}", a, fault->key, fault->message);
  }
  ActuationBuilder actuation(settings);
  for (const BodyRow& body : body_rows()) {
    for (std::size_t i = 0; i < body.list.size(settings); ++i) {
      if (const Status added = body.add(model, settings, i); !added)
        return fail(added.error(), "{}[{}].{}", body.list.key, i, added.error().what);
      actuation.add_body(model, body, i);
    }
  }
  if (!settings.actuators.empty()) actuation.finish(model);
  ASPIC_CHECK(check_finite(model));
  return model;
}

State initial_state(const Model& model, Precision precision) {
  State state;
  state.precision = precision;
  state.position = model.initial_position.list(0, model.initial_position.size());
  state.velocity.reserve(model.initial_velocity.size());
  state.velocity.assign(model.initial_velocity.begin(), model.initial_velocity.end());
  for (const Ball& ball : model.balls) {
    state.ball_position.push_back(ball.initial_position);
    state.ball_velocity.push_back(ball.initial_velocity);
    state.ball_angular_velocity.push_back(ball.initial_angular_velocity);
  }
  for_each_vector(state, [&](Vec3& v) { v = rounded_to(v, precision); });
  return state;
}

Status check_sizes(const Model& model, const State& state) {
  for (const StateField& field : state_fields) {
    const bool ball = field.carrier == StateCarrier::ball;
    const std::size_t wanted = ball ? model.ball_count() : model.particle_count(),
                      found = (state.*field.vectors).size();
    if (found == wanted) continue;
    return fail(ErrorCode::usage, "the state has {0} {1}s, the scene has {2}", found,
                ball ? "ball" : "particle", wanted);
  }
  return {};
}

Status check_same_topology(const Model& from, const Model& to) {
  const auto like = [](const Body& a, const Body& b) {
    return a.first_particle == b.first_particle && a.particle_count == b.particle_count &&
           a.first_class == b.first_class && a.class_count == b.class_count && a.lattice == b.lattice;
  };
  const auto of_a_kind = [](const Terrain& a, const Terrain& b) {
    return a.shape == b.shape && a.motion.has_value() == b.motion.has_value();
  };
  const char* differs = nullptr;
  if (from.particle_count() != to.particle_count() || !std::ranges::equal(from.bodies, to.bodies, like))
    differs = "bodies";
  else if (from.ball_count() != to.ball_count())
    differs = "number of balls";
  else if (from.spring_classes.size() != to.spring_classes.size() || from.listed_springs != to.listed_springs)
    differs = "springs";
  else if (!same_structure(from.actuation, to.actuation))
    differs = "actuators";
  else if (!std::ranges::equal(from.terrain, to.terrain, of_a_kind))
    differs = "kinds of terrain";
  else if (from.contact.model != to.contact.model)
    differs = "contact model";
  else if (from.contact.bodies != to.contact.bodies || from.contact.self != to.contact.self)
    differs = "contact of bodies";
  else if (from.simulation.integrator != to.simulation.integrator)
    differs = "integrator";
  if (!differs) return {};
  return fail(ErrorCode::usage, "the {} of the two models differ: make a new solver", differs);
}

bool same_pins(const Model& a, const Model& b) {
  const auto bounds = [](const Model& model) {  // where pinned particles begin and end
    std::vector<std::size_t> ends;
    bool pinned = false;
    std::size_t first = 0;
    for (const auto& [end, weight] : model.inverse_mass.runs()) {
      if ((weight == 0.0) != pinned) ends.push_back(first);
      pinned = weight == 0.0;
      first = end;
    }
    return ends;
  };
  return bounds(a) == bounds(b);
}

ModelCounts count(const Model& model) {
  ModelCounts counts;
  counts.particles = model.particle_count();
  counts.balls = model.ball_count();
  std::size_t first = 0;
  for (const auto& [end, weight] : model.inverse_mass.runs()) {
    if (weight == 0.0) counts.pinned += end - first;
    first = end;
  }
  counts.listed = model.listed_springs.size();
  std::uint64_t* const of_type[] = {&counts.structural, &counts.shear, &counts.bending};
  const std::vector<std::uint64_t> springs = springs_by_class(model);
  for (std::size_t c = 0; c < springs.size(); ++c)
    *of_type[static_cast<std::size_t>(model.spring_classes[c].type)] += springs[c];
  return counts;
}

ModelCounts& ModelCounts::operator+=(const ModelCounts& other) {
  particles += other.particles;
  pinned += other.pinned;
  structural += other.structural;
  shear += other.shear;
  bending += other.bending;
  balls += other.balls;
  listed += other.listed;
  return *this;
}

ModelCounts predict_counts(const ModelSettings& settings) {
  ModelCounts sum;
  for (const BodyRow& body : body_rows()) {
    for (std::size_t i = 0; i < body.list.size(settings); ++i) {
      ModelCounts counts = body.counts(settings, i);
      if (!settings.actuators.empty() && is_actuated(settings, body, i)) counts.listed = counts.springs();
      sum += counts;
    }
  }
  sum.pinned = 0;
  return sum;
}

std::uint64_t model_bytes(const Model& model) {
  const auto heap = [](const auto& vector) {
    return vector.capacity() * sizeof(typename std::decay_t<decltype(vector)>::value_type);
  };
  std::uint64_t bytes = sizeof(Model) + heap(model.terrain) + model.mass.bytes() +
                        model.inverse_mass.bytes() + heap(model.spring_classes) + heap(model.listed_springs) +
                        heap(model.bodies) + model.initial_position.bytes() + model.initial_velocity.bytes() +
                        heap(model.balls) + model.actuation.bytes();
  for (const Body& body : model.bodies) {
    bytes += heap(body.listed_surface.quads) + heap(body.listed_surface.groups) + heap(body.rods);
    if (body.lattice) bytes += body.lattice->full_cells.capacity() / 8;
  }
  return bytes;
}

std::uint64_t state_bytes(const ModelCounts& counts) {
  return (numbers_of(StateCarrier::particle) * counts.particles +
          numbers_of(StateCarrier::ball) * counts.balls) *
         sizeof(double);
}

std::uint64_t run_bytes(const ModelCounts& counts) {
  // Half a State in the solver's floats is one end of a step.
  return counts.listed * sizeof(Spring) + counts.balls * sizeof(Ball) + 2 * state_bytes(counts);
}

std::string_view name_of(ContactModel model) {
  return std::ranges::find(contact_models, model, &Named<ContactModel>::value)->name;
}

std::string_view name_of(SpringType type) {
  constexpr std::string_view names[] = {"structural", "shear", "bending"};
  return names[static_cast<std::size_t>(type)];
}

}  // namespace aspic

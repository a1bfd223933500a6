#include "model/model.h"

#include <fmt/format.h>

#include <algorithm>

#include "model/cube.h"
#include "model/goal_net.h"
#include "model/launcher.h"
#include "model/terrain.h"

namespace aspic {
namespace {

/// x + 0 turns −0 into +0 and leaves every other number alone (spec §2.9).
double without_negative_zero(double x) {
  return x + 0.0;
}
Vec3 without_negative_zero(const Vec3& v) {
  return {without_negative_zero(v.x), without_negative_zero(v.y), without_negative_zero(v.z)};
}

Vec3 rounded_to(const Vec3& v, Precision precision) {
  if (precision == Precision::double_) return without_negative_zero(v);
  // A tiny negative double may round to −0 as a float: the sign is taken off after rounding.
  return without_negative_zero(
      Vec3{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
}

}  // namespace

Result<Model> build_model(const ModelSettings& settings) {
  const ModelCounts predicted = predict_counts(settings);
  // CSR words hold a spring's two ends: 2·springs and all particles must be addressable by 32 bits.
  if (2 * predicted.springs() > 0xffffffffull || predicted.particles + predicted.balls > 0x7fffffffull) {
    return Error{ErrorCode::scene_rejected,
                 fmt::format("the scene has {} particles, {} springs and {} balls: more than 32-bit indices "
                             "can name; use fewer particles-per-edge",
                             predicted.particles, predicted.springs(), predicted.balls)};
  }
  Model model;
  model.simulation = settings.simulation;
  model.simulation.gravity = without_negative_zero(settings.simulation.gravity);
  model.contact = settings.contact;
  for (const TerrainSettings& terrain : settings.terrain) {
    Terrain made = make_terrain(terrain, settings.contact);
    made.point = without_negative_zero(made.point);
    made.normal = without_negative_zero(made.normal);
    model.terrain.push_back(made);
  }
  model.mass.reserve(predicted.particles);
  model.inverse_mass.reserve(predicted.particles);
  model.initial_position.reserve(predicted.particles);
  model.initial_velocity.reserve(predicted.particles);
  model.springs.reserve(predicted.springs());
  for (std::size_t c = 0; c < settings.cubes.size(); ++c) {
    if (const Status added = add_cube(model, settings.cubes[c]); !added) {
      return Error{added.error().code, fmt::format("cube[{}].{}", c, added.error().message)};
    }
  }
  for (const GoalNetSettings& net : settings.goal_nets) add_goal_net(model, net);
  model.balls.reserve(predicted.balls);
  for (const BallSettings& ball : settings.balls) {
    model.balls.push_back({ball.radius, ball.mass, 0, ball.position, ball.velocity, ball.angular_velocity});
  }
  for (const LauncherSettings& launcher : settings.launchers) add_launcher(model, launcher);
  return model;
}

State initial_state(const Model& model, Precision precision) {
  State state;
  state.precision = precision;
  state.position.reserve(model.initial_position.size());
  state.velocity.reserve(model.initial_velocity.size());
  for (const Vec3& x : model.initial_position) state.position.push_back(rounded_to(x, precision));
  for (const Vec3& v : model.initial_velocity) state.velocity.push_back(rounded_to(v, precision));
  for (const Ball& ball : model.balls) {
    state.ball_position.push_back(rounded_to(ball.initial_position, precision));
    state.ball_velocity.push_back(rounded_to(ball.initial_velocity, precision));
    state.ball_angular_velocity.push_back(rounded_to(ball.initial_angular_velocity, precision));
  }
  return state;
}

Status check_sizes(const Model& model, const State& state) {
  if (state.position.size() != model.particle_count() || state.velocity.size() != model.particle_count()) {
    return Error{ErrorCode::usage, fmt::format("the state has {} particles, the scene has {}",
                                               state.position.size(), model.particle_count())};
  }
  if (state.ball_position.size() != model.ball_count() || state.ball_velocity.size() != model.ball_count() ||
      state.ball_angular_velocity.size() != model.ball_count()) {
    return Error{ErrorCode::usage, fmt::format("the state has {} balls, the scene has {}",
                                               state.ball_position.size(), model.ball_count())};
  }
  return {};
}

double resting_speed(const Model& model) {
  return std::max(model.contact.epsilon, 2.0 * length(model.simulation.gravity) * model.simulation.timestep);
}

double fall_speed(const Model& model) {
  return length(model.simulation.gravity) * model.simulation.timestep;
}

ModelCounts count(const Model& model) {
  ModelCounts counts;
  counts.particles = model.particle_count();
  counts.balls = model.ball_count();
  counts.pinned =
      static_cast<std::uint64_t>(std::count(model.inverse_mass.begin(), model.inverse_mass.end(), 0.0));
  for (const Spring& spring : model.springs) {
    switch (model.spring_classes[spring.spring_class].type) {
      case SpringType::structural:
        ++counts.structural;
        break;
      case SpringType::shear:
        ++counts.shear;
        break;
      case SpringType::bending:
        ++counts.bending;
        break;
    }
  }
  return counts;
}

ModelCounts predict_counts(const ModelSettings& settings) {
  ModelCounts sum;
  for (const CubeSettings& cube : settings.cubes) {
    const ModelCounts c = cube_counts(cube.particles_per_edge);
    sum.particles += c.particles;
    sum.structural += c.structural;
    sum.shear += c.shear;
    sum.bending += c.bending;
  }
  for (const GoalNetSettings& net : settings.goal_nets) {
    const ModelCounts c = goal_net_counts(net);
    sum.particles += c.particles;
    sum.structural += c.structural;
    sum.shear += c.shear;
    sum.bending += c.bending;
  }
  sum.balls = settings.balls.size();
  for (const LauncherSettings& launcher : settings.launchers) {
    sum.balls += static_cast<std::uint64_t>(launcher.count);
  }
  return sum;
}

std::uint64_t model_bytes(const ModelCounts& counts) {
  return counts.particles * (2 * sizeof(double) + 2 * sizeof(Vec3)) + counts.springs() * sizeof(Spring) +
         counts.balls * sizeof(Ball);
}

std::string_view name_of(ContactModel model) {
  return model == ContactModel::coulomb ? "coulomb" : "course";
}

std::string_view name_of(SpringType type) {
  switch (type) {
    case SpringType::structural:
      return "structural";
    case SpringType::shear:
      return "shear";
    case SpringType::bending:
      return "bending";
  }
  return "";
}

std::string_view name_of(TerrainShape shape) {
  switch (shape) {
    case TerrainShape::plane:
      return "plane";
    case TerrainShape::tilted_plane:
      return "tilted-plane";
    case TerrainShape::sphere:
      return "sphere";
    case TerrainShape::bowl:
      return "bowl";
  }
  return "";
}

}  // namespace aspic

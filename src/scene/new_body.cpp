#include "scene/new_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "aspic/state.h"
#include "model/model.h"
#include "model/terrain.h"
#include "scene/parameters.h"

namespace aspic {
namespace {

/// A box around bodies [m].
struct Extent {
  Vec3 low, high;
  Vec3 center() const { return 0.5 * (low + high); }
  /// Whether one is above or below the other, or in it.
  bool shares_column(const Extent& other) const {
    for (const int axis : {0, 2})
      if (low[axis] >= other.high[axis] || high[axis] <= other.low[axis]) return false;
    return true;
  }
};

/// A box around particles, of which there is one at least.
Extent extent_of(std::span<const Vec3> places) {
  Extent box = {places.front(), places.front()};
  for (const Vec3& x : places) {
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], x[axis]);
      box.high[axis] = std::max(box.high[axis], x[axis]);
    }
  }
  return box;
}

/// Bodies as a run of these settings starts with them.
struct Bodies {
  Model model;
  State state;

  static std::optional<Bodies> of(const ModelSettings& settings) {
    auto model = build_model(settings);
    if (!model || (model->particle_count() == 0 && model->ball_count() == 0)) return std::nullopt;
    Bodies bodies{std::move(*model), {}};
    bodies.state = initial_state(bodies.model, Precision::double_);
    return bodies;
  }
  /// act(center, radius) of every particle and ball.
  template <class Act>
  void for_each(const Act& act) const {
    for (const Vec3& x : state.position) act(x, 0.0);
    for (std::size_t b = 0; b < state.ball_position.size(); ++b)
      act(state.ball_position[b], model.balls[b].radius);
  }
  Extent extent() const {
    const Vec3 first = state.position.empty() ? state.ball_position.front() : state.position.front();
    Extent box = {first, first};
    for_each([&](const Vec3& x, double radius) {
      for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], x[axis] - radius);
        box.high[axis] = std::max(box.high[axis], x[axis] + radius);
      }
    });
    return box;
  }
  /// How deep the deepest reaches into terrain once they are moved by `shift` [m]; 0 or less: it does not.
  double depth(const Vec3& shift) const {
    double deepest = 0.0;
    for (const Terrain& terrain : model.terrain) {
      const Terrain at_first = terrain_at(terrain, model.simulation.timestep, 0);
      for_each([&](const Vec3& x, double radius) {
        deepest = std::max(deepest, radius - signed_distance(at_first, x + shift));
      });
    }
    return deepest;
  }
};

/// The same shift, and as much higher as lifts the bodies out of terrain. Terrain that slopes or is round
/// gives way bit by bit; where higher is deeper, as outside a bowl, it stays as it is.
Vec3 raised(const Bodies& bodies, Vec3 shift) {
  constexpr double clearance = 0.01;  // m
  double depth = bodies.depth(shift);
  for (int i = 0; i < 32 && depth > 0.0; ++i) {
    const Vec3 higher = shift + Vec3{0.0, depth + clearance, 0.0};
    const double left = bodies.depth(higher);
    if (!(left < depth)) break;
    shift = higher;
    depth = left;
  }
  return shift;
}

std::string key_of(const SettingsList& list, std::string_view key) {
  return fmt::format("{}[].{}", list.key, key);
}

void move(Scene& scene, const SettingsList& list, std::size_t i, const Vec3& shift) {
  for (const char* const key : {"position", "from.min", "from.max"}) {
    const Parameter* const p = find_parameter(key_of(list, key));
    if (p) p->set(scene, i, Value(std::get<Vec3>(*p->get(scene, i)) + shift));
  }
}

void aim(Scene& scene, const SettingsList& list, std::size_t i, const Extent& target) {
  const Parameter* const least = find_parameter(key_of(list, "towards.min"));
  if (!least) return;
  const Vec3 half = 0.25 * (target.high - target.low);
  least->set(scene, i, Value(target.center() - half));
  find_parameter(key_of(list, "towards.max"))->set(scene, i, Value(target.center() + half));
}

/// The first of its kind throws, or flies, no faster than a cloth at a millisecond a step can take: defaults
/// are those of shots into a goal net from nearby.
void slow_down(Scene& scene, const SettingsList& list, std::size_t i) {
  constexpr double most = 12.0;  // m/s
  if (const Parameter* const velocity = find_parameter(key_of(list, "velocity"))) {
    const Vec3 v = std::get<Vec3>(*velocity->get(scene, i));
    if (length(v) > most) velocity->set(scene, i, Value(most / length(v) * v));
  }
  const Parameter* const factor = find_parameter(key_of(list, "speed-factor"));
  if (!factor) return;
  const auto place = [&](const char* key) {
    return std::get<Vec3>(*find_parameter(key_of(list, key))->get(scene, i));
  };
  // As far apart as a start and a target can be.
  Vec3 apart;
  for (int axis = 0; axis < 3; ++axis)
    apart[axis] = std::max(std::abs(place("from.max")[axis] - place("towards.min")[axis]),
                           std::abs(place("towards.max")[axis] - place("from.min")[axis]));
  const double fastest = std::floor(100.0 * most / std::max(length(apart), 0.1)) / 100.0;
  if (fastest > 0.0 && fastest < std::get<double>(*factor->get(scene, i)))
    factor->set(scene, i, Value(fastest));
}

/// Whether what a list makes falls on other bodies: it has a surface, and nothing throws it.
bool falls(const Model& alone) {
  return !alone.bodies.empty() && alone.bodies.front().style != SurfaceStyle::cords;
}

/// The highest of what is there over the ground that a box covers; nothing: all of it is free [m].
std::optional<double> highest_under(const Bodies& there, const Extent& box) {
  std::optional<double> highest;
  const auto take = [&](const Extent& other) {
    for (const int axis : {0, 2})
      if (box.low[axis] > other.high[axis] || box.high[axis] < other.low[axis]) return;
    highest = std::max(highest.value_or(other.high.y), other.high.y);
  };
  for (const Body& body : there.model.bodies)
    take(extent_of(std::span(there.state.position).subspan(body.first_particle, body.particle_count)));
  for (std::size_t b = 0; b < there.state.ball_position.size(); ++b) {
    const double radius = there.model.balls[b].radius;
    const Vec3 around = {radius, radius, radius}, &center = there.state.ball_position[b];
    take({center - around, center + around});
  }
  return highest;
}

/// From where it falls: above what is under it, by a tenth of its size.
Vec3 dropped(const Bodies& body, const Extent& box, const Bodies& there) {
  const Vec3 size = box.high - box.low;
  const auto highest = highest_under(there, box);
  if (!highest) return raised(body, {});
  const double lift = *highest + 0.1 * std::max({size.x, size.y, size.z}) - box.low.y;
  return raised(body, {0.0, std::max(lift, 0.0), 0.0});
}

/// Next to the others, or above them where there is no place, as in a bowl.
Vec3 set_aside(const Bodies& body, const Extent& box, const Extent& there) {
  if (!box.shares_column(there)) return raised(body, {});
  const Vec3 beside = raised(body, {there.high.x + 0.5 * (box.high.x - box.low.x) - box.low.x, 0.0, 0.0});
  const Vec3 above = raised(body, {0.0, there.high.y + 0.5 * (box.high.y - box.low.y) - box.low.y, 0.0});
  return body.depth(beside) <= body.depth(above) ? beside : above;
}

}  // namespace

void place_body(Scene& scene, const SettingsList& list, std::size_t index) {
  ModelSettings others = scene.model, own = scene.model;
  list.remove(others, index);
  for (const BodyRow& row : body_rows()) {
    const bool same = row.list.key == list.key;
    while (row.list.size(own) > (same ? index + 1 : 0)) row.list.remove(own, row.list.size(own) - 1);
    while (same && row.list.size(own) > 1) row.list.remove(own, 0);
  }
  const auto body = Bodies::of(own), there = Bodies::of(others);
  if (!body) return;
  const Extent box = body->extent();
  Vec3 shift;
  if (!there)
    shift = raised(*body, {});
  else if (falls(body->model))
    shift = dropped(*body, box, *there);
  else
    shift = set_aside(*body, box, there->extent());
  move(scene, list, index, shift);
  if (there) aim(scene, list, index, there->extent());
}

void add_body(Scene& scene, const SettingsList& list) {
  list.append(scene.model);
  const std::size_t last = list.size(scene.model) - 1;
  for (const Parameter& p : parameters()) {
    if (last == 0 || !p.path.starts_with(key_of(list, "")) || p.key() == "name") continue;
    if (const auto value = p.get(scene, last - 1)) p.set(scene, last, *value);
  }
  place_body(scene, list, last);
  if (last == 0) slow_down(scene, list, last);
}

void add_box(Scene& scene) {
  const SettingsList& list = body_rows().front().list;
  add_body(scene, list);
  CubeSettings& box = scene.model.cubes.back();
  const int along = std::min(std::ranges::max(box.lattice()), 512), across = std::max((along + 1) / 2, 2);
  box.particles = {along, across, across};
  place_body(scene, list, scene.model.cubes.size() - 1);
}

double longest_extent(const ModelSettings& settings) {
  const auto bodies = Bodies::of(settings);
  if (!bodies) return 0.0;
  const Extent box = bodies->extent();
  return std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
}

}  // namespace aspic

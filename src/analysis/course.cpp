#include "analysis/course.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "model/counts.h"
#include "model/steps.h"
#include "model/terrain.h"

namespace aspic {

Course::Course(const Model& model) : model_(model), meter_(model), up_{0.0, 1.0, 0.0} {
  const Vec3& gravity = model.simulation.gravity;
  if (const double g = length(gravity); g > 0.0) up_ = -gravity / g;
}

bool Course::contacts(const State& state) const {
  for (const Terrain& terrain : model_.terrain) {
    const Terrain now = terrain_at(terrain, model_.simulation.timestep, state.step);
    const auto near = [&](const Vec3& x, double radius) {
      return signed_distance(now, x) - radius <= model_.contact.distance;
    };
    for (const Vec3& x : state.position) {
      if (near(x, 0.0)) return true;
    }
    for (std::size_t b = 0; b < model_.balls.size(); ++b) {
      if (model_.balls[b].launched(state.step) && near(state.ball_position[b], model_.balls[b].radius))
        return true;
    }
  }
  return false;
}

void Course::take(const State& state) {
  assert(check_sizes(model_, state));
  CourseSample sample;
  sample.time = static_cast<double>(state.step) * model_.simulation.timestep;
  sample.measures = meter_.measure(state);
  Vec3 moment;
  double mass = 0.0, lowest = std::numeric_limits<double>::infinity();
  const auto add = [&](const Vec3& x, double m) {
    moment = moment + m * x;
    mass += m;
    lowest = std::min(lowest, dot(x, up_));
  };
  for (std::size_t i = 0; i < state.position.size(); ++i) add(state.position[i], model_.mass[i]);
  for (std::size_t b = 0; b < model_.balls.size(); ++b) add(state.ball_position[b], model_.balls[b].mass);
  const Vec3 center = mass > 0.0 ? moment / mass : Vec3{};
  sample.height = dot(center, up_);
  sample.lowest = mass > 0.0 ? lowest : 0.0;
  if (!model_.bodies.empty()) {
    const Body& body = model_.bodies.front();
    double bottom = std::numeric_limits<double>::infinity(), top = -bottom;
    for (std::uint32_t i = body.first_particle; i < body.first_particle + body.particle_count; ++i) {
      const double height = dot(state.position[i], up_);
      bottom = std::min(bottom, height);
      top = std::max(top, height);
    }
    sample.extent = top - bottom;
  }
  if (!contact_time_ && contacts(state)) {
    contact_time_ = sample.time;
    contact_center_ = center;
  }
  if (contact_time_) {
    const Vec3 way = center - contact_center_;
    sample.slide = length(way - dot(way, up_) * up_);
  }
  samples_.push_back(sample);
}

CourseSummary Course::summary() const {
  assert(!samples_.empty());
  CourseSummary summary;
  summary.end = samples_.back();
  summary.contact_time = contact_time_;
  const double start = samples_.front().extent;
  for (const CourseSample& sample : samples_) {
    const double squash = start > 0.0 ? 1.0 - sample.extent / start : 0.0;
    if (squash > summary.squash) {
      summary.squash = squash;
      summary.squash_time = sample.time;
    }
    const bool slow = sample.measures.max_speed < model_.contact.resting_speed;
    if (!slow) {
      summary.rest_time.reset();
    } else if (!summary.rest_time) {
      summary.rest_time = sample.time;
    }
  }
  return summary;
}

std::uint64_t sample_stride(double timestep, double interval) {
  return std::max<std::uint64_t>(1, nearest_step(interval, timestep));
}

}  // namespace aspic

#include "scene/follow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>

#include "model/actuators.h"
#include "model/bodies.h"

namespace aspic {
namespace {

constexpr std::string_view ball_key = "ball";

/// The model has a body for each element of a list that makes particles; one that is wrong may make none.
bool makes_particles(const BodyRow& row, const ModelSettings& settings) {
  return row.list.size(settings) > 0 && (row.pins != nullptr || row.counts(settings, 0).particles > 0);
}

std::string name_of(std::string_view key, std::uint64_t index) {
  return fmt::format("{}[{}]", key, index);
}

struct Element {
  std::string_view key;
  std::uint32_t index = 0;
};

/// The parts of key[index], or of a key alone, which means its first element.
std::optional<Element> element_of(std::string_view name) {
  const std::size_t bracket = name.find('[');
  Element e = {name.substr(0, bracket)};
  if (bracket == std::string_view::npos) return e;
  const char *const begin = name.data() + bracket + 1, *const end = name.data() + name.size() - 1;
  if (!name.ends_with(']')) return std::nullopt;
  const auto read = std::from_chars(begin, end, e.index);
  return read.ec == std::errc() && read.ptr == end ? std::optional(e) : std::nullopt;
}

}  // namespace

std::optional<Followed> find_followed(const ModelSettings& settings, std::string_view name) {
  Element element;
  if (const auto body = find_body(settings, name)) {
    element = {body->row->list.key, static_cast<std::uint32_t>(body->index)};
  } else if (const auto read = element_of(name)) {
    element = *read;
  } else {
    return std::nullopt;
  }
  const auto [key, index] = element;
  if (key == ball_key)
    return index < predict_counts(settings).balls ? std::optional(Followed{true, index}) : std::nullopt;
  std::uint32_t first = 0;
  for (const BodyRow& row : body_rows()) {
    if (!makes_particles(row, settings)) continue;
    const auto count = static_cast<std::uint32_t>(row.list.size(settings));
    if (row.list.key == key && index < count) return Followed{false, first + index};
    first += count;
  }
  return std::nullopt;
}

std::vector<std::string> followable(const ModelSettings& settings, std::uint64_t most_balls) {
  std::vector<std::string> names;
  for (const BodyRow& row : body_rows()) {
    if (!makes_particles(row, settings)) continue;
    for (std::size_t i = 0; i < row.list.size(settings); ++i) names.push_back(name_of(row.list.key, i));
  }
  const std::uint64_t balls = std::min(predict_counts(settings).balls, most_balls);
  for (std::uint64_t b = 0; b < balls; ++b) names.push_back(name_of(ball_key, b));
  return names;
}

std::optional<std::string> followed_without(const std::string& name, std::string_view key,
                                            std::size_t index) {
  const auto own = element_of(name);
  if (!own || own->key != key || own->index < index) return name;
  return own->index == index ? std::nullopt : std::optional(name_of(key, own->index - 1));
}

std::string name_of_body(const ModelSettings& settings, const Model& model, std::uint32_t particle) {
  const auto body = std::ranges::find_if(
      model.bodies, [&](const Body& b) { return particle - b.first_particle < b.particle_count; });
  const auto index = static_cast<std::size_t>(body - model.bodies.begin());
  const std::vector<std::string> names = followable(settings, 0);
  return index < names.size() ? names[index] : std::string();
}

std::string name_of_ball(std::uint32_t ball) {
  return name_of(ball_key, ball);
}

Vec3 place_of(const Model& model, const State& state, const Followed& followed) {
  if (followed.ball) {
    assert(followed.index < state.ball_position.size());
    return state.ball_position[followed.index];
  }
  assert(followed.index < model.bodies.size());
  const Body& body = model.bodies[followed.index];
  Vec3 sum;
  for (std::uint32_t i = body.first_particle; i < body.first_particle + body.particle_count; ++i)
    sum = sum + state.position[i];
  return (1.0 / static_cast<double>(body.particle_count)) * sum;
}

Following::Following(const Scene& scene, const Model& model, Precision precision) {
  if (!scene.view.follow) return;
  what_ = find_followed(scene.model, *scene.view.follow);
  // The scene may be ahead of the model.
  if (what_ && what_->index >= (what_->ball ? model.balls.size() : model.bodies.size())) what_.reset();
  if (what_) start_ = place_of(model, initial_state(model, precision), *what_);
}

}  // namespace aspic

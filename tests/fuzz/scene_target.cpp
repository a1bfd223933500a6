// Scene text, and what --set and --view do to it.
#include <cmath>

#include "analysis/stability.h"
#include "aspic/analysis.h"
#include "aspic/scene.h"
#include "fuzz/targets.h"
#include "model/counts.h"
#include "model/model.h"
#include "scene/write.h"

namespace aspic::fuzz {
namespace {

/// Models larger than this are refused before they are built, so that an input takes milliseconds.
const LoadOptions small = {.memory_bytes = std::uint64_t{1} << 20};

/// An accepted scene is a scene for good: what is written of it reads back as the same, and it makes a model
/// whose every number is finite.
void demand(const Result<Scene>& scene) {
  if (!scene) return require_message(scene.error(), {ErrorCode::scene_rejected});
  const std::string written = to_toml(*scene);
  const auto again = parse_scene(written, "written.toml", {}, small);
  require(again.ok(), "a scene that was written is accepted");
  require(to_toml(*again) == written, "a scene that was written reads back as the same");
  const auto model = build_model(scene->model);
  if (!model) return require_message(model.error(), {ErrorCode::scene_rejected});
  for (const Precision precision : {Precision::single, Precision::double_}) {
    const State state = initial_state(*model, precision);
    require(check_sizes(*model, state).ok(), "a model's state has its sizes");
    const auto finite = [](const Vec3& v) {
      return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
    };
    for (const Vec3& x : state.position) require(finite(x), "positions are finite");
    for (const Vec3& v : state.velocity) require(finite(v), "velocities are finite");
    for (const Vec3& x : state.ball_position) require(finite(x), "balls are somewhere");
  }
  for (const double w : model->inverse_mass) require(w >= 0.0 && !std::isnan(w), "1/m is no NaN");
  const Integrator integrator = model->simulation.integrator;
  (void)certainly_stable(*model, integrator, model->simulation.timestep);
  if (model->particle_count() > 64) return;
  const StabilityLimit limit = stability_limit(*model, integrator, StabilityEffort::quick);
  require(!limit.step || *limit.step >= 0.0, "a stable step is no NaN and not negative");
}

void run_scene(std::string_view text) {
  demand(parse_scene(text, "fuzz.toml", {}, small));
}

/// The scene that the first byte chooses, with the lines of the rest as arguments.
void run_arguments(std::string_view bytes, std::string_view prefix) {
  if (bytes.empty()) return;
  const auto scenes = list_builtin_scenes();
  const BuiltinScene& scene = scenes[static_cast<unsigned char>(bytes.front()) % scenes.size()];
  bytes.remove_prefix(1);
  std::vector<std::string> arguments;
  for (std::size_t end = 0; end != std::string_view::npos && arguments.size() < 64;) {
    end = bytes.find('\n');
    // An argument of a program has no zero byte.
    const std::string_view line = bytes.substr(0, end);
    arguments.push_back(std::string(prefix) + std::string(line.substr(0, line.find('\0'))));
    if (end != std::string_view::npos) bytes.remove_prefix(end + 1);
  }
  demand(parse_scene(*builtin_scene_text(scene.name), std::string(scene.name), arguments, small));
}

void run_set(std::string_view bytes) {
  run_arguments(bytes, "");
}

void run_view(std::string_view bytes) {
  run_arguments(bytes, "view.");
}

std::vector<std::string> scene_seeds() {
  std::vector<std::string> seeds;
  for (const BuiltinScene& scene : list_builtin_scenes()) {
    seeds.emplace_back(*builtin_scene_text(scene.name));
    if (const auto read = load_scene(std::string(scene.name))) seeds.push_back(to_toml(*read));
  }
  return seeds;
}

/// Each key of each built-in scene with the value it has, one to an input.
std::vector<std::string> argument_seeds(bool view) {
  std::vector<std::string> seeds;
  const auto scenes = list_builtin_scenes();
  for (std::size_t s = 0; s < scenes.size(); ++s) {
    const auto scene = load_scene(std::string(scenes[s].name));
    if (!scene) continue;
    const std::string chosen(1, static_cast<char>(s));
    std::string all = chosen;
    for (const Parameter& p : parameters()) {
      if (p.path.starts_with("view.") != view) continue;
      const std::size_t elements = index_count(p, *scene);
      for (std::size_t i = 0; i < std::min<std::size_t>(elements, 1); ++i) {
        const auto value = p.get(*scene, i);
        if (!value) continue;
        std::string path(view ? p.path.substr(5) : p.path);
        if (const std::size_t at = path.find("[]"); at != std::string::npos) path.replace(at, 2, "[0]");
        const std::string argument = path + "=" + toml_value(*value);
        if (s == 0) seeds.push_back(chosen + argument);
        all += (all.size() > 1 ? "\n" : "") + argument;
      }
    }
    seeds.push_back(all);
  }
  return seeds;
}

std::vector<std::string> set_seeds() {
  return argument_seeds(false);
}

std::vector<std::string> view_seeds() {
  return argument_seeds(true);
}

}  // namespace

const Target scene_target = {"scene", run_scene, scene_seeds, scene_words};
const Target set_target = {"set", run_set, set_seeds, scene_words};
const Target view_target = {"view", run_view, view_seeds, scene_words};

}  // namespace aspic::fuzz

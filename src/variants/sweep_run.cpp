#include <algorithm>
#include <charconv>
#include <string_view>

#include "aspic/sweep.h"
#include "aspic/version.h"
#include "base/fnv.h"
#include "model/counts.h"
#include "scene/short_keys.h"
#include "variants/run_length.h"
#include "variants/variant.h"

namespace aspic {
namespace {

/// A hash of texts in their order, each with its length.
class Texts {
 public:
  void add(std::string_view text) {
    const std::string length = std::to_string(text.size()) + ":";
    hash_.add_bytes(std::as_bytes(std::span(length)));
    hash_.add_bytes(std::as_bytes(std::span(text)));
  }
  std::string digits() const { return hash_.digits(); }

 private:
  Fnv1a128 hash_;
};

/// The settings of motion as text, without names and view, and without the duration, since steps are counted.
std::string motion_text(const Scene& scene) {
  Scene motion;
  motion.model = scene.model;
  motion.model.simulation.duration = SimulationSettings().duration;
  return to_toml(motion);
}

ParameterValue as_written(const std::string& text) {
  double number = 0.0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, number);
  if (error == std::errc() && end == last) return number;
  return text;
}

/// The value that a difference gave the scene.
ParameterValue value_in(const SweepRun& run, const Difference& difference) {
  if (difference.key == backend_key) return run.backend_words;
  const ShortKey* const row = find_short_key(difference.key);
  const auto targets = row ? row->targets(run.scene) : std::vector<ShortKeyTarget>();
  const auto value = value_of(run.scene, targets.empty() ? difference.key : targets.front().path);
  return value && *value ? **value : as_written(difference.value);
}

void reject(SweepRun& run, const Error& error, const Scene& scene, std::span<const Difference> differences) {
  run.error = error;
  for (const Difference& difference : differences)
    run.values.emplace_back(difference.key, as_written(difference.value));
  std::vector<Difference> sorted(differences.begin(), differences.end());
  std::ranges::sort(sorted, {}, &Difference::key);
  Texts texts;
  for (const std::string_view text : {"rejected", ASPIC_VERSION}) texts.add(text);
  texts.add(motion_text(scene));
  texts.add(run.backend_words);
  for (const Difference& difference : sorted) {
    texts.add(difference.key);
    texts.add(difference.value);
  }
  run.key = texts.digits();
}

}  // namespace

SweepRun sweep_run(const Scene& scene, const BackendChoice& backend, const RunLength& length,
                   std::span<const Difference> differences) {
  SweepRun run;
  run.backend_words = words_of(backend);
  auto variant = varied(scene, backend, differences);
  auto steps = variant ? steps_of(length, variant->scene.model.simulation) : variant.error();
  if (!steps) {
    reject(run, steps.error(), scene, differences);
    return run;
  }
  run.scene = std::move(variant->scene);
  run.backend = variant->backend;
  run.backend_words = words_of(run.backend);
  run.steps = *steps;
  run.particles = predict_counts(run.scene.model).particles;

  std::vector<std::string_view> keys;
  for (const Difference& difference : differences) {
    run.values.emplace_back(difference.key, value_in(run, difference));
    keys.push_back(difference.key);
  }
  std::ranges::sort(keys);
  Texts texts;
  for (const std::string_view text : {"run", ASPIC_VERSION}) texts.add(text);
  texts.add(motion_text(run.scene));
  texts.add(run.backend_words);
  texts.add(std::to_string(run.steps));
  for (const std::string_view key : keys) texts.add(key);
  run.key = texts.digits();
  return run;
}

std::string scene_key(const Scene& scene) {
  Texts texts;
  texts.add(to_toml(scene));
  return texts.digits();
}

}  // namespace aspic

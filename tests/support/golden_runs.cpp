#include "support/golden_runs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "aspic/scene.h"
#include "cpu_reference/reference_solver.h"
#include "model/counts.h"
#include "support/model_building.h"

namespace aspic::test {
namespace {

struct Entry {
  std::uint64_t steps = 0;
  GoldenEnd end;
};

using Key = std::pair<std::string, std::string>;  // scene, method

const std::map<Key, Entry>& file_entries() {
  static const std::map<Key, Entry> entries = [] {
    std::map<Key, Entry> read;
    std::ifstream in(ASPIC_GOLDEN_HASHES);
    const nlohmann::json file = nlohmann::json::parse(in, nullptr, false);
    if (file.is_discarded()) {
      ADD_FAILURE() << ASPIC_GOLDEN_HASHES << " is missing or is no JSON; scripts/hashes.sh writes it";
      return read;
    }
    for (const nlohmann::json& run : file.at("runs")) {
      const Key key(run.at("scene").get<std::string>(), run.at("method").get<std::string>());
      const auto steps = run.at("steps").get<std::uint64_t>();
      read[key] = {steps, {run.value("ends", steps), run.at("hash").get<std::string>()}};
    }
    return read;
  }();
  return entries;
}

/// Fewer where steps are long or bodies large. The ground and its friction act within 60.
std::uint64_t steps_for(const ModelSettings& settings, Integrator method) {
  const bool long_steps = row_of(method).traits.long_steps;
  const std::uint64_t particles = predict_counts(settings).particles;
  if (particles > 10000) return long_steps ? 1 : 3;
  return long_steps ? 8 : particles > 5000 ? 45 : particles > 1500 ? 60 : 120;
}

/// The index of the first body that differs.
std::string first_difference(const State& a, const State& b) {
  for (std::size_t i = 0; i < a.position.size() && i < b.position.size(); ++i) {
    if (!(a.position[i] == b.position[i] && a.velocity[i] == b.velocity[i]))
      return fmt::format("first at particle {}", i);
  }
  return "in balls alone";
}

}  // namespace

GoldenRun golden_run(const EqualityCase& row) {
  return {scene_of(row), row.integrator, steps_of(row), [row] { return model_of(row); }};
}

GoldenRun golden_run(const KernelVariant& variant) {
  return {variant.scene, variant.settings.simulation.integrator, variant.steps(),
          [settings = variant.settings] { return build(settings); }};
}

GoldenRun golden_run(const std::string& builtin_scene, ContactModel contact, Integrator method) {
  auto scene = load_scene(builtin_scene);
  EXPECT_TRUE(scene.ok());
  ModelSettings settings = std::move(scene->model);
  settings.simulation.integrator = method;
  settings.contact.model = contact;
  const std::uint64_t steps = steps_for(settings, method);
  const auto set_down_settings = [settings = std::move(settings)] {
    ModelSettings near = settings;
    set_down(near, 0.01);
    return near;
  };
  return {fmt::format("{}, {}", builtin_scene, name_of(contact)), method, steps,
          [set_down_settings] { return build(set_down_settings()); }, set_down_settings};
}

std::vector<GoldenRun> scene_runs() {
  std::vector<GoldenRun> runs;
  for (const BuiltinScene& scene : list_builtin_scenes()) {
    for (const auto& contact : contact_models) {
      for (const Integrator method : all_integrators)
        runs.push_back(golden_run(std::string(scene.name), contact.value, method));
    }
  }
  return runs;
}

std::vector<GoldenRun> core_scene_runs() {
  constexpr Integrator always[] = {Integrator::explicit_euler, Integrator::runge_kutta_4,
                                   Integrator::implicit_euler};
  std::vector<GoldenRun> runs;
  std::size_t turn = 0;
  for (const BuiltinScene& scene : list_builtin_scenes()) {
    const std::string name(scene.name);
    for (const Integrator method : always) runs.push_back(golden_run(name, ContactModel::coulomb, method));
    const Integrator other = all_integrators[turn % all_integrators.size()];
    const ContactModel contact = contact_models[turn / 2 % 2].value;
    if (contact != ContactModel::coulomb || std::ranges::find(always, other) == std::end(always))
      runs.push_back(golden_run(name, contact, other));
    ++turn;
  }
  return runs;
}

std::vector<GoldenRun> case_runs() {
  std::map<Key, GoldenRun> once;
  const auto add = [&](GoldenRun run) { once.insert({Key(run.scene, name_of(run.method)), std::move(run)}); };
  for (const EqualityCase& row : covering_cases()) add(golden_run(row));
  for (const KernelVariant& variant : kernel_variants()) add(golden_run(variant));
  std::vector<GoldenRun> runs;
  for (auto& [key, run] : once) runs.push_back(std::move(run));
  return runs;
}

std::string HardwareRun::text() const {
  return fmt::format("{}, {}, {} steps", scene, name_of(method), steps);
}

Model HardwareRun::model() const {
  auto loaded = load_scene(scene);
  EXPECT_TRUE(loaded.ok());
  loaded->model.simulation.integrator = method;
  return build(loaded->model);
}

std::vector<HardwareRun> hardware_runs() {
  std::ifstream in(ASPIC_HARDWARE_HASHES);
  std::vector<HardwareRun> runs;
  std::string line;
  std::getline(in, line);
  EXPECT_TRUE(line.starts_with("scene,integrator,steps,backend,state_hash")) << ASPIC_HARDWARE_HASHES;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    std::string scene, method, steps, backend, hash;
    for (std::string* cell : {&scene, &method, &steps, &backend, &hash}) std::getline(cells, *cell, ',');
    const auto found =
        std::ranges::find_if(all_integrators, [&](Integrator each) { return name_of(each) == method; });
    EXPECT_NE(found, all_integrators.end()) << line;
    if (found != all_integrators.end()) runs.push_back({scene, *found, std::stoull(steps), hash});
  }
  return runs;
}

State reference_state(const GoldenRun& run) {
  const Model model = run.model();
  auto solver = make_reference_solver(model, Precision::single);
  EXPECT_TRUE(solver.ok());
  EXPECT_TRUE((*solver)->advance(run.steps).ok());
  return *(*solver)->state();
}

std::size_t golden_count() {
  return file_entries().size();
}

std::optional<GoldenEnd> golden_end(const GoldenRun& run) {
  const auto found = file_entries().find(Key(run.scene, name_of(run.method)));
  if (found == file_entries().end() || found->second.steps != run.steps) return std::nullopt;
  return found->second.end;
}

void expect_golden(const GoldenRun& run, const State& state) {
  const std::optional<GoldenEnd> expected = golden_end(run);
  const GoldenEnd end = {state.step, state_hash_text(state)};
  if (expected == end) return;
  const std::string what = fmt::format("{}, {}, {} steps", run.scene, name_of(run.method), run.steps);
  if (!expected) {
    ADD_FAILURE() << what << ": the file of hashes has no such run; scripts/hashes.sh writes it";
    return;
  }
  const State reference = reference_state(run);
  ADD_FAILURE() << what << ": the state of step " << end.step << " has the hash " << end.hash
                << ", the file has step " << expected->step << " and " << expected->hash << "; "
                << (reference == state
                        ? "the reference has the same state, so a rule has changed: if it was meant to, "
                          "scripts/hashes.sh writes the file again"
                        : fmt::format("the reference ends at step {} with {}, other {}", reference.step,
                                      state_hash_text(reference), first_difference(state, reference)));
}

std::string golden_text(const std::vector<GoldenRun>& runs) {
  std::string text = "{\"written by\": \"scripts/hashes.sh\",\n\"runs\": [";
  const char* separator = "\n";
  for (const GoldenRun& run : runs) {
    const State state = reference_state(run);
    const std::string ends = state.step == run.steps ? "" : fmt::format("\"ends\": {}, ", state.step);
    text += fmt::format(R"({}{{"scene": "{}", "method": "{}", "steps": {}, {}"hash": "{}"}})",
                        std::exchange(separator, ",\n"), run.scene, name_of(run.method), run.steps, ends,
                        state_hash_text(state));
  }
  return text + "\n]}\n";
}

}  // namespace aspic::test

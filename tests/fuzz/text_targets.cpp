// Configuration.txt, state tables and the window's kept state.
#include <fmt/format.h>

#include <cmath>

#include "app/kept_state.h"
#include "aspic/scene.h"
#include "base/files.h"
#include "fuzz/targets.h"
#include "model/model.h"
#include "scene/import_configuration.h"
#include "support/state_csv_reader.h"

namespace aspic::fuzz {
namespace {

/// Where something is imported, its text is a scene that is accepted.
void run_configuration(std::string_view text) {
  const auto imported = import_configuration(text, "Configuration.txt");
  if (!imported) return require_message(imported.error(), {ErrorCode::scene_rejected});
  // Nothing is built here, so that memory is no matter.
  const LoadOptions roomy = {.memory_bytes = std::uint64_t{1} << 60};
  const auto scene = parse_scene(imported_toml(*imported, "Configuration.txt"), "imported.toml", {}, roomy);
  require(scene.ok(), scene.ok() ? "" : "an imported scene is accepted: " + scene.error().message());
}

std::vector<std::string> configuration_seeds() {
  std::vector<std::string> seeds = {"*DeltaT\n0.005 # s\n*NumAtWidth\n8\n*DrawParticle\ntrue\n"};
  if (const auto text = read_file(ASPIC_FUZZ_CONFIGURATION)) seeds.push_back(*text);
  return seeds;
}

std::vector<std::string> configuration_words() {
  return {"*DrawParticle\n",
          "*NumAtLength\n",
          "*NetInitPos_x\n",
          "*SpringCoef\n",
          "*IntegratorType\n",
          "*SimulationPerFrame\n",
          "*",
          "\n#",
          "nan\n",
          "-nan\n",
          "1e308\n",
          "-1\n",
          "0\n",
          "\xff",
          "\xef\xbb\xbf",
          "\r\n",
          "inf\n"};
}

/// Whatever is read is finite and of one length.
void run_state_csv(std::string_view text) {
  const auto finite = [](const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  for (const Precision precision : {Precision::single, Precision::double_}) {
    const auto state = test::parse_state_csv(text, "fuzz.csv", precision);
    if (!state) {
      require_message(state.error(), {ErrorCode::io});
      continue;
    }
    require(state->precision == precision && state->position.size() == state->velocity.size() &&
                state->ball_position.size() == state->ball_velocity.size() &&
                state->ball_position.size() == state->ball_angular_velocity.size(),
            "a state has one velocity for each position");
    for (const Vec3& x : state->position) require(finite(x), "positions are finite");
    for (const Vec3& v : state->velocity) require(finite(v), "velocities are finite");
    for (const Vec3& w : state->ball_angular_velocity) require(finite(w), "spins are finite");
  }
}

std::vector<std::string> state_csv_seeds() {
  std::string text = fmt::format("{}\n", state_csv_header);
  for (int i = 0; i < 3; ++i) text += fmt::format("particle,{},0.5,1e-38,-3,1.25,{},0,0,0,0\n", i, i);
  return {text, text + "ball,0,1,2,3,4,5,6,7,8,9\n"};
}

std::vector<std::string> state_csv_words() {
  return {"particle,", "ball,", "nan", "inf",  "1e39",
          "1e-46",     "-0",    ",0",  "\r\n", std::string(state_csv_header)};
}

/// What was accepted is written and read as the same.
void run_kept_state(std::string_view text) {
  const auto state = app::read_kept_state(std::string(text));
  if (!state) return require_message(state.error(), {ErrorCode::io});
  const auto again = app::read_kept_state(app::to_text(*state));
  require(again.ok(), again.ok() ? "" : "what the window keeps is accepted: " + again.error().message());
  require(*again == *state, "what the window keeps reads back as the same");
}

std::vector<std::string> kept_state_seeds() {
  app::KeptState state;
  std::vector<std::string> seeds = {app::to_text(state)};
  state.window = app::WindowPlace{1600, 900, std::array<int, 2>{-7, 42}};
  state.layout.sections = {{"Scene", false}, {"Recording", true}};
  state.pace = Pace::real_time;
  for (const BuiltinScene& scene : list_builtin_scenes())
    app::keep_camera(state.cameras, std::string(scene.name),
                     CameraSettings{{1.0, 2.0, 3.0}, {0.0, 0.5, 0.0}, 45.0});
  seeds.push_back(app::to_text(state));
  return seeds;
}

std::vector<std::string> kept_state_words() {
  return {"\"version\": 2",
          "\"window\": {",
          "\"size\": [16, 16]",
          "\"position\": [1e6, -1e6]",
          "\"layout\": {",
          "\"sections\": {",
          "\"cameras\": [",
          "\"scene\": ",
          "\"fov\": 179.0",
          "\"format\": \"gif\"",
          "\"fps\": 240",
          "null",
          "1e999",
          "1e308"};
}

}  // namespace

const Target configuration_target = {"configuration", run_configuration, configuration_seeds,
                                     configuration_words};
const Target state_csv_target = {"state-csv", run_state_csv, state_csv_seeds, state_csv_words};
const Target kept_state_target = {"kept-state", run_kept_state, kept_state_seeds, kept_state_words};

}  // namespace aspic::fuzz

#include "app/kept_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <utility>

#define JSON_DIAGNOSTICS 1  // errors name the key
#include <nlohmann/json.hpp>

#include "aspic/scene.h"
#include "base/files.h"
#include "base/printable.h"
#include "io/atomic_file.h"

namespace aspic {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Vec3, x, y, z)
NLOHMANN_JSON_SERIALIZE_ENUM(Projection, {{Projection::perspective, "perspective"},
                                          {Projection::orthographic, "orthographic"}})

void to_json(nlohmann::json& json, const CameraSettings& c) {
  json = {{"position", c.position}, {"target", c.target}, {"fov", c.fov}, {"projection", c.projection}};
}
void from_json(const nlohmann::json& json, CameraSettings& c) {
  json.at("position").get_to(c.position);
  json.at("target").get_to(c.target);
  json.at("fov").get_to(c.fov);
  c.projection = json.value("projection", Projection::perspective);
}

namespace app {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(KeptCamera, scene, camera)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Layout, panels, left_width, right_width, text_size, clock,
                                                sections)

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
constexpr int version = 2;
constexpr const char* paces[] = {"steps-per-frame", "real-time"};

Json json_of(const KeptState& s) {
  Json json = {{"version", version},
               {"layout", s.layout.shown()},
               {"layout_name", s.layout.row().name},
               {"layouts", s.layout.left()},
               {"pace", paces[static_cast<std::size_t>(s.pace)]},
               {"speed", s.speed},
               {"video", {{"format", s.video_format->name}, {"fps", s.video_fps}, {"text", s.video_text}}},
               {"greeted", s.greeted},
               {"cameras", s.cameras}};
  if (!s.window) return json;
  json["window"]["size"] = {s.window->width, s.window->height};
  if (s.window->position) json["window"]["position"] = *s.window->position;
  return json;
}

std::array<int, 2> pair_of(const Json& numbers, double low, double high) {
  const auto cut = [&](std::size_t i) {
    return static_cast<int>(std::clamp(numbers.at(i).get<double>(), low, high));
  };
  return {cut(0), cut(1)};
}

bool is_legal(const CameraSettings& c) {
  const auto near = [](const Vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) <= 1e6;
  };
  return near(c.position) && near(c.target) && length(c.position - c.target) > 0.0 && c.fov >= 1.0 &&
         c.fov <= 179.0;
}

/// A layout within what the window allows.
Layout legal(Layout layout) {
  for (double* const width : {&layout.left_width, &layout.right_width})
    *width = std::clamp(*width, Layout::narrowest, Layout::widest);
  layout.text_size = std::clamp(layout.text_size, Layout::smallest_text, Layout::largest_text);
  return layout;
}

/// What the window could have written of it. Exceptions of Json: something is of another type.
KeptState state_of(const Json& json) {
  KeptState s;
  if (json.contains("window")) {
    const Json& window = json["window"];
    const auto size = pair_of(window.at("size"), 16, 16384);
    s.window = WindowPlace{size[0], size[1], std::nullopt};
    if (window.contains("position")) s.window->position = pair_of(window["position"], -1e6, 1e6);
  }
  const LayoutRow* const named = find_layout(json.value("layout_name", std::string(layouts().front().name)));
  const LayoutRow& row = named ? *named : layouts().front();
  std::map<std::string, Layout> left;
  for (const auto& [name, layout] : json.value("layouts", left)) {
    if (find_layout(name) && name != row.name) left[name] = legal(layout);
  }
  s.layout.restore(row, legal(json.value("layout", row.at_first())), std::move(left));
  s.pace = json.value("pace", "") == paces[0] ? Pace::steps_per_frame : Pace::real_time;
  s.speed = std::clamp(json.value("speed", s.speed), slowest_speed, fastest_speed);
  const Json video = json.value("video", Json::object());
  if (const auto* const format = find_video_format(video.value("format", ""))) s.video_format = format;
  s.video_fps = std::clamp(video.value("fps", s.video_fps), 1.0, s.video_format->most_fps);
  s.video_text = video.value("text", s.video_text);
  s.greeted = json.value("greeted", s.greeted);
  for (const KeptCamera& kept : json.value("cameras", s.cameras)) {
    if (is_legal(kept.camera)) keep_camera(s.cameras, kept.scene, kept.camera);
  }
  return s;
}

/// Where version 1 was, in TOML, which is refused like any other broken file.
std::string former_path(const std::string& path) {
  return fs::path(path).replace_extension(".toml").string();
}

}  // namespace

void keep_camera(std::vector<KeptCamera>& cameras, const std::string& scene,
                 const std::optional<CameraSettings>& camera) {
  std::erase_if(cameras, [&](const KeptCamera& kept) { return kept.scene == scene; });
  if (!camera) return;
  cameras.push_back({scene, *camera});
  if (cameras.size() > most_kept_cameras) cameras.erase(cameras.begin());
}

std::string camera_key(const std::string& source) {
  if (builtin_scene_text(source)) return source;
  std::error_code error;
  const fs::path path = fs::weakly_canonical(source, error);
  return error ? source : path.string();
}

std::string to_text(const KeptState& state) {
  return json_of(state).dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

namespace {

/// Gives the video's settings and layout the names that they have; those before 0.3 are accepted until 0.4.
void rename_former(Json& json) {
  const auto rename = [](Json& of) {
    const auto former = of.find("film");
    if (former == of.end()) return;
    of["video"] = *former;
    of.erase("film");
  };
  if (!json.is_object()) return;
  rename(json);
  if (json.contains("layouts")) rename(json["layouts"]);
  if (json.value("layout_name", Json()) == "film") json["layout_name"] = "video";
}

}  // namespace

Result<KeptState> read_kept_state(const std::string& text) {
  // What nests deeper than anything that is written is passed over: copies of it would take the stack.
  const auto shallow = [](int depth, Json::parse_event_t, Json&) { return depth < 8; };
  try {
    Json found = Json::parse(text, shallow);
    rename_former(found);
    if (found.value("version", 0) != version)
      return fail(ErrorCode::io, "it has no \"version\": {}", version);
    KeptState state = state_of(found);
    for (const Json& change : Json::diff(json_of(state), found)) {
      if (change["op"].get<std::string>() != "remove")
        return fail(ErrorCode::io, "{}: not a value that the window writes",
                    change["path"].get<std::string>());
    }
    return state;
  } catch (const Json::exception& error) {
    return fail(ErrorCode::io, "{}", error.what());
  }
}

std::string kept_state_path() {
  // The base directory specification takes absolute paths alone.
  const char* const state = std::getenv("XDG_STATE_HOME");
  if (state && state[0] == '/') return fmt::format("{}/aspic/window.json", state);
  const char* const home = std::getenv("HOME");
  return home && home[0] == '/' ? fmt::format("{}/.local/state/aspic/window.json", home) : "";
}

namespace {

/// Errors: io, it is larger than any that the window writes, or no regular file; as read_kept_state().
Result<KeptState> read_kept_state_file(const std::string& path) {
  constexpr std::uint64_t largest = std::uint64_t{1} << 20;
  ASPIC_TRY(const auto file, read_regular_file(path, largest));
  if (file.size > largest) return fail(ErrorCode::io, "it is larger than {}", human_bytes(largest));
  return read_kept_state(file.content);
}

}  // namespace

Result<KeptState> load_kept_state(const std::string& path) {
  std::error_code error;
  const std::string there = fs::exists(path, error) ? path : former_path(path);
  if (path.empty() || !fs::exists(there, error)) return KeptState();
  auto state = read_kept_state_file(there);
  if (state) return state;
  return fail(
      ErrorCode::io,
      "Cannot use {} ({}), so the window opens with its defaults. Closing the window rewrites the file.",
      there, state.error().what);
}

Status save_kept_state(const KeptState& state, const std::string& path) {
  if (path.empty()) return {};
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  ASPIC_TRY(auto file, AtomicFile::create(path, Overwrite::allow));
  ASPIC_CHECK(file.write(to_text(state)));
  ASPIC_CHECK(file.commit());
  fs::remove(former_path(path), error);
  return {};
}

}  // namespace app
}  // namespace aspic

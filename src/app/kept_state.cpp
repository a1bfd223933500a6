#include "app/kept_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <variant>

#include "base/files.h"
#include "io/atomic_file.h"
#include "scene/document.h"
#include "scene/load.h"
#include "scene/write.h"

namespace aspic::app {
namespace {

namespace fs = std::filesystem;
constexpr std::int64_t version = 1;
constexpr const char* paces[] = {"steps-per-frame", "real-time"};

std::optional<double> number_of(const toml::node& node) {
  if (const auto* x = node.as_floating_point()) return x->get();
  if (const auto* x = node.as_integer()) return static_cast<double>(x->get());
  return std::nullopt;
}

/// Takes values out of a parsed file; the first that is not as expected is remembered.
class Taker {
 public:
  /// A value of type T (toml::table, toml::array, std::string, bool), or nullptr.
  template <class T>
  const auto* find(const toml::table* table, std::string_view key) {
    const toml::node* const node = table ? table->get(key) : nullptr;
    const auto* const found = node ? node->as<T>() : nullptr;
    if (node && !found) blame(key, *node);
    return found;
  }
  void take(const toml::table* table, std::string_view key, double& into, double low, double high) {
    const toml::node* const node = table ? table->get(key) : nullptr;
    if (!node) return;
    const auto value = number_of(*node);
    if (!value || !(*value >= low && *value <= high)) return blame(key, *node);
    into = *value;
  }
  void take(const toml::table* table, std::string_view key, bool& into) {
    if (const auto* const node = find<bool>(table, key)) into = node->get();
  }
  /// An index into some words.
  template <class Words>
  void take(const toml::table* table, std::string_view key, const Words& words, std::size_t& into) {
    const auto* const node = find<std::string>(table, key);
    if (!node) return;
    const auto word = std::ranges::find(words, node->get());
    if (word == std::end(words)) return blame(key, *node);
    into = static_cast<std::size_t>(word - std::begin(words));
  }
  /// `count` numbers within ±1e6; false if they are not there.
  template <class Numbers>
  bool take_numbers(const toml::table* table, std::string_view key, Numbers& into) {
    const auto* const array = find<toml::array>(table, key);
    if (!array) return false;
    if (array->size() != into.size()) return blame(key, *array), false;
    for (std::size_t i = 0; i < into.size(); ++i) {
      const auto value = number_of((*array)[i]);
      if (!value || !(std::abs(*value) <= 1e6)) return blame(key, (*array)[i]), false;
      into[i] = static_cast<typename Numbers::value_type>(*value);
    }
    return true;
  }
  void blame(std::string_view key, const toml::node& node) {
    if (complaint.empty())
      complaint = fmt::format("line {}, '{}'", document::position_of(node.source(), 0).line, key);
  }

  std::string complaint;
};

void take_window(Taker& taker, const toml::table& root, KeptState& state) {
  const toml::table* const window = taker.find<toml::table>(&root, "window");
  std::array<int, 2> size = {}, position = {};
  if (!taker.take_numbers(window, "size", size)) return;
  if (std::min(size[0], size[1]) < 16 || std::max(size[0], size[1]) > 16384)
    return taker.blame("size", *window);
  state.window = WindowPlace{size[0], size[1], std::nullopt};
  if (taker.take_numbers(window, "position", position)) state.window->position = position;
}

void take_sections(Taker& taker, const toml::table* panels, std::string_view key, bool open, Layout& layout) {
  const toml::array* const names = taker.find<toml::array>(panels, key);
  if (!names) return;
  for (const toml::node& name : *names) {
    if (!name.is_string()) return taker.blame(key, name);
    layout.sections[name.as_string()->get()] = open;
  }
}

void take_cameras(Taker& taker, const toml::table& root, KeptState& state) {
  const toml::array* const cameras = taker.find<toml::array>(&root, "camera");
  if (!cameras) return;
  for (const toml::node& node : *cameras) {
    const toml::table* const table = node.as_table();
    const auto* const scene = taker.find<std::string>(table, "scene");
    std::array<double, 3> position = {}, target = {};
    double fov = 0.0;
    if (!scene || !taker.take_numbers(table, "position", position) ||
        !taker.take_numbers(table, "target", target))
      return taker.blame("camera", node);
    taker.take(table, "fov", fov, 1.0, 179.0);
    const CameraSettings camera = {
        {position[0], position[1], position[2]}, {target[0], target[1], target[2]}, fov};
    if (fov == 0.0 || !(length(camera.position - camera.target) > 0.0)) return taker.blame("camera", node);
    keep_camera(state.cameras, scene->get(), camera);
  }
}

std::string list_of(const Layout& layout, bool open) {
  std::vector<std::string> names;
  for (const auto& [name, is_open] : layout.sections) {
    if (is_open == open) names.push_back(name);
  }
  return toml_value(Value(names));
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

std::string to_text(const KeptState& s) {
  std::string text =
      "# Settings with which Aspic's window was last closed. Rewritten whenever it closes; may be deleted.\n"
      "version = 1\n";
  if (s.window) {
    text += fmt::format("\n[window]\nsize = [{}, {}]\n", s.window->width, s.window->height);
    if (const auto& position = s.window->position)
      text += fmt::format("position = [{}, {}]\n", (*position)[0], (*position)[1]);
  }
  const Layout& l = s.layout;
  text += fmt::format(
      "\n[panels]\nvisible = {}\nleft-width = {}\nright-width = {}\ntext-size = {}\nopen = {}\nclosed = {}\n",
      l.panels, toml_value(l.left_width), toml_value(l.right_width), toml_value(l.text_size),
      list_of(l, true), list_of(l, false));
  text += fmt::format("\n[simulation]\npace = \"{}\"\nspeed = {}\n", paces[static_cast<std::size_t>(s.pace)],
                      toml_value(s.speed));
  text += fmt::format("\n[recording]\nformat = \"{}\"\nfps = {}\nparameters = {}\n", s.film_format->name,
                      toml_value(s.film_fps), s.film_text);
  for (const KeptCamera& c : s.cameras) {
    text +=
        fmt::format("\n[[camera]]\nscene = {}\nposition = {}\ntarget = {}\nfov = {}\n", toml_value(c.scene),
                    toml_value(c.camera.position), toml_value(c.camera.target), toml_value(c.camera.fov));
  }
  return text;
}

Result<KeptState> read_kept_state(const std::string& text) {
  const auto parsed = document::parse(text, 0);
  if (const auto* problem = std::get_if<document::Problem>(&parsed))
    return fail(ErrorCode::io, "line {}: {}", problem->at.line, problem->message);
  const auto& root = std::get<toml::table>(parsed);
  const auto* const written = root.get_as<std::int64_t>("version");
  if (!written || written->get() != version)
    return fail(ErrorCode::io, "it does not say version = {}", version);
  KeptState state;
  Taker taker;
  take_window(taker, root, state);
  const toml::table* const panels = taker.find<toml::table>(&root, "panels");
  Layout& layout = state.layout;
  taker.take(panels, "visible", layout.panels);
  taker.take(panels, "left-width", layout.left_width, Layout::narrowest, Layout::widest);
  taker.take(panels, "right-width", layout.right_width, Layout::narrowest, Layout::widest);
  taker.take(panels, "text-size", layout.text_size, Layout::smallest_text, Layout::largest_text);
  take_sections(taker, panels, "open", true, layout);
  take_sections(taker, panels, "closed", false, layout);
  const toml::table* const simulation = taker.find<toml::table>(&root, "simulation");
  std::size_t pace = 0, format = 0;
  taker.take(simulation, "pace", paces, pace);
  state.pace = static_cast<Pace>(pace);
  taker.take(simulation, "speed", state.speed, slowest_speed, fastest_speed);
  const toml::table* const recording = taker.find<toml::table>(&root, "recording");
  std::vector<std::string> formats;
  for (const FilmFormat& f : film_formats()) formats.emplace_back(f.name);
  taker.take(recording, "format", formats, format);
  state.film_format = &film_formats()[format];
  // The default may be more than the kind of film shows.
  state.film_fps = std::min(state.film_fps, state.film_format->most_fps);
  taker.take(recording, "fps", state.film_fps, 1.0, state.film_format->most_fps);
  taker.take(recording, "parameters", state.film_text);
  take_cameras(taker, root, state);
  if (!taker.complaint.empty())
    return Error{ErrorCode::io, taker.complaint + ": the window would not write this"};
  return state;
}

std::string kept_state_path() {
  // The base directory specification takes absolute paths alone.
  const char* const state = std::getenv("XDG_STATE_HOME");
  if (state && state[0] == '/') return fmt::format("{}/aspic/window.toml", state);
  const char* const home = std::getenv("HOME");
  return home && home[0] == '/' ? fmt::format("{}/.local/state/aspic/window.toml", home) : "";
}

Result<KeptState> load_kept_state(const std::string& path) {
  std::error_code error;
  if (path.empty() || !fs::exists(path, error)) return KeptState();
  ASPIC_TRY(const auto text, read_file(path));
  auto state = read_kept_state(text);
  if (state) return state;
  return fail(ErrorCode::io,
              "{} cannot be used ({}), so the window opens with its defaults. "
              "The file is rewritten when the window closes.",
              path, state.error().message);
}

Status save_kept_state(const KeptState& state, const std::string& path) {
  if (path.empty()) return {};
  std::error_code error;
  fs::create_directories(fs::path(path).parent_path(), error);
  ASPIC_TRY(auto file, AtomicFile::create(path, Overwrite::allow));
  ASPIC_CHECK(file.write(to_text(state)));
  return file.commit();
}

}  // namespace aspic::app

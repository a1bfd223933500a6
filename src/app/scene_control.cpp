#include "app/scene_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "aspic/model.h"
#include "aspic/scene.h"
#include "base/files.h"
#include "scene/follow.h"
#include "scene/input_file.h"

namespace aspic::app {

/// The simulation, which has the editor's scene already, begins; the camera leaves the source `left`.
void SceneControl::show_opened(const std::string& left) {
  view_.keep_camera(left);
  pending_ = Effect::none;
  taken_ = editor_.last_change();
  unchanged_for_ = 0.0;
  messages_.dismiss();
  simulation_.stepper().replay({});
  messages_.check(simulation_.rebuild().reset());
  if (editor_.state()) messages_.check(simulation_.rebuild().start_from(*editor_.state(), editor_.inputs()));
  view_.camera = CameraControl(scene().view.camera);
  view_.forget_followed();
  view_.recall_camera(editor_.source());
}

/// The one that is open, if it is a file.
void SceneControl::list_file() {
  if (editor_.is_file() && std::ranges::find(files_, editor_.source()) == files_.end())
    files_.push_back(editor_.source());
}

void SceneControl::open(const std::string& source) {
  constexpr std::uint64_t largest_log = std::uint64_t{64} << 20;
  if (!builtin_scene_text(source) && !source.ends_with(".aspic"))
    if (const auto file = read_regular_file(source, largest_log); file && is_input_log(file->content))
      return open_inputs(source);
  auto loaded = editor_.other(source);
  if (!messages_.check(loaded) || !messages_.check(simulation_.rebuild().change(loaded->scene(), false)))
    return;
  const std::string left = editor_.source();
  editor_.open(std::move(*loaded));
  list_file();
  show_opened(left);
}

void SceneControl::open_inputs(const std::string& path) {
  const auto model = make_model(scene().model);
  if (!messages_.check(model)) return;
  auto inputs = read_inputs(path, {scene().model, **model});
  if (!inputs) {
    const Error& why = inputs.error();
    return messages_.error(
        why.code == ErrorCode::scene_rejected
            ? fail(why, "The inputs of {} do not fit the scene {}.\n{}", path, scene().name, why.what)
            : why);
  }
  if (!messages_.check(simulation_.rebuild().reset())) return;
  const std::uint64_t last = inputs->empty() ? 0 : inputs->entries().back().step;
  simulation_.stepper().replay(std::move(*inputs));
  messages_.info(fmt::format("The run repeats the inputs of {}, up to step {}.{}", path, last,
                             simulation_.running() ? "" : " Space starts it."),
                 10.0);
}

void SceneControl::open_neighbor(int offset) {
  const std::vector<BuiltinScene> scenes = list_builtin_scenes();
  const auto count = static_cast<int>(scenes.size());
  const auto open_one = std::ranges::find(scenes, editor_.source(), &BuiltinScene::name);
  int current = offset > 0 ? -1 : 0;
  if (open_one != scenes.end()) current = static_cast<int>(open_one - scenes.begin());
  open(std::string(scenes[static_cast<std::size_t>((current + offset + count) % count)].name));
}

void SceneControl::reload() {
  const std::string source = editor_.source();
  open(source);
  if (!messages_.notice()) messages_.info(fmt::format("Reloaded {}.", source));
}

/// The file was written: constants take effect while the motion continues, and undo comes back to what was
/// here.
void SceneControl::reread_file() {
  const auto loaded = editor_.other(editor_.source());
  if (!loaded) return messages_.error(loaded.error());
  const Effect effect = effect_between(editor_.scene(), loaded->scene());
  if (!messages_.check(simulation_.rebuild().change(loaded->scene(), effect != Effect::restart))) return;
  const CameraSettings camera = editor_.scene().view.camera;
  const bool changed = editor_.changed();
  pending_ = Effect::none;
  if (!messages_.check(editor_.apply(loaded->scene(), "reading the file", ""))) return;
  taken_ = editor_.last_change();
  editor_.mark_saved();
  if (camera != editor_.scene().view.camera) view_.camera = CameraControl(editor_.scene().view.camera);
  messages_.info(
      fmt::format("Reloaded {}, which changed on disk{}.{}", editor_.source(),
                  effect == Effect::restart ? "; bodies changed, so the simulation was restarted" : "",
                  changed ? " Undo restores the changes made here." : ""));
}

void SceneControl::save_as(const std::string& path, Overwrite overwrite) {
  if (!messages_.check(editor_.save_as(path, view_.camera.goal(), overwrite))) return;
  list_file();
  view_.camera.set_home(editor_.scene().view.camera);
  messages_.info(fmt::format("Saved as {}.", path));
}

void SceneControl::undo() {
  if (!editor_.can_undo()) return;
  const std::string left = editor_.source();
  if (!undone(editor_.undo(), left, &SceneEditor::redo)) return;
  messages_.info(fmt::format("Undone: {}.", editor_.redo_name()));
}

/// Carries out what undo or redo did; where it cannot be, `back` takes that back and a message says why.
bool SceneControl::undone(Effect effect, const std::string& left, Effect (SceneEditor::*back)()) {
  if (effect != Effect::opening) {
    take_effect(effect);
  } else if (messages_.check(simulation_.rebuild().change(scene(), false))) {
    show_opened(left);
  } else {
    (editor_.*back)();
    return false;
  }
  return true;
}

void SceneControl::redo() {
  if (!editor_.can_redo()) return;
  const std::string left = editor_.source();
  if (!undone(editor_.redo(), left, &SceneEditor::undo)) return;
  messages_.info(fmt::format("Redone: {}.", editor_.undo_name()));
}

void SceneControl::set_value(const Parameter& parameter, std::size_t index, const Value& value,
                             const std::string& gesture) {
  const auto followed = scene().view.follow;
  take_effect(editor_.set(parameter, index, value, gesture));
  say_if_gone(followed);
}

void SceneControl::apply(Scene scene, const std::string& name, const std::string& gesture) {
  const auto followed = this->scene().view.follow;
  take_effect(editor_.apply(std::move(scene), name, gesture));
  say_if_gone(followed);
}

/// The change removed what the camera followed.
void SceneControl::say_if_gone(const std::optional<std::string>& followed) {
  if (!followed || scene().view.follow || find_followed(scene().model, *followed)) return;
  tell(fmt::format("The scene no longer has {}: the camera stops following it.", *followed));
}

void SceneControl::tell(const std::string& sentences) {
  beside_ = sentences;
  say_beside("");
}

/// For as long as it takes to read.
void SceneControl::say_beside(const std::string& first) {
  constexpr double characters_a_second = 20.0;
  const std::string text = first + (first.empty() || beside_.empty() ? "" : " ") + beside_;
  if (!text.empty())
    messages_.info(text, std::max(5.0, static_cast<double>(text.size()) / characters_a_second));
}

void SceneControl::change(const std::string& name, const std::function<void(Scene&)>& make,
                          const std::string& gesture) {
  Scene changed = scene();
  make(changed);
  apply(std::move(changed), name, gesture);
}

void SceneControl::take_effect(Result<Effect> effect) {
  if (!effect) return messages_.error(effect.error());
  unchanged_for_ = 0.0;
  if (*effect >= Effect::constants) pending_ = std::max(pending_, *effect);
  const CameraSettings& camera = editor_.scene().view.camera;
  if (camera != view_.camera.home()) view_.camera.set_home(camera);
}

void SceneControl::follow_history() {
  if (effect_on_running() >= Effect::constants) return adopt_running("going back in time");
  taken_ = editor_.last_change();
}

/// The effect of going from the simulation's scene to the editor's.
Effect SceneControl::effect_on_running() const {
  Scene running = scene();
  running.model = simulation_.present().setup().settings;
  return effect_between(running, scene());
}

/// The editor's scene becomes the simulation's, under a name for undo.
void SceneControl::adopt_running(const std::string& name) {
  Scene running = scene();
  running.model = simulation_.present().setup().settings;
  pending_ = Effect::none;
  if (const auto applied = editor_.apply(std::move(running), name, ""); !applied)
    messages_.error(applied.error());
  taken_ = editor_.last_change();
}

/// Takes back the changes that the simulation was asked for and refused, and asks for those that are left.
void SceneControl::take_back_refused() {
  const bool later = editor_.last_change() != requested_change_;
  const bool withdrawn = editor_.withdraw(taken_, requested_change_);
  pending_ = Effect::none;
  const Effect left = effect_on_running();
  if (withdrawn || later || left < Effect::constants) return take_effect(left);
  adopt_running("what the simulation refused");
}

void SceneControl::update(double dt) {
  constexpr double file_interval = 0.5;  // s
  unchanged_for_ += dt;
  since_rebuild_ += dt;
  since_file_look_ += dt;
  if (since_file_look_ >= file_interval) {
    since_file_look_ = 0.0;
    if (editor_.file_changed()) reread_file();
  }
  // A solver that takes long to build does not follow every step of a slider.
  if (!pending() || simulation_.rebuild().changing() || since_rebuild_ < 4.0 * rebuild_seconds_) return;
  requested_ = std::exchange(pending_, Effect::none);
  requested_at_ = std::chrono::steady_clock::now();
  requested_change_ = editor_.last_change();
  had_moved_ = simulation_.step() > 0;
  simulation_.rebuild().request(editor_.scene(), requested_ == Effect::constants);
}

bool SceneControl::finish_change() {
  const auto changed = simulation_.rebuild().take_change();
  if (!changed) return false;
  rebuild_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - requested_at_).count();
  since_rebuild_ = 0.0;
  if (!messages_.check(*changed)) {
    take_back_refused();
  } else {
    taken_ = std::max(taken_, requested_change_);
    if (requested_ == Effect::restart && (had_moved_ || !beside_.empty()))
      // A run that had not begun loses nothing.
      say_beside(had_moved_ ? "The bodies changed: the simulation was restarted." : "");
    else
      messages_.dismiss_error();
  }
  beside_.clear();
  return rebuild_seconds_ > 0.05;
}

}  // namespace aspic::app

#include "app/app.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "analysis/stability.h"
#include "app/panels.h"
#include "app/shortcuts.h"
#include "run/backends.h"
#include "scene/load.h"

namespace aspic::app {
namespace {

/// How long a line that is no error stays [s].
constexpr double notice_seconds = 5.0;
constexpr double slowest = 1.0 / 1024.0, fastest = 1024.0;

}  // namespace

Result<std::unique_ptr<App>> App::create(gl::Context& context, const AppOptions& options, double scale,
                                         WindowServices services) {
  auto editor = SceneEditor::open(options.scene, options.overrides);
  if (!editor) return editor.error();
  std::unique_ptr<App> app(new App(context, std::move(*editor)));
  app->full_quality_ = options.full_quality;
  const BackendRow& backend = options.backend ? *options.backend : *choose_automatically({}, &context).row;
  auto simulation = Simulation::create(context, app->editor_.scene(), backend);
  if (!simulation) return simulation.error();
  app->simulation_ = std::move(*simulation);
  ASPIC_CHECK(app->make_pictures(scale, std::move(services)));
  app->take_on(options.kept, options.overrides);
  return app;
}

App::~App() {
  // Whatever ends the window, the film is completed.
  stop_recording();
}

std::string App::title() const {
  return fmt::format("{}{} - Aspic", editor_.scene().name, editor_.changed() ? " (changed)" : "");
}

bool App::idle() const {
  return !simulation_->running() && std::min(still_, awake_) > 0.5 && !screenshot_wanted_ &&
         pending_ == Effect::none && !simulation_->changing();
}

void App::tell(const Status& status) {
  if (!status) tell(status.error().message, true);
}

// ---- events ----

void App::key(int key, int action, int modifiers) {
  still_ = 0.0;
  gui_->key(key, action, modifiers);
  if (action == GLFW_RELEASE || gui_->takes_keyboard()) return;
  if (key == GLFW_KEY_ESCAPE && action == GLFW_PRESS) {
    help_visible_ = false;
    dismiss_notice();
    return;
  }
  const bool repeats = key == GLFW_KEY_Z || key == GLFW_KEY_Y || key == GLFW_KEY_BACKSPACE;
  if (action == GLFW_REPEAT && !repeats) return;
  act_on_key(*this, key, modifiers);
}

void App::character(unsigned int code_point) {
  still_ = 0.0;
  if (gui_->takes_keyboard())
    gui_->character(code_point);
  else
    act_on_character(*this, static_cast<char32_t>(code_point));
}

void App::mouse_button(int button, int action, int modifiers) {
  still_ = 0.0;
  gui_->mouse_button(button, action);
  if (action == GLFW_RELEASE) {
    if (button == drag_button_) drag_button_ = -1;
    if (button == GLFW_MOUSE_BUTTON_LEFT) end_pull();
    if (button == GLFW_MOUSE_BUTTON_LEFT) editor_.end_gesture();
    return;
  }
  if (drag_button_ >= 0 || gui_->takes_mouse() || !viewport_.contains(mouse_x_, mouse_y_)) return;
  const bool hand = (modifiers & GLFW_MOD_CONTROL) != 0;
  if (hand && hovered_) {
    if (button == GLFW_MOUSE_BUTTON_LEFT) begin_pull();
    if (button == GLFW_MOUSE_BUTTON_RIGHT) toggle_pin(hovered_->particle);
    return;
  }
  if (hand) return;
  if (button == GLFW_MOUSE_BUTTON_LEFT && modifiers == 0) centre_wanted_ = is_double_click();
  drag_button_ = button;
  drag_pans_ = button != GLFW_MOUSE_BUTTON_LEFT || (modifiers & GLFW_MOD_SHIFT) != 0;
}

void App::cursor(double x, double y) {
  awake_ = 0.0;
  // A mouse that only passes over leaves the picture as it is, in full resolution.
  if (drag_button_ >= 0 || simulation_->hand()) still_ = 0.0;
  gui_->cursor(x, y);
  if (drag_button_ >= 0) drag(x - mouse_x_, y - mouse_y_);
  mouse_x_ = x;
  mouse_y_ = y;
  move_pull();
}

void App::drag(double dx, double dy) {
  const double height = std::max(viewport_.bottom - viewport_.top, 1.0);
  if (drag_pans_)
    camera_.pan(dx / height, dy / height);
  else
    camera_.orbit(dx / height, dy / height);
}

void App::scroll(double dx, double dy) {
  still_ = 0.0;
  if (viewport_.contains(mouse_x_, mouse_y_) && !gui_->takes_mouse())
    camera_.zoom(dy);
  else
    gui_->scroll(dx, dy);
}

void App::drop(const std::vector<std::string>& paths) {
  still_ = 0.0;
  if (!paths.empty()) open(paths.front());
}

// ---- actions ----

void App::toggle_running() {
  if (simulation_->divergence()) {
    tell("The simulation has diverged. Take the stable step, step back or reset first.", true);
    return;
  }
  simulation_->set_running(!simulation_->running());
}

void App::single_step() {
  if (simulation_->running()) simulation_->set_running(false);
  film();
  tell(simulation_->single_step());
  film();
}

void App::reset() {
  stable_.reset();
  tell(simulation_->reset());
}

void App::change_speed(double factor) {
  simulation_->speed = std::clamp(simulation_->speed * factor, slowest, fastest);
}

void App::toggle_backend() {
  const Status changed = simulation_->set_backend(next_backend(simulation_->backend()));
  follow_history();
  if (changed)
    tell(fmt::format("Now on {}.", simulation_->solver().description()));
  else
    tell(changed);
}

void App::open(const std::string& source) {
  keep_camera();
  const SceneEditor before = editor_;
  if (const Status opened = editor_.replace(source); !opened) return tell(opened);
  const Status changed = simulation_->change(editor_.scene(), false);
  if (!changed) {
    editor_ = before;
    return tell(changed);
  }
  scene_replaced();
}

void App::scene_replaced() {
  pending_ = Effect::none;
  stable_.reset();
  notice_.reset();
  tell(simulation_->reset());
  camera_ = CameraControl(editor_.scene().view.camera);
  recall_camera();
}

void App::open_neighbour(int offset) {
  const std::vector<BuiltinScene> scenes = list_builtin_scenes();
  const auto count = static_cast<int>(scenes.size());
  int current = offset > 0 ? -1 : 0;
  for (int i = 0; i < count; ++i) {
    if (scenes[static_cast<std::size_t>(i)].name == editor_.source()) current = i;
  }
  open(std::string(scenes[static_cast<std::size_t>((current + offset + count) % count)].name));
}

void App::reload() {
  const std::string source = editor_.source();
  open(source);
  if (!notice_) tell(fmt::format("{} loaded again.", source));
}

void App::read_again() {
  const SceneEditor before = editor_;
  if (const Status loaded = editor_.reload(); !loaded) return tell(loaded);
  const Effect effect = effect_between(before.scene(), editor_.scene());
  if (const Status changed = simulation_->change(editor_.scene(), effect != Effect::restart); !changed) {
    editor_ = before;
    return tell(changed);
  }
  pending_ = Effect::none;
  stable_.reset();
  if (before.scene().view.camera != editor_.scene().view.camera)
    camera_ = CameraControl(editor_.scene().view.camera);
  tell(fmt::format("{} was written and is read again{}.", editor_.source(),
                   effect == Effect::restart ? "; its bodies changed, the simulation starts anew" : ""));
}

void App::save_as(const std::string& path) {
  const Status saved = editor_.save_as(path, camera_.goal());
  if (saved)
    tell(fmt::format("Saved as {}.", path));
  else
    tell(saved);
}

void App::undo() {
  if (!editor_.can_undo()) return;
  const std::string name = editor_.undo_name();
  take_effect(editor_.undo());
  tell(fmt::format("Undone: {}.", name));
}

void App::redo() {
  if (!editor_.can_redo()) return;
  const std::string name = editor_.redo_name();
  take_effect(editor_.redo());
  tell(fmt::format("Done again: {}.", name));
}

void App::toggle_full_screen() {
  if (gui_->services().toggle_full_screen) gui_->services().toggle_full_screen();
}

// ---- changes ----

void App::set_value(const Parameter& parameter, std::size_t index, const Value& value,
                    const std::string& gesture) {
  const auto effect = editor_.set(parameter, index, value, gesture);
  if (!effect) return tell(effect.error());
  take_effect(*effect);
}

void App::apply(Scene scene, const std::string& name, const std::string& gesture) {
  const auto effect = editor_.apply(std::move(scene), name, gesture);
  if (!effect) return tell(effect.error());
  take_effect(*effect);
}

void App::take_effect(Effect effect) {
  still_ = 0.0;
  if (effect >= Effect::constants) pending_ = std::max(pending_, effect);
  if (editor_.scene().view.camera != camera_.home()) camera_.set_home(editor_.scene().view.camera);
}

void App::request_changes() {
  if (pending_ == Effect::none || simulation_->changing()) return;
  // A solver that takes long to build does not follow every twitch of a slider.
  if (since_rebuild_ < 4.0 * rebuild_seconds_) return;
  requested_ = std::exchange(pending_, Effect::none);
  requested_at_ = std::chrono::steady_clock::now();
  simulation_->request_change(editor_.scene(), requested_ == Effect::constants);
}

void App::end_change() {
  const auto changed = simulation_->take_change();
  if (!changed) return;
  rebuild_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - requested_at_).count();
  since_rebuild_ = 0.0;
  rest_a_picture_ = rebuild_seconds_ > 0.05;
  if (!*changed) {
    const Error error = changed->error();
    if (editor_.can_undo()) editor_.undo();
    return tell(error.message, true);
  }
  stable_.reset();
  if (requested_ == Effect::restart)
    tell("The bodies changed: the simulation starts anew.");
  else if (notice_ && notice_->is_error)
    notice_.reset();
}

void App::watch_file(double dt) {
  since_file_look_ += dt;
  if (since_file_look_ < 0.5) return;
  since_file_look_ = 0.0;
  if (editor_.file_changed()) read_again();
}

void App::watch_divergence() {
  const auto& divergence = simulation_->divergence();
  if (!divergence) {
    divergence_told_ = false;
    return;
  }
  if (divergence_told_) return;
  divergence_told_ = true;
  const Model& model = simulation_->model();
  const SimulationSettings& s = model.simulation;
  stable_ = stability_limit(model, s.integrator, StabilityEffort::quick);
  tell(fmt::format("The simulation diverged in step {} (t = {:.6g} s): {} {}. The time step is {} s; {}. "
                   "Shown is the last good step.",
                   divergence->step, static_cast<double>(divergence->step) * s.timestep,
                   body_text(*divergence), fault_text(*divergence), s.timestep,
                   stability_sentence(s.integrator, *stable_)),
       true);
}

Status App::frame(const WindowSize& size, double dt) {
  if (context_->lost()) return context_->lost_error();
  if (size.pixel_width < 1 || size.pixel_height < 1 || size.width < 1 || size.height < 1) return {};
  watch_file(dt);
  if (notice_ && !notice_->is_error && (notice_->age += dt) > notice_seconds) notice_.reset();
  since_rebuild_ += dt;
  const bool camera_moves = camera_.update(dt);
  request_changes();
  // A picture of a software rasteriser takes longer anyway, so steps may too.
  const double budget = context_->info().is_software ? 0.030 : 0.012;
  film();
  ASPIC_CHECK(simulation_->update(dt, budget));
  end_change();
  if (auto message = simulation_->take_message()) tell(*message, true);
  film();
  watch_divergence();
  still_ = camera_moves || simulation_->running() || simulation_->seeking() ? 0.0 : still_ + dt;
  awake_ += dt;
  rate_time_ += dt;
  ++rate_pictures_;
  if (rate_time_ > 0.5) {
    pictures_per_second_ = rate_pictures_ / rate_time_;
    rate_time_ = 0.0;
    rate_pictures_ = 0;
  }
  find_hovered();
  gui_->begin(size.width, size.height, static_cast<double>(size.pixel_width) / size.width, dt);
  viewport_ = draw_panels(*this, size.width, size.height);
  ASPIC_CHECK(draw_scene(size));
  gui_->end();
  if (screenshot_wanted_) save_screenshot(size);
  return {};
}

}  // namespace aspic::app

#include "app/app.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "analysis/stability.h"
#include "app/add_mesh.h"
#include "app/panels.h"
#include "base/printable.h"
#include "run/backends.h"
#include "run/run_files.h"
#include "run/window_host.h"
#include "scene/follow.h"
#include "scene/import_mesh.h"

namespace aspic::app {

Result<std::unique_ptr<App>> App::create(gl::Context& context, const AppOptions& options, double scale,
                                         WindowServices services) {
  ASPIC_TRY(auto editor, SceneEditor::open(options.scene, options.overrides));
  const BackendRow& backend =
      options.backend ? *options.backend : *choose_automatically(options.asked, &context).row;
  ASPIC_TRY(auto simulation, PlaybackSession::create(context, editor.scene(), backend, options.asked));
  std::unique_ptr<App> app(new App(options, std::move(editor), std::move(simulation)));
  ASPIC_CHECK(app->attach(context, scale, std::move(services)));
  if (const auto& state = app->scene.editor().state()) {
    ASPIC_CHECK(app->simulation.rebuild().start_from(*state, app->scene.editor().inputs()));
  }
  if (!options.replay.empty()) {
    const Scene& scene = app->scene.scene();
    ASPIC_TRY(const SharedModel model, make_model(scene.model));
    ASPIC_TRY(auto inputs, read_inputs(options.replay, {scene.model, *model}));
    app->simulation.stepper().replay(std::move(inputs));
  }
  app->restore(options.kept, options.overrides);
  return app;
}

App::App(const AppOptions& options, SceneEditor editor, std::unique_ptr<PlaybackSession> own)
    : simulation_(std::move(own)),
      commands_(make_commands()),
      watcher_(options.watcher),
      simulation(*simulation_),
      view(editor.scene().view.camera),
      scene(std::move(editor), simulation, view, messages),
      run(simulation, scene, messages),
      image(simulation, scene.scene(), view, options.full_quality),
      hands(simulation, view, messages),
      comparison(simulation, scene.scene(), options.asked),
      comparison_view(comparison, scene, view, image, messages, options.asked),
      video(simulation, scene.editor(), view, image, comparison, comparison_view, messages),
      pointer(simulation, view, image, hands),
      cells(scene) {
  hands.refusal = [this] { return comparison.hands_refused(); };
}

void App::go_back(double time) {
  const double to = comparison.clock().time() - time;
  if (!comparison_view.go_to(to)) run.go_to(to);
}

/// One at a time.
void App::open_page(Page page) {
  help_visible = page == Page::help;
  if (page != Page::files) files.close();
  if (page == Page::palette)
    palette.open();
  else
    palette.close();
}

void App::ask_for_scene() {
  open_page(Page::files);
  files.ask(
      {"Open", {".toml", ".aspic"}, false, [this](const std::string& path, Overwrite) { scene.open(path); }},
      scene.editor().is_file() ? scene.editor().source() : "");
}

void App::ask_for_mesh() {
  open_page(Page::files);
  files.ask({"Add",
             {".obj", ".stl", ".ply"},
             false,
             [this](const std::string& path, Overwrite) { add_mesh(scene, messages, path); }},
            "");
}

/// Of the body under the mouse, or of the one that is edited.
void App::edit_hovered_cells() {
  const auto& hovered = pointer.hovered();
  for (std::size_t i = 0; hovered && !hovered->ball && i < scene.scene().model.voxels.size(); ++i)
    if (name_of_body(scene.scene().model, simulation.model(), hovered->particle) ==
        fmt::format("voxels[{}]", i))
      cells.choose_body(i);
  show_section(layout, "Cells");
}

void App::ask_where_to_save() {
  open_page(Page::files);
  const auto save = [this](const std::string& path, Overwrite overwrite) { scene.save_as(path, overwrite); };
  files.ask({"Save", {".toml"}, true, save},
            scene.editor().is_file() ? scene.editor().source() : scene.editor().source() + ".toml");
}

// ---- the context ----

Status App::attach(gl::Context& context, double scale, WindowServices services) {
  ASPIC_CHECK(image.attach(context));
  comparison_view.attach(context);
  ASPIC_TRY(gui_, Gui::create(scale, std::move(services), commands_, watcher_));
  return {};
}

Status App::release_context(const Error& why) {
  for (const std::string& line : video.finish()) messages.error(line);
  comparison_view.detach();
  ASPIC_CHECK(simulation.rebuild().leave_context(why));
  // What the solver said when it noticed first says more.
  if (!messages.any_error()) messages.error(why);
  pointer.forget();
  image.detach();
  gui_.reset();
  return {};
}

Status App::adopt_context(gl::Context& context, double scale, WindowServices services) {
  simulation.rebuild().set_context(context);
  return attach(context, scale, std::move(services));
}

// ---- what is kept ----

void App::restore(const KeptState& kept, const std::vector<std::string>& overrides) {
  layout = kept.layout;
  greeted_ = kept.greeted;
  simulation.pacer().set_pace(kept.pace);
  simulation.pacer().set_speed(kept.speed);
  video.settings = {kept.video_format, kept.video_fps, kept.video_text, ""};
  view.kept = kept.cameras;
  const auto sets_camera = [](const std::string& set) { return set.starts_with("view.camera"); };
  if (std::ranges::none_of(overrides, sets_camera)) view.recall_camera(scene.editor().source());
  if (!std::exchange(greeted_, true))
    messages.greet(
        "Space starts and pauses. Drag turns the view, the wheel zooms. Ctrl+drag pulls a body, B throws a "
        "ball. F1 lists all keys, Ctrl+P searches everything by name.",
        20.0);
  else if (simulation.pacer().speed() != 1.0)
    messages.info(fmt::format("The speed is ×{:g}, from the last session: + and - change it.{}",
                              simulation.pacer().speed(), layout.panels ? "" : " Tab shows the panels."),
                  10.0);
  else if (!layout.panels)
    messages.info("Tab shows the panels, F1 lists all keys.");
}

KeptState App::kept_state() const {
  KeptState kept;
  kept.layout = layout;
  kept.pace = simulation.pacer().pace();
  kept.speed = simulation.pacer().speed();
  kept.video_format = video.settings.format;
  kept.video_fps = video.settings.fps;
  kept.video_text = video.settings.text;
  kept.greeted = greeted_;
  kept.cameras = view.kept_with(scene.editor().source());
  return kept;
}

bool App::may_close() {
  if (closing == Closing::decided || !scene.editor().changed()) return true;
  open_page(Page::none);
  closing = Closing::asked;
  touch();
  return false;
}

std::string App::title() const {
  const std::filesystem::path source = scene.editor().source();
  return fmt::format("{}{} - Aspic", printable(source.filename().string()),
                     scene.editor().changed() ? " (changed)" : "");
}

bool App::idle() const {
  return !simulation.running() && !comparison.clock().others_run() && comparison.settled() &&
         !comparison.busy() && !image.refining() && !comparison_view.refining() &&
         std::min({still_for_, mouse_still_for_, scene.unchanged_for()}) > 0.5 &&
         shot_wanted_ == Shot::none && keys_.empty() && !scene.pending() &&
         !simulation.rebuild().changing() && !simulation.busy();
}

bool App::asleep() const {
  constexpr double rest = 1.5;  // s, by when tooltips have come
  return idle() && !touched_ && std::min(still_for_, mouse_still_for_) > rest && !gui_->takes_keyboard() &&
         !gui_->awake() && !video.recording() && video.completing() == 0 && !messages.fades();
}

bool App::doze(double dt) {
  const auto said = messages.notice() ? messages.notice()->text : std::string();
  scene.update(dt);
  if (!scene.pending() && (messages.notice() ? messages.notice()->text : "") == said && idle()) return false;
  touch();
  return true;
}

double App::wait(double since) const {
  constexpr double nap = 0.004;  // s
  if (idle()) return std::max(0.5 - since, 0.0);
  // Displays set the pace of hardware.
  if (!image.policy()) return 0.0;
  const bool nothing_new = !comparison.several() && simulation.busy() && !simulation.jobs().has_news() &&
                           !touched_ && !camera_moves_;
  const bool late = simulation.running() && simulation.pacer().late();
  return std::clamp(image.policy()->interval(nothing_new, late, frame_seconds_) - since, 0.0, nap);
}

// ---- events ----

void App::key(int key, int action, int modifiers) {
  touch();
  keys_.push_back({key, action, modifiers});
  deliver_keys();
}

void App::character(unsigned int code_point) {
  touch();
  keys_.push_back({.character = code_point});
  deliver_keys();
}

/// To the text field that has the keyboard, else to the command they belong to; some wait for the next
/// image.
void App::deliver_keys() {
  while (!keys_.empty() && gui_->ready_for(keys_.front())) {
    const KeyEvent event = keys_.front();
    keys_.pop_front();
    // F1 and those after it are in no text.
    const bool escapes =
        event.key == GLFW_KEY_ESCAPE && (files.is_open() || palette.is_open() || closing == Closing::asked);
    // While a page asks something no key is the window's.
    const bool asks = palette.is_open() || files.is_open() || closing == Closing::asked;
    const bool typing = (gui_->takes_keyboard() || asks) && !escapes &&
                        !(event.key >= GLFW_KEY_F1 && event.key <= GLFW_KEY_F25);
    if (event.character == 0 || typing) gui_->key(event);
    if (typing || (event.character == 0 && event.action == GLFW_RELEASE)) continue;
    if (event.character != 0) {
      if (cells.choose_by_digit(static_cast<char32_t>(event.character))) continue;
      commands_.on_character(static_cast<char32_t>(event.character));
    } else if (event.key == GLFW_KEY_ESCAPE && event.action == GLFW_PRESS) {
      help_visible = false;
      closing = Closing::no;
      files.close();
      palette.close();
      messages.dismiss();
    } else {
      commands_.on_key(printed_key(event.key), event.modifiers, event.action == GLFW_REPEAT);
    }
  }
}

void App::mouse_button(int button, int action, int modifiers) {
  touch();
  gui_->mouse_button(button, action);
  if (action != GLFW_RELEASE) return pointer.press(button, modifiers, gui_->takes_mouse());
  pointer.release(button);
  // A stroke over cells is a gesture of its own, whose end the next image sees.
  if (button == GLFW_MOUSE_BUTTON_LEFT && !cells.pointed()) scene.end_gesture();
}

void App::cursor(double x, double y) {
  mouse_still_for_ = 0.0;
  touched_ = true;
  // A mouse that only passes over leaves the image as it is, in full resolution.
  if (pointer.drags()) still_for_ = 0.0;
  gui_->cursor(x, y);
  pointer.move(x, y);
}

void App::scroll(double dx, double dy) {
  touch();
  if (!pointer.scroll(dy, gui_->takes_mouse())) gui_->scroll(dx, dy);
}

void App::drop(const std::vector<std::string>& paths) {
  touch();
  // Meshes become bodies of the scene that is open; of others the first is opened.
  const auto is_mesh = [](const std::string& path) { return names_mesh(path); };
  if (const auto other = std::ranges::find_if_not(paths, is_mesh); other != paths.end()) scene.open(*other);
  for (const std::string& path : paths)
    if (is_mesh(path)) add_mesh(scene, messages, path);
}

// ---- images ----

Status App::frame(const WindowSize& size, double dt) {
  gl::Context& context = image.context();
  if (context.lost()) return context.lost_error();
  if (size.pixel_width < 1 || size.pixel_height < 1 || size.width < 1 || size.height < 1) return {};
  messages.update(dt);
  touched_ = false;
  camera_moves_ = view.camera.update(dt);
  scene.update(dt);
  const double budget = image.policy() ? FramePolicy::step_seconds : FramePolicy::hardware_step_seconds;
  comparison_view.match_editor();
  comparison.lead();
  video.lead();
  if (comparison.clock().runs()) messages.greeting_is_over();
  ASPIC_CHECK(simulation.update(dt, budget));
  if (scene.finish_change()) image.postponed = true;
  if (const auto message = simulation.take_message()) messages.error(*message);
  video.update();
  ASPIC_CHECK(comparison.follow(dt, budget));
  comparison_view.update();
  run.watch_divergence();
  run.watch_run();
  const bool moves = simulation.running() || simulation.playback().seeking() ||
                     comparison.clock().others_run() || !comparison.settled();
  still_for_ = camera_moves_ || moves ? 0.0 : still_for_ + dt;
  mouse_still_for_ += dt;
  const bool taken = shot_wanted_ == Shot::window || (shot_wanted_ == Shot::image && comparison.several());
  image.at_rest = taken || std::min(still_for_, scene.unchanged_for()) > 0.25;
  image.at_once = taken;
  const auto start = std::chrono::steady_clock::now();
  const Status made = make_image(size, dt);
  frame_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return made;
}

/// Of several runs the image is the window's view of all, with their names.
Status App::save_shot(Shot wanted, const WindowSize& size, const std::string& path) {
  if (wanted == Shot::window) return save_pixels(0, {size.pixel_width, size.pixel_height}, path);
  if (!comparison.several()) return image.save(path);
  const auto pixels = [&](double length) {
    return static_cast<int>(std::lround(length * view.pixels_per_unit));
  };
  const int left = pixels(view.whole.left), bottom = size.pixel_height - pixels(view.whole.bottom);
  const ImageSize whole = {pixels(view.whole.right) - left,
                           pixels(view.whole.bottom) - pixels(view.whole.top)};
  return save_pixels(0, whole, path, left, bottom);
}

Status App::make_image(const WindowSize& size, double dt) {
  ASPIC_CHECK(image.follow());
  pointer.find_hovered();
  view.pixels_per_unit = size.pixels_per_unit();
  image.rate.count(dt);
  gui_->set_text_size(layout.text_size);
  gui_->begin(size, dt);
  view.text_scale = gui_->scale();
  draw_panels({*gui_, messages, simulation, view, scene, run, image, hands, video, pointer, layout, files,
               palette, comparison, comparison_view, closing, help_visible, cells, stability},
              size.width, size.height);
  if (std::exchange(view.recalled, false) && !view.sees_bodies(simulation.snapshot()))
    view.frame_bodies(simulation.model(), simulation.snapshot());
  comparison_view.share_colors();
  ASPIC_CHECK(image.show(size));
  ASPIC_CHECK(comparison_view.show(size));
  if (const auto refusal = image.take_refusal()) messages.error(*refusal);
  ASPIC_CHECK(pointer.mark_and_ask(gui_->takes_mouse()));
  gui_->end();
  deliver_keys();
  const Shot wanted = std::exchange(shot_wanted_, Shot::none);
  if (wanted == Shot::none) return {};
  const std::string path = free_name(scene.editor().source(), ".png");
  if (messages.check(save_shot(wanted, size, path))) messages.info(fmt::format("Saved as {}.", path));
  return {};
}

}  // namespace aspic::app

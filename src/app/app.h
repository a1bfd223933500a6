#pragma once
// The window's inside: scene, simulation, camera, panels and what keys and mouse do to them. Knows no window:
// events come through EventReceiver, pictures go to the current context's framebuffer 0.
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analysis/particle_force.h"
#include "analysis/stability.h"
#include "app/camera_control.h"
#include "app/film_pace.h"
#include "app/film_settings.h"
#include "app/gui.h"
#include "app/kept_state.h"
#include "app/resolution.h"
#include "app/scene_editor.h"
#include "app/simulation.h"
#include "app/window.h"
#include "base/printable.h"
#include "io/state_sink.h"
#include "render/camera.h"
#include "render/renderer.h"
#include "run/recording.h"

namespace aspic::app {

struct AppOptions {
  std::string scene = "cube-plane";     ///< file or built-in name
  std::vector<std::string> overrides;   ///< KEY=VALUE
  const BackendRow* backend = nullptr;  ///< null: what `auto` takes in the window's context
  KeptState kept = {};                  ///< how the window was last left
  bool full_quality = false;            ///< on a software rasteriser too, however long pictures take
};

/// A line to the user, on top of the picture until dismissed or replaced.
struct Notice {
  std::string text;
  bool is_error = false;
  double age = 0.0;  ///< [s]; what is no error goes by itself after a while
};

/// A particle under the mouse, or one that a hand pulls.
struct Hovered {
  std::uint32_t particle = 0;
  Vec3 position, velocity;  ///< [m], [m/s] at the snapshot's step
  ParticleForce force;      ///< [N] then
  double mass = 0.0;        ///< [kg]
  bool pinned = false;
};

/// How hands throw and pull.
struct HandSettings {
  double radius = 0.3;    ///< of a thrown ball [m], > 0
  double mass = 20.0;     ///< of a thrown ball [kg], > 0
  double speed = 15.0;    ///< of a thrown ball [m/s], ≥ 0
  double strength = 1.0;  ///< factor on the stiffness of a pull, > 0
};

class App final : public EventReceiver {
 public:
  /// `context` must outlive it and be current in every call. `scale` as of Gui. Errors: those of the scene,
  /// the solver and the renderer.
  static Result<std::unique_ptr<App>> create(gl::Context& context, const AppOptions& options, double scale,
                                             WindowServices services);
  ~App() override;

  void key(int key, int action, int modifiers) override;
  void character(unsigned int code_point) override;
  void mouse_button(int button, int action, int modifiers) override;
  void cursor(double x, double y) override;
  void scroll(double dx, double dy) override;
  void drop(const std::vector<std::string>& paths) override;

  /// One picture, `dt` ≥ 0 after the last [s]. Error (no_device): the context was lost; another window can
  /// take the app on then (replace_window).
  Status frame(const WindowSize& size, double dt);
  /// Lets go of all that the context holds, while it is still current: films are completed as far as they
  /// came, a run on the gpu goes on on the reference from the last copy, and a notice will say so.
  Status release_context(const Error& why);
  /// Takes on another context, current from now on, after release_context(). Errors as create().
  Status adopt_context(gl::Context& context, double scale, WindowServices services);
  /// Nothing moves: the next picture would be the same but for events.
  bool idle() const;
  std::string title() const;

  // ---- what keys, buttons and menus do ----
  void toggle_running();
  void single_step();
  void reset();
  void change_speed(double factor);
  void toggle_backend();
  /// Opens a file or built-in scene; on an error the old one stays and a notice says why.
  void open(const std::string& source);
  void open_neighbour(int offset);
  void reload();
  void save_as(const std::string& path);
  void undo();
  void redo();
  void frame_bodies();
  void copy_camera();
  void paste_camera();
  void take_screenshot() { screenshot_wanted_ = true; }
  /// Films the scene from now on, in step with simulated time, as film_settings() say: see FilmPace. A notice
  /// says what went wrong.
  void start_recording();
  /// The film is completed in the background; a notice tells when.
  void stop_recording();
  void toggle_recording();
  const Recording* recording() const { return recording_.get(); }
  FilmSettings& film_settings() { return film_settings_; }
  /// Films that have ended and are not complete yet.
  std::size_t films_completing() const { return completing_.size(); }
  /// Writes the state at hand, or with a format over time the energies of the plot, to a new file (empty: a
  /// free name). A notice says what became of it.
  void save_output(const StateFormat& format, std::string path);
  /// Ends the film under way and waits for all; what there is to say of each.
  std::vector<std::string> finish_films();
  // ---- time: the scene's values go back and forth with it, for they are part of the run ----
  void step_back();
  /// Half a second of simulated time.
  void jump_back();
  /// To the moment nearest to a time of the history [s]; paused.
  void go_to(double time);
  void back_before_trouble();
  void take_stable_step();
  // ---- hands ----
  /// Throws balls from the camera at what is under the mouse, or in the middle of the picture.
  void throw_ball();
  void throw_many();
  void clear_balls();
  void toggle_pin(std::uint32_t particle);
  void toggle_shadow();
  /// Shadows on terrain, in the window alone.
  bool& shadows() { return shadows_; }
  void toggle_panels() { layout_.panels = !layout_.panels; }
  void toggle_help() { help_visible_ = !help_visible_; }
  void toggle_full_screen();
  void set_value(const Parameter& parameter, std::size_t index, const Value& value,
                 const std::string& gesture);
  void apply(Scene scene, const std::string& name, const std::string& gesture);
  void dismiss_notice() { notice_.reset(); }

  Simulation& simulation() { return *simulation_; }
  const SceneEditor& editor() const { return editor_; }
  CameraControl& camera() { return camera_; }
  Gui& gui() { return *gui_; }
  const gl::DeviceInfo& device() const { return context_->info(); }
  bool panels_visible() const { return layout_.panels; }
  Layout& layout() { return layout_; }
  /// How things stand, for the next time; the window's own place is not known here.
  KeptState kept_state() const;
  bool help_visible() const { return help_visible_; }
  const std::optional<Notice>& notice() const { return notice_; }
  const std::optional<Hovered>& hovered() const { return hovered_; }
  /// Whether pictures keep their full resolution on a software rasteriser too; samples stay as they are.
  void set_full_quality(bool on) { full_quality_ = on; }
  /// What tells the time between clicks [s]; for tests, which do not wait.
  void set_clock(std::function<double()> clock) { clock_ = std::move(clock); }
  /// Ball, speed and stiffness of hands, as the panels set them.
  HandSettings& hands() { return hands_; }
  /// The largest stable step, while a divergence stands.
  const std::optional<StabilityLimit>& stable_step() const { return stable_; }
  /// Where the scene is drawn [window units].
  const Box& viewport() const { return viewport_; }
  /// The scene's part of the picture's pixels, 0…1: below 1 where a software rasteriser would be too slow.
  double draw_scale() const { return draws_in_full() ? 1.0 : resolution_.share(false); }
  double draw_seconds() const { return draw_seconds_; }
  double pictures_per_second() const { return pictures_per_second_; }

 private:
  App(gl::Context& context, SceneEditor editor)
      : context_(&context), editor_(std::move(editor)), camera_(editor_.scene().view.camera) {}
  Status make_pictures(double scale, WindowServices services);
  void take_effect(Effect effect);
  void request_changes();
  void end_change();
  void tell(const std::string& text, bool is_error = false) { notice_ = Notice{printable(text), is_error}; }
  void tell(const Status& status);
  void scene_replaced();
  void read_again();
  void watch_file(double dt);
  void watch_divergence();
  void take_on(const KeptState& kept, const std::vector<std::string>& overrides);
  void keep_camera();
  void recall_camera();
  Status draw_scene(const WindowSize& size);
  Status draw_picture(int width, int height);
  void film();
  void watch_films();
  void end_film();
  bool is_still() const { return !simulation_->running() && !simulation_->seeking() && still_ > 0.25; }
  void find_hovered();
  void describe(std::uint32_t particle);
  Status ask_what_is_under_mouse();
  Status present_ring();
  bool is_double_click();
  bool draws_in_full() const { return full_quality_ || !context_->info().is_software; }
  void centre_on(const Picked& picked);
  HighlightOptions marks(int width) const;
  void save_screenshot(const WindowSize& size);
  void drag(double dx, double dy);
  void follow_history();
  void begin_pull();
  void move_pull();
  void end_pull();
  BallSettings thrown_ball(double x, double y) const;
  Camera view_camera() const;

  gl::Context* context_;  // null between release_context() and adopt_context()
  SceneEditor editor_;
  CameraControl camera_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<Gui> gui_;
  Layout layout_;
  std::vector<KeptCamera> cameras_;
  FilmSettings film_settings_;
  std::unique_ptr<Recording> recording_;
  std::optional<FilmPace> film_pace_;
  std::string filmed_scene_;
  std::vector<std::unique_ptr<Recording>> completing_;

  std::optional<Notice> notice_;
  std::optional<StabilityLimit> stable_;
  bool divergence_told_ = false;
  Effect pending_ = Effect::none, requested_ = Effect::none;
  double rebuild_seconds_ = 0.0, since_rebuild_ = 0.0;
  std::chrono::steady_clock::time_point requested_at_ = {};
  bool help_visible_ = false, screenshot_wanted_ = false, rest_a_picture_ = false;

  Box viewport_;
  double mouse_x_ = -1.0, mouse_y_ = -1.0;
  int drag_button_ = -1;
  bool drag_pans_ = false;
  std::optional<Hovered> hovered_;
  std::optional<SpringFinder> incident_;  // of the model with that number
  std::uint64_t incident_model_ = 0;
  /// What was asked about a place of a picture.
  struct Question {
    double x = 0.0, y = 0.0;
    std::uint64_t picture = 0, first = 0, last = 0;  // requests since the mouse came here
  };
  std::optional<Question> asked_;
  bool centre_wanted_ = false;
  std::function<double()> clock_;
  double pressed_time_ = -1e9, pressed_x_ = 0.0, pressed_y_ = 0.0;  // the last press that was no double one
  HandSettings hands_;
  std::uint32_t thrown_ = 0;  // balls so far: each of many flies its own way
  Vec3 pull_plane_;           // a point of the plane, square to the view, in which the anchor moves [m]

  std::uint64_t drawn_model_ = ~std::uint64_t{0}, drawn_state_ = ~std::uint64_t{0};
  std::string drawn_terrain_;
  ViewSettings drawn_view_;
  HighlightOptions drawn_marks_;
  bool shadows_ = true, drawn_shadows_ = true;
  std::uint64_t pictures_drawn_ = 0;
  Box shown_;                 // where the picture is shown [window units]
  int shown_pixels_[4] = {};  // and in pixels: left, bottom, width, height
  int drawn_width_ = 0, drawn_height_ = 0;
  double pixels_per_unit_ = 1.0;
  bool full_quality_ = false;
  Resolution resolution_;
  std::uint32_t drawn_particles_ = 0;
  double draw_seconds_ = 0.0, still_ = 0.0, awake_ = 0.0;
  double since_file_look_ = 0.0, rate_time_ = 0.0, pictures_per_second_ = 0.0;
  int rate_pictures_ = 0;
};

}  // namespace aspic::app

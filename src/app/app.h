#pragma once
// The window's inside: puts its parts together, hands events to them and makes the images. Knows no window:
// events come through EventReceiver, images go to the current context's framebuffer 0.
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "app/cell_editor.h"
#include "app/commands.h"
#include "app/comparison_view.h"
#include "app/file_dialog.h"
#include "app/gui.h"
#include "app/hands.h"
#include "app/kept_state.h"
#include "app/messages.h"
#include "app/panels.h"
#include "app/pointer.h"
#include "app/run_control.h"
#include "app/scene_control.h"
#include "app/scene_image.h"
#include "app/video.h"
#include "app/view.h"
#include "app/window.h"
#include "playback/playback_session.h"
#include "playback/stability_map.h"

namespace aspic::app {

struct AppOptions {
  std::string scene = "cube-plane";     ///< file or built-in name
  std::vector<std::string> overrides;   ///< KEY=VALUE
  std::string replay = {};              ///< a file of inputs that the run has; empty: none
  const BackendRow* backend = nullptr;  ///< null: what `auto` takes in the window's context
  BackendChoice asked = {};             ///< of backends that have it; its row does not matter
  KeptState kept = {};                  ///< how the window was last left
  bool full_quality = false;            ///< on a software rasterizer too, however long images take
  WidgetWatcher* watcher = nullptr;     ///< sees the panels' widgets; must outlive the app
};

/// Each part is public, for tests and tools; what they do together is here.
class App final : public EventReceiver {
 public:
  /// `context` must outlive it and be current in every call. `scale` as of Gui. Errors: those of the scene,
  /// the solver and the renderer.
  static Result<std::unique_ptr<App>> create(gl::Context& context, const AppOptions& options, double scale,
                                             WindowServices services);

  void key(int key, int action, int modifiers) override;
  void character(unsigned int code_point) override;
  void mouse_button(int button, int action, int modifiers) override;
  void cursor(double x, double y) override;
  void scroll(double dx, double dy) override;
  void drop(const std::vector<std::string>& paths) override;
  void refresh() override { touch(); }

  /// One image, `dt` ≥ 0 after the last [s]. Error (no_device): the context was lost; another window can
  /// take the app on then (replace_window).
  Status frame(const WindowSize& size, double dt);
  /// Releases all that the context holds, while it is still current: videos are completed as far as they
  /// came, a run that needs the context continues on the processor from the last copy, and a message will
  /// say so.
  Status release_context(const Error& why);
  /// Continues in another context, current from now on, after release_context(). Errors as create().
  Status adopt_context(gl::Context& context, double scale, WindowServices services);
  /// Nothing moves: the next image would be the same but for events.
  bool idle() const;
  /// The next frame would be identical: there is no need to draw it. Then doze() instead,
  /// `dt` ≥ 0 after the last call [s], which looks at the scene's file; true if there is something to show
  /// again.
  bool asleep() const;
  bool doze(double dt);
  /// How long to wait for events before the next image, `since` the last one [s]; 0: none, it is due.
  double wait(double since) const;
  std::string title() const;
  /// The window was asked to close. False if there are changes that would be lost: a page asks then, and a
  /// second request is an answer.
  bool may_close();
  /// That page was answered: the window closes.
  bool closes() const { return closing == Closing::decided; }
  /// What to remember for the next time; the window's own place is not known here.
  KeptState kept_state() const;
  Gui& gui() { return *gui_; }

 private:
  std::unique_ptr<PlaybackSession> simulation_;
  Commands commands_;
  std::unique_ptr<Gui> gui_;  // none between release_context() and adopt_context()
  WidgetWatcher* watcher_;

 public:
  Messages messages;
  PlaybackSession& simulation;
  View view;
  SceneControl scene;
  RunControl run;
  SceneImage image;
  Hands hands;
  Comparison comparison;
  ComparisonView comparison_view;
  Video video;
  Pointer pointer;
  Layouts layout;
  FileDialog files;
  Palette palette;
  CellEditor cells;
  StabilityMap stability;  // kept while its section is closed
  Closing closing = Closing::no;
  bool help_visible = false;

 private:
  App(const AppOptions& options, SceneEditor editor, std::unique_ptr<PlaybackSession> simulation);
  Status attach(gl::Context& context, double scale, WindowServices services);
  std::vector<Command> make_commands();
  void deliver_keys();
  void follow_hovered();
  void go_back(double time);
  enum class Page { none, help, palette, files };
  void open_page(Page page);
  void ask_for_scene();
  void ask_for_mesh();
  void edit_hovered_cells();
  void ask_where_to_save();
  Status make_image(const WindowSize& size, double dt);
  enum class Shot { none, image, window };
  Status save_shot(Shot wanted, const WindowSize& size, const std::string& path);
  void touch() {
    still_for_ = 0.0;
    touched_ = true;
  }
  void restore(const KeptState& kept, const std::vector<std::string>& overrides);

  std::deque<KeyEvent> keys_;  // that came and were not delivered
  Shot shot_wanted_ = Shot::none;
  bool camera_moves_ = false;
  /// Since something moved, and since the mouse did [s].
  double still_for_ = 0.0, mouse_still_for_ = 0.0;
  bool greeted_ = false;        // what the keys are was said
  double frame_seconds_ = 0.0;  // the last image with its panels
  bool touched_ = false;        // by an event since then
};

}  // namespace aspic::app

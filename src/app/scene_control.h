#pragma once
// The scene that is open, kept in step with its simulation: opening, changing, undo, and the file on disk.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/messages.h"
#include "app/scene_editor.h"
#include "app/view.h"
#include "playback/playback_session.h"

namespace aspic::app {

class SceneControl {
 public:
  /// The references must outlive it. The simulation runs the editor's scene.
  SceneControl(SceneEditor editor, PlaybackSession& simulation, View& view, Messages& messages)
      : editor_(std::move(editor)), simulation_(simulation), view_(view), messages_(messages) {
    list_file();
  }

  const SceneEditor& editor() const { return editor_; }
  const Scene& scene() const { return editor_.scene(); }
  const Solver& solver() const { return simulation_.present().solver(); }

  /// Opens a file or built-in scene, which undo() takes back; on an error the old one stays and a message
  /// says why. A file of inputs is one for open_inputs().
  void open(const std::string& source);
  /// The scene starts again, with the inputs of a file at their steps until another scene is opened, or this
  /// one again. On an error all stays as it was and a message says why.
  void open_inputs(const std::string& path);
  /// Scene files and checkpoints that were opened or saved, in that order.
  const std::vector<std::string>& files() const { return files_; }
  /// Opens the built-in scene that comes so many places later in the list, which goes round.
  void open_neighbor(int offset);
  void reload();
  /// The file is the one that is open from then on.
  void save_as(const std::string& path, Overwrite overwrite = Overwrite::refuse);
  void undo();
  void redo();

  /// Changes the scene: see SceneEditor. A message says why a change is refused.
  void set_value(const Parameter& parameter, std::size_t index, const Value& value,
                 const std::string& gesture = "");
  void apply(Scene scene, const std::string& name, const std::string& gesture = "");
  void change(const std::string& name, const std::function<void(Scene&)>& make,
              const std::string& gesture = "");
  /// Says something of the change just made, also once the simulation has taken it.
  void tell(const std::string& sentences);
  /// The runs that are compared with the scene's own: see SceneEditor.
  void set_differences(std::vector<Difference> differences, const std::string& name) {
    editor_.set_differences(std::move(differences), name);
    unchanged_for_ = 0.0;
  }
  /// The next change is another entry for undo.
  void end_gesture() { editor_.end_gesture(); }
  /// Goes back or forth in time with the simulation: the physics of the scene is part of the run. A change
  /// that can be undone.
  void follow_history();

  /// The simulation gets the constants of the scene as it is, whatever it has now.
  void hand_over() { pending_ = std::max(pending_, Effect::constants); }

  /// Once for each image, `dt` after the last [s]: looks at the file and hands changes to the simulation.
  void update(double dt);
  /// After the simulation's own update: how a change ended. True if it took noticeable time.
  bool finish_change();
  /// Changes wait for the simulation.
  bool pending() const { return pending_ != Effect::none; }
  /// Since the scene was last changed [s].
  double unchanged_for() const { return unchanged_for_; }

 private:
  void take_effect(Result<Effect> effect);
  void say_if_gone(const std::optional<std::string>& followed);
  void say_beside(const std::string& first);
  void show_opened(const std::string& left);
  bool undone(Effect effect, const std::string& left, Effect (SceneEditor::*back)());
  void reread_file();
  void take_back_refused();
  void adopt_running(const std::string& name);
  Effect effect_on_running() const;

  void list_file();

  SceneEditor editor_;
  std::vector<std::string> files_;
  PlaybackSession& simulation_;
  View& view_;
  Messages& messages_;
  std::string beside_;  // what to say besides the end of a change
  Effect pending_ = Effect::none, requested_ = Effect::none;
  /// The editor's last change that the simulation has, and the last one that it was asked for.
  std::uint64_t taken_ = 0, requested_change_ = 0;
  bool had_moved_ = false;  // when the change was requested
  double rebuild_seconds_ = 0.0, since_rebuild_ = 0.0, since_file_look_ = 0.0, unchanged_for_ = 0.0;
  std::chrono::steady_clock::time_point requested_at_ = {};
};

}  // namespace aspic::app

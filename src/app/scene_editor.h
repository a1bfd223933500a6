#pragma once
// The scene that is shown and changed: where it came from, what was changed, and the way back.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "aspic/inputs.h"
#include "aspic/scene.h"
#include "aspic/state.h"
#include "base/result.h"
#include "io/atomic_file.h"
#include "playback/effect.h"
#include "scene/parameters.h"
#include "variants/variant.h"

namespace aspic::app {

class SceneEditor {
 public:
  /// Loads a scene as aspic run does, or the scene of a checkpoint (.aspic). Errors: those of load_scene, and
  /// of read_checkpoint.
  static Result<SceneEditor> open(const std::string& source, std::vector<std::string> overrides);

  const Scene& scene() const { return scene_; }
  /// File or built-in name.
  const std::string& source() const { return origin_->source; }
  bool is_file() const { return origin_->modified.has_value(); }
  /// What a checkpoint holds besides its scene: where the run continues.
  const std::optional<State>& state() const { return origin_->state; }
  /// Its run's inputs, of later steps too.
  const InputLog& inputs() const { return origin_->inputs; }
  /// Since it was opened, saved or read again.
  bool changed() const { return undo_.size() != origin_->saved; }

  /// An editor of another source, or of the same one again, whose overrides (--set) stay with it. Errors:
  /// those of load_scene.
  Result<SceneEditor> other(const std::string& source) const;
  /// Opens what another editor has open; undo() comes back to what there was, with its changes. Where that is
  /// the same source and scene, unchanged, there is nothing to come back to.
  void open(SceneEditor other);
  /// Whether the file was written since it was last looked at; true once for each time.
  bool file_changed();

  /// Sets one value. Changes with the same `gesture` (a slider under the mouse; not empty) are one for undo.
  /// Where the body or ball that the camera follows is no more, it follows nothing. Error (scene_rejected):
  /// what the scene checks say; nothing changes.
  Result<Effect> set(const Parameter& parameter, std::size_t index, const Value& value,
                     const std::string& gesture);
  /// Replaces the scene, under a name for undo. Errors as set.
  Result<Effect> apply(Scene scene, const std::string& name, const std::string& gesture);
  /// In what the runs compared with the scene's own differ from it; no part of the scene's file.
  const std::vector<Difference>& differences() const { return differences_; }
  /// Replaces that, under a name for undo.
  void set_differences(std::vector<Difference> differences, const std::string& name);
  /// The next change begins a new entry, whatever its gesture.
  void end_gesture() { gesture_.clear(); }

  bool can_undo() const { return !undo_.empty(); }
  bool can_redo() const { return !redo_.empty(); }
  /// What undo() would take back; legal while can_undo().
  const std::string& undo_name() const { return undo_.back().name; }
  const std::string& redo_name() const { return redo_.back().name; }
  /// Legal while can_undo() and can_redo().
  Effect undo();
  Effect redo();

  /// The number of the last change, undo or redo.
  std::uint64_t last_change() const { return last_change_; }
  /// Takes back the changes of what is simulated numbered above `after`, up to `last`, since the scene was
  /// opened. Later changes stay unless they depend on these. Returns whether there were any.
  bool withdraw(std::uint64_t after, std::uint64_t last);

  /// Writes the scene as it is now, as a person would, with this camera; the file is the one that is open
  /// from then on. Error (io): it exists and may not be overwritten, or cannot be written.
  Status save_as(const std::string& path, const CameraSettings& camera, Overwrite overwrite);
  /// The scene is what the file holds.
  void mark_saved() {
    origin_->saved = undo_.size();
    end_gesture();
  }

 private:
  /// What was opened.
  struct Origin {
    std::string source;
    std::vector<std::string> overrides;
    std::optional<State> state;
    InputLog inputs;
    std::optional<std::filesystem::file_time_type> modified;
    std::size_t saved =
        0;  ///< length of undo_ when the scene was the file's; never again: the largest number
  };
  struct Entry {
    Scene scene;
    std::vector<Difference> differences;
    std::string name;
    std::shared_ptr<Origin> origin;  ///< of all entries since it was opened
    std::uint64_t number = 0;        ///< last_change() with it
  };
  void forget_oldest();
  Scene& scene_after(std::size_t entry) { return entry + 1 < undo_.size() ? undo_[entry + 1].scene : scene_; }
  bool remove_entry(std::size_t index);
  void begin_entry(const std::string& name, const std::string& gesture);
  Effect swap_with(std::vector<Entry>& from, std::vector<Entry>& to);

  Scene scene_;
  std::vector<Difference> differences_;
  std::string gesture_;
  std::uint64_t last_change_ = 0;
  std::shared_ptr<Origin> origin_ = std::make_shared<Origin>();  // never null
  std::vector<Entry> undo_, redo_;
};

}  // namespace aspic::app

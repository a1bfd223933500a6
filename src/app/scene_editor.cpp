#include "app/scene_editor.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "aspic/scene.h"
#include "base/memory.h"
#include "command_line/arguments.h"
#include "io/atomic_file.h"
#include "io/checkpoint.h"
#include "model/bodies.h"
#include "scene/follow.h"
#include "scene/scene_checks.h"
#include "scene/write.h"

namespace aspic::app {
namespace {

/// More than anyone goes back.
constexpr std::size_t longest_past = 256;

/// "structural stiffness": a key as people call it, with what it belongs to where that is more than a list.
std::string words_of(const Parameter& p) {
  std::string words(p.path.substr(p.path.find("].") == std::string_view::npos ? p.path.find('.') + 1
                                                                              : p.path.find("].") + 2));
  std::ranges::replace(words, '.', ' ');
  std::ranges::replace(words, '-', ' ');
  return words;
}

std::optional<std::filesystem::file_time_type> time_of(const std::string& path) {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(path, error);
  return error ? std::nullopt : std::optional(time);
}

/// `scene` with all values that changed from `before` to `after` as they were before. Nothing where it has
/// other bodies or lists, or where the result would not be a legal scene.
std::optional<Scene> without_change(Scene scene, const Scene& before, const Scene& after) {
  const auto same_size = [&](const SettingsList& list) {
    const std::size_t size = list.size(scene.model);
    return list.size(before.model) == size && list.size(after.model) == size;
  };
  if (!std::ranges::all_of(body_rows(), same_size, &BodyRow::list) ||
      !std::ranges::all_of(settings_lists(), same_size))
    return std::nullopt;
  for (const Parameter& p : parameters()) {
    for (std::size_t i = 0; i < index_count(p, before); ++i) {
      const auto old = p.get(before, i), changed = p.get(after, i);
      if (old == changed || p.get(scene, i) != changed) continue;
      if (old)
        p.set(scene, i, *old);
      else if (p.can_be_absent())
        p.clear(scene, i);
      if (p.get(scene, i) != old) return std::nullopt;
    }
  }
  if (!check_scene(scene, available_memory()).empty()) return std::nullopt;
  return scene;
}

}  // namespace

Result<SceneEditor> SceneEditor::open(const std::string& source, std::vector<std::string> overrides) {
  SceneEditor editor;
  if (source.ends_with(".aspic")) {
    ASPIC_TRY(auto checkpoint, read_checkpoint(source));
    ASPIC_TRY(editor.scene_, parse_scene(checkpoint.scene, source, overrides, by_set));
    ASPIC_CHECK(check_against_scene(checkpoint, editor.scene_.model, source));
    if (!checkpoint.inputs.empty()) {
      ASPIC_TRY(const Model model, build_model(editor.scene_.model));
      ASPIC_TRY(editor.origin_->inputs,
                parse_inputs(checkpoint.inputs, source, {editor.scene_.model, model}));
    }
    editor.origin_->state = std::move(checkpoint.state);
  } else {
    ASPIC_TRY(editor.scene_, load_scene(source, overrides, by_set));
  }
  editor.origin_->source = source;
  editor.origin_->overrides = std::move(overrides);
  if (!builtin_scene_text(source)) editor.origin_->modified = time_of(source);
  return editor;
}

Result<SceneEditor> SceneEditor::other(const std::string& source) const {
  return open(source, source == origin_->source ? origin_->overrides : std::vector<std::string>{});
}

void SceneEditor::open(SceneEditor other) {
  const bool same = origin_->source == other.source() && !changed() && differences_ == other.differences_ &&
                    effect_between(scene_, other.scene_) == Effect::none;
  if (same) return;
  begin_entry("open " + std::filesystem::path(other.source()).filename().string(), "");
  scene_ = std::move(other.scene_);
  differences_ = std::move(other.differences_);
  origin_ = std::move(other.origin_);
  mark_saved();
}

bool SceneEditor::file_changed() {
  if (!origin_->modified) return false;
  const auto now = time_of(origin_->source);
  if (!now || *now == *origin_->modified) return false;
  origin_->modified = now;
  return true;
}

Result<Effect> SceneEditor::set(const Parameter& parameter, std::size_t index, const Value& value,
                                const std::string& gesture) {
  if (const auto complaint = check_value(parameter, value))
    return Error{ErrorCode::scene_rejected, complaint->message};
  Scene changed = scene_;
  parameter.set(changed, index, value);
  return apply(std::move(changed), words_of(parameter), gesture);
}

Result<Effect> SceneEditor::apply(Scene changed, const std::string& name, const std::string& gesture) {
  const Effect effect = effect_between(scene_, changed);
  if (effect == Effect::none) return effect;
  auto& follow = changed.view.follow;
  if (follow == scene_.view.follow && follow && !find_followed(changed.model, *follow)) follow.reset();
  if (const auto complaints = check_scene(changed, available_memory()); !complaints.empty()) {
    std::string message;
    for (const SceneComplaint& complaint : complaints)
      message += (message.empty() ? "" : "\n") + complaint.message;
    return Error{ErrorCode::scene_rejected, message};
  }
  begin_entry(name, gesture);
  scene_ = std::move(changed);
  return effect;
}

void SceneEditor::set_differences(std::vector<Difference> differences, const std::string& name) {
  begin_entry(name, "");
  differences_ = std::move(differences);
}

constexpr auto never = std::numeric_limits<std::size_t>::max();

/// What is there now is what undo() comes back to, unless the gesture goes on.
void SceneEditor::begin_entry(const std::string& name, const std::string& gesture) {
  if (gesture.empty() || gesture != gesture_ || undo_.empty()) {
    if (origin_->saved > undo_.size()) origin_->saved = never;
    if (undo_.size() == longest_past) forget_oldest();
    undo_.push_back({scene_, differences_, name, origin_});
  }
  undo_.back().number = ++last_change_;
  gesture_ = gesture;
  redo_.clear();
}

void SceneEditor::forget_oldest() {
  undo_.erase(undo_.begin());
  std::vector<Origin*> origins = {origin_.get()};
  for (const Entry& entry : undo_) {
    if (std::ranges::find(origins, entry.origin.get()) == origins.end())
      origins.push_back(entry.origin.get());
  }
  for (Origin* const origin : origins) {
    if (origin->saved != never) origin->saved = origin->saved == 0 ? never : origin->saved - 1;
  }
}

Effect SceneEditor::swap_with(std::vector<Entry>& from, std::vector<Entry>& to) {
  Entry entry = std::move(from.back());
  from.pop_back();
  const Effect effect = entry.origin == origin_ ? effect_between(scene_, entry.scene) : Effect::opening;
  to.push_back({std::move(scene_), std::move(differences_), entry.name, std::move(origin_), ++last_change_});
  scene_ = std::move(entry.scene);
  differences_ = std::move(entry.differences);
  origin_ = std::move(entry.origin);
  gesture_.clear();
  return effect;
}

Effect SceneEditor::undo() {
  return swap_with(undo_, redo_);
}

Effect SceneEditor::redo() {
  return swap_with(redo_, undo_);
}

/// Takes back the change of an entry that is not the last one. False: a later one depends on it.
bool SceneEditor::remove_entry(std::size_t index) {
  std::vector<Scene> later;
  for (std::size_t i = index + 1; i < undo_.size(); ++i) {
    auto scene = without_change(scene_after(i), undo_[index].scene, scene_after(index));
    if (!scene) return false;
    later.push_back(std::move(*scene));
  }
  undo_[index + 1].scene = std::move(undo_[index].scene);
  undo_.erase(undo_.begin() + static_cast<std::ptrdiff_t>(index));
  for (std::size_t i = 0; i < later.size(); ++i) scene_after(index + i) = std::move(later[i]);
  if (origin_->saved > index) origin_->saved = never;
  return true;
}

bool SceneEditor::withdraw(std::uint64_t after, std::uint64_t last) {
  bool any = false;
  for (std::size_t i = undo_.size(); i-- > 0 && undo_[i].origin == origin_;) {
    const Entry& entry = undo_[i];
    if (entry.number <= after || entry.number > last ||
        effect_between(entry.scene, scene_after(i)) < Effect::constants)
      continue;
    any = true;
    if (i + 1 < undo_.size() && remove_entry(i)) continue;
    while (undo_.size() > i) undo();
  }
  return any;
}

Status SceneEditor::save_as(const std::string& path, const CameraSettings& camera, Overwrite overwrite) {
  Scene saved = scene_;
  saved.view.camera = camera;
  saved.view.aimed = false;
  ASPIC_TRY(auto file, AtomicFile::create(path, overwrite));
  ASPIC_CHECK(file.write(to_short_toml(saved)));
  ASPIC_CHECK(file.commit());
  scene_ = std::move(saved);
  origin_->source = path;
  origin_->overrides.clear();
  origin_->state.reset();
  origin_->inputs = {};
  origin_->modified = time_of(path);
  mark_saved();
  return {};
}

}  // namespace aspic::app

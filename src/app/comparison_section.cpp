// The section of runs compared, and the names on their images.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "app/comparison_view.h"
#include "app/panels.h"
#include "app/parameter_widget.h"
#include "base/printable.h"
#include "model/integrator.h"
#include "render/color_map.h"
#include "run/backends.h"
#include "scene/parameters.h"
#include "scene/short_keys.h"
#include "scene/write.h"
#include "variants/variant.h"

namespace aspic::app {
namespace {

/// What can differ: short names and the backend first, then every key of the scene.
std::vector<std::string> keys_of(const Scene& scene) {
  std::vector<std::string> keys;
  for (const ShortKey& key : short_keys())
    if (!key.targets(scene).empty()) keys.emplace_back(key.name);
  keys.emplace_back(backend_key);
  for (const Parameter& p : parameters()) {
    if (p.only_shown()) continue;
    for (std::size_t i = 0; i < index_count(p, scene); ++i)
      if (applies(p, scene, i)) keys.push_back(path_text(p.path, i));
  }
  return keys;
}

/// The words a key takes, as they are written and as they are read; none: it takes numbers and the like.
struct Words {
  std::vector<std::string_view> names, titles;
};
Words words_for(std::string_view key, const Scene& scene) {
  Words words;
  if (key == backend_key) {
    for (const BackendRow& row : backends()) {
      words.names.push_back(row.name);
      words.titles.push_back(row.title);
    }
    return words;
  }
  const ShortKey* const row = find_short_key(key);
  const auto place = row ? place_of(scene, *row) : place_of(key);
  if (place && place->parameter->type == ParameterType::word)
    words = {place->parameter->words, titles_of(*place->parameter)};
  return words;
}

/// The present value as text that a difference takes.
std::string present(std::string_view key, const Scene& scene, const PlaybackSession& leader) {
  if (key == backend_key) return std::string(next_backend(leader.present().backend()).name);
  const ShortKey* const row = find_short_key(key);
  const auto place = row ? place_of(scene, *row) : place_of(key);
  const auto value = place ? place->parameter->get(scene, place->index) : std::nullopt;
  if (!value) return "0";
  if (const auto* word = std::get_if<std::string>(&*value)) return *word;
  return toml_value(*value);
}

/// Key and value of run i ≥ 1.
void difference_widget(Gui& gui, ComparisonView& comparison_view, const Scene& scene, std::size_t i,
                       const Difference& own) {
  const std::vector<std::string> keys = keys_of(scene);
  std::vector<std::string> titles;
  for (const std::string& key : keys) titles.push_back(title_of(key));
  const std::vector<std::string_view> names(keys.begin(), keys.end()), labels(titles.begin(), titles.end());
  auto index = static_cast<std::size_t>(std::ranges::find(keys, own.key) - keys.begin());
  label_column("Differs in");
  if (choice(gui, fmt::format("comparison/{}/key", i), names, labels, index,
             "Sets the one difference to the scene's own run. Restarts all runs."))
    return comparison_view.set(
        i, {keys[index], present(keys[index], scene, comparison_view.comparison().run(0))});
  label_column("Value");
  const std::string name = fmt::format("comparison/{}/value", i);
  if (const Words words = words_for(own.key, scene); !words.names.empty()) {
    auto word = static_cast<std::size_t>(std::ranges::find(words.names, own.value) - words.names.begin());
    if (choice(gui, name, words.names, words.titles, word, "Sets the value of this run. Restarts all runs."))
      comparison_view.set(i, {own.key, std::string(words.names[word])});
    return;
  }
  std::string text = own.value;
  const bool entered = ImGui::InputText("##value", &text, ImGuiInputTextFlags_EnterReturnsTrue);
  named(gui, name, "Sets the value of this run. Enter restarts all runs.");
  if (entered) comparison_view.set(i, {own.key, text});
}

constexpr ImGuiWindowFlags label_flags =
    ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_AlwaysAutoResize |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
    ImGuiWindowFlags_NoBringToFrontOnFocus;

}  // namespace

void comparison_section(Gui& gui, SceneControl& scene, ComparisonView& comparison_view) {
  const Comparison& comparison = comparison_view.comparison();
  const std::vector<Difference> differences = scene.editor().differences();
  for (std::size_t i = 1; i <= differences.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(ComparisonView::packed_color(i)), "Run %zu", i + 1);
    ImGui::SameLine();
    const bool removed = button(gui, fmt::format("comparison/{}/remove", i).c_str(), "Remove",
                                "Ends this run. The others continue.");
    if (removed)
      comparison_view.remove(i);
    else
      difference_widget(gui, comparison_view, scene.scene(), i, differences[i - 1]);
    ImGui::PopID();
    if (removed) return;
  }
  const float half = share_of_line(2);
  command_button(gui, "comparison/add", differences.empty() ? "Compare side by side" : "Add a run",
                 "Adds a run with one different value. Limit: four runs.", "add a run side by side",
                 differences.size() + 1 < most_compared, differences.empty() ? 0.0f : half);
  if (!differences.empty()) {
    ImGui::SameLine();
    command_button(gui, "comparison/leave", "Leave", "Closes the comparison and keeps the scene's own run.",
                   "close the comparison", true, half);
  }
  if (comparison.clock().others_go_on())
    ImGui::TextWrapped("The scene's own run diverged; the others continue. Space pauses them.");
  command_button(gui, "comparison/ghost", "Keep as ghost",
                 "Shows the run so far as a pale overlay after Reset.", "keep this run as ghost", true, half);
  ImGui::SameLine();
  command_button(gui, "comparison/no-ghost", "Removes the ghost.", "Shows the run without its ghost.",
                 "remove the ghost", comparison.ghost() != nullptr, half);
  if (const GhostRun* const ghost = comparison.ghost()) {
    const History& history = ghost->simulation().playback().history();
    ImGui::TextDisabled("Ghost: %.3f to %.3f s, %s", history.time(history.begin_moment()),
                        comparison.ghost()->end(), human_bytes(history.bytes()).c_str());
    gui.mark("comparison/ghost-reach");
  }
}

std::uint32_t ComparisonView::packed_color(std::size_t i) {
  const auto& color = run_colors[i];
  return IM_COL32(color[0], color[1], color[2], 255);
}

/// Tells where the ghost stands still, in the lower part of the image.
void ComparisonView::draw_ghost_label(const Gui& gui) const {
  const GhostRun* const ghost = comparison_.ghost();
  if (!ghost) return;
  const History& history = ghost->simulation().playback().history();
  const double begin = history.time(history.begin_moment()), end = ghost->end(),
               now = comparison_.shown_time(0);
  const double half = 0.5 * ghost->simulation().model().simulation.timestep;
  const std::string text = now > end + half     ? fmt::format("ghost: its run ends at {:.3f} s", end)
                           : now < begin - half ? fmt::format("ghost: kept from {:.3f} s on", begin)
                                                : std::string("ghost: an earlier run");
  const auto scale = static_cast<float>(gui.scale());
  const Box& box = boxes_.front();
  ImGui::SetNextWindowPos(
      {static_cast<float>(box.right) - 14.0f * scale, static_cast<float>(box.top) + 14.0f * scale},
      ImGuiCond_Always, {1.0f, 0.0f});
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 7.0f * scale);
  ImGui::Begin("##ghost", nullptr, label_flags);
  ImGui::TextColored(ImVec4(0.72f, 0.84f, 1.0f, 1.0f), "%s", text.c_str());
  gui.mark("ghost/label");
  ImGui::End();
  ImGui::PopStyleVar();
}

/// "implicit Euler · 1.501 s" in a frame of the run's color, to be read from the last row.
void ComparisonView::draw_labels(const Gui& gui) const {
  draw_ghost_label(gui);
  if (!comparison_.active()) return;
  const auto scale = static_cast<float>(gui.scale());
  const float gap = 14.0f * scale, thickness = 3.0f * scale;
  for (std::size_t i = 0; i < comparison_.count(); ++i) {
    const PlaybackSession& s = comparison_.run(i);
    const Box& box = boxes_[i];
    const ImVec2 low = {static_cast<float>(box.left), static_cast<float>(box.top)},
                 high = {static_cast<float>(box.right), static_cast<float>(box.bottom)};
    ImGui::GetBackgroundDrawList()->AddRect({low.x + 0.5f * thickness, low.y + 0.5f * thickness},
                                            {high.x - 0.5f * thickness, high.y - 0.5f * thickness},
                                            packed_color(i), 0.0f, 0, thickness);
    // A video has the names in its images.
    if (image_.video && image_.video->text) continue;
    ImGui::SetNextWindowPos({low.x + gap, low.y + gap});
    ImGui::SetNextWindowBgAlpha(0.72f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * gap);
    ImGui::Begin(fmt::format("##comparison{}", i).c_str(), nullptr, label_flags);
    ImGui::SetWindowFontScale(1.35f);
    const std::string time = fmt::format("{:.3f} s", comparison_.shown_time(i)), own = name(i);
    const std::string line = fmt::format("{} · {}", own, time);
    const float room = high.x - low.x - 2.0f * (gap + ImGui::GetStyle().WindowPadding.x);
    ImGui::BeginGroup();
    ImGui::PushStyleColor(ImGuiCol_Text, packed_color(i));
    if (ImGui::CalcTextSize(line.c_str()).x <= room) {
      ImGui::TextUnformatted(own.c_str());
      ImGui::PopStyleColor();
      ImGui::SameLine(0.0f, 0.0f);
      ImGui::TextUnformatted(fmt::format(" · {}", time).c_str());
    } else {
      wrapped_text(own, room);
      ImGui::PopStyleColor();
      ImGui::TextUnformatted(time.c_str());
    }
    if (const auto divergence = comparison_.shown_divergence(i))
      ImGui::TextColored(ImVec4(0.98f, 0.55f, 0.38f, 1.0f), "diverged at %.3f s",
                         static_cast<double>(divergence->step) * s.model().simulation.timestep);
    ImGui::EndGroup();
    gui.mark("comparison/{}/label", i);
    ImGui::End();
    ImGui::PopStyleVar();
  }
}

}  // namespace aspic::app

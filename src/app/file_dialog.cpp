#include "app/file_dialog.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>
#include <tuple>
#include <utility>

#include "app/parameter_widget.h"
#include "base/printable.h"

namespace aspic::app {
namespace {

namespace fs = std::filesystem;

bool ends_with_any(const std::string& name, const std::vector<std::string_view>& endings) {
  return std::ranges::any_of(endings, [&](std::string_view ending) { return name.ends_with(ending); });
}

}  // namespace

void FileDialog::ask(FileQuestion question, const std::string& suggested) {
  question_ = std::move(question);
  const fs::path path(suggested);
  name_ = path.filename().string();
  std::error_code unknown;
  if (path.has_parent_path())
    go_to(fs::absolute(path.parent_path(), unknown).string());
  else
    go_to(directory_.empty() ? fs::current_path(unknown).string() : directory_);
  warned_of_.clear();
  missed_.clear();
  open_ = just_opened_ = true;
}

void FileDialog::go_to(const std::string& directory) {
  directory_ = fs::path(directory).lexically_normal().string();
  entries_.clear();
  problem_.clear();
  std::error_code error, unknown;
  for (fs::directory_iterator it(directory_, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    const bool is_directory = it->is_directory(unknown);
    if (name.starts_with(".") || !(is_directory || ends_with_any(name, question_.endings))) continue;
    entries_.push_back({name, is_directory});
  }
  if (error) problem_ = fmt::format("Cannot read this directory: {}.", error.message());
  std::ranges::sort(entries_, {}, [](const Entry& e) { return std::tuple(!e.is_directory, e.name); });
}

std::string FileDialog::path() const {
  std::string name = name_;
  if (question_.writes && !name.empty() && !ends_with_any(name, question_.endings))
    name += question_.endings.front();
  return (fs::path(directory_) / name).string();
}

void FileDialog::accept() {
  if (name_.empty()) return;
  std::error_code unknown;
  if (fs::is_directory(path(), unknown)) {
    go_to(path());
    name_.clear();
    return;
  }
  open_ = false;
  const bool exists = fs::exists(path(), unknown);
  question_.accept(path(), question_.writes && exists ? Overwrite::allow : Overwrite::refuse);
}

void FileDialog::list(Gui& gui, double height) {
  ImGui::BeginChild("##entries", {0.0f, static_cast<float>(height)}, true);
  const auto entry = [&](const std::string& name, const std::string& label, bool chosen) {
    // Long names differ at their ends more often than in the middle, where nothing tells that they go on.
    const std::string shown = elided_path(label, ImGui::GetContentRegionAvail().x);
    ImGui::PushID(name.c_str());
    const bool pressed = ImGui::Selectable(shown.c_str(), chosen, ImGuiSelectableFlags_AllowDoubleClick);
    ImGui::PopID();
    gui.mark("files/entry/{}", name);
    return pressed;
  };
  std::string next;
  if (entry("..", "../", false)) next = fs::path(directory_).parent_path().string();
  for (const Entry& e : entries_) {
    if (!entry(e.name, printable(e.name) + (e.is_directory ? "/" : ""), e.name == name_)) continue;
    if (e.is_directory)
      next = (fs::path(directory_) / e.name).string();
    else if (std::exchange(name_, e.name) == e.name && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
      accept();
  }
  if (entries_.empty())
    ImGui::TextDisabled("%s", problem_.empty() ? "no matching files here" : problem_.c_str());
  ImGui::EndChild();
  if (!next.empty()) go_to(next);
}

void FileDialog::draw(Gui& gui, double width, double height) {
  if (!open_) return;
  const double scale = gui.scale();
  const auto at = [](double x, double y) { return ImVec2(static_cast<float>(x), static_cast<float>(y)); };
  ImGui::SetNextWindowPos(at(0.5 * width, 0.5 * height), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize(at(std::min(560.0 * scale, width), 0.0));
  if (just_opened_) ImGui::SetNextWindowFocus();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, static_cast<float>(8.0 * scale));
  ImGui::Begin("##files", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings);
  ImGui::TextUnformatted(question_.title.c_str());
  ImGui::SameLine();
  ImGui::TextDisabled("%s", elided_path(printable(directory_), ImGui::GetContentRegionAvail().x).c_str());
  list(gui, std::min(300.0 * scale, 0.5 * height));
  if (std::exchange(just_opened_, false)) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1.0f);
  // Typing replaces the name that is suggested.
  const bool entered = ImGui::InputText(
      "##name", &name_, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  named(gui, "files/name", "Type the file's name, or a path from this directory.");
  std::error_code unknown;
  const bool exists = !name_.empty() && fs::exists(path(), unknown);
  const bool replaces = exists && question_.writes && !fs::is_directory(path(), unknown);
  if (replaces)
    ImGui::TextDisabled("%s exists. Press Enter again to replace it, comments included.",
                        printable(name_).c_str());
  if (entered && !exists && !question_.writes && !name_.empty()) missed_ = path();
  if (!exists && missed_ == path()) {
    ImGui::TextColored(ImVec4(0.95f, 0.55f, 0.40f, 1.0f), "There is no file %s here.",
                       printable(name_).c_str());
    gui.mark("files/missed");
  }
  const bool ready = question_.writes ? !name_.empty() : exists;
  const std::string label = replaces ? "Replace" : question_.title;
  const bool pressed = button(gui, "files/accept", label.c_str(),
                              "Opens or saves the file. Replacing needs a second press.", ready);
  if (entered && ((replaces && std::exchange(warned_of_, path()) != path()) || !ready))
    just_opened_ = true;  // the field gets the keyboard again
  else if (ready && (pressed || entered))
    accept();
  ImGui::SameLine();
  if (button(gui, "files/cancel", "Cancel", "Closes this page (Escape).")) close();
  ImGui::End();
  ImGui::PopStyleVar();
  if (open_) shade_all_but("##files");
}

}  // namespace aspic::app

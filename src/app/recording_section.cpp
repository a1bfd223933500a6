// The section that films.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "run/run_files.h"

namespace aspic::app {
namespace {

constexpr const char* start_or_end = "start or end a film";

void format_widget(Gui& gui, FilmSettings& film) {
  label_column("Format");
  const bool open = ImGui::BeginCombo("##format", film.format->label.data());
  gui.mark("record/format");
  const char* const help =
      "Output of the film: a file (mp4, webm and GIF need the program ffmpeg), or a directory of numbered "
      "pictures.";
  tooltip(help);
  if (!open) return;
  for (const FilmFormat& format : film_formats()) {
    if (ImGui::Selectable(format.label.data(), &format == film.format)) film.format = &format;
    gui.mark("record/format/{}", format.name);
    tooltip(help);
  }
  ImGui::EndCombo();
  film.fps = std::min(film.fps, film.format->most_fps);
}

void rate_widget(Gui& gui, FilmSettings& film) {
  label_column("Pictures");
  const double least = 1.0, most = film.format->most_fps;
  ImGui::DragScalar("##fps", ImGuiDataType_Double, &film.fps, 0.2f, &least, &most, "%.4g a second",
                    ImGuiSliderFlags_AlwaysClamp);
  gui.mark("record/fps");
  tooltip(
      fmt::format("Pictures per second of the film, 1 … {:g} in this format. Each shows the state speed/rate "
                  "seconds of simulated time after the previous one.\nDrag to change, Ctrl+click "
                  "to type.",
                  most));
}

void name_widget(Gui& gui, const std::string& source, FilmSettings& film) {
  label_column("Name");
  std::array<char, 1024> text = {};
  film.path.copy(text.data(), text.size() - 1);
  const std::string hint = free_name(source, film_ending(*film.format));
  if (ImGui::InputTextWithHint("##film", hint.c_str(), text.data(), text.size())) film.path = text.data();
  gui.mark("record/path");
  tooltip(
      fmt::format("Name of the film; if left empty, {}. The format determines the extension. Existing files "
                  "are never overwritten.",
                  hint));
}

}  // namespace

void recording_section(Gui& gui, const std::string& source, Film& film) {
  if (const Recording* const recording = film.recording()) {
    const FilmOptions& o = recording->options();
    const std::string label = fmt::format("End the film ({:.2f} s)", recording->seconds());
    if (command_button(gui, "record/stop", label.c_str(), "Completes " + o.path + ".", start_or_end, true,
                       -1.0f))
      return;
    ImGui::TextDisabled("%llu pictures of %d × %d", static_cast<unsigned long long>(recording->pictures()),
                        o.size.width, o.size.height);
    tooltip("Pictures so far, and their size in pixels.");
    if (!recording->ready()) ImGui::TextDisabled("The motion waits for the encoder.");
    return;
  }
  command_button(gui, "record/start", "Start a film",
                 "Films the scene without the panels, in step with simulated time: no picture is lost or "
                 "doubled, however fast the solver and the window are. The film's size is that of the view "
                 "now. While the motion pauses, so does the film.",
                 start_or_end, true, -1.0f);
  format_widget(gui, film.settings);
  rate_widget(gui, film.settings);
  name_widget(gui, source, film.settings);
  label_column("Parameters");
  ImGui::Checkbox("shown", &film.settings.text);
  gui.mark("record/text");
  tooltip(
      "Terrain, integrator, time step, springs and time are written on the picture, as in aspic run --video, "
      "with the legend of the colours.");
  if (film.completing() > 0) ImGui::TextDisabled("Completing the last film …");
}

void state_files(Gui& gui, const StateFiles& files) {
  static std::array<char, 1024> path = {};
  for (const StateFormat& format : state_formats()) {
    const std::string name = fmt::format("save/{}{}", format.option, format.ending);
    const std::string label = fmt::format("Save {}… ({})", format.option, format.ending);
    const std::string help =
        format.over_time ? "Writes the energies and momentum of the plot to a file, a row for each point."
                         : fmt::format("Writes the {} at this step to a file.", format.option);
    if (button(gui, name.c_str(), label.c_str(), help, true, -1.0f)) {
      path = {};
      ImGui::OpenPopup(name.c_str());
    }
    if (!ImGui::BeginPopup(name.c_str())) continue;
    const std::string hint = free_name(files.editor.source(), format.ending);
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 16.0f);
    const bool entered = ImGui::InputTextWithHint("##path", hint.c_str(), path.data(), path.size(),
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    gui.mark("{}/path", name);
    tooltip(fmt::format("The file to write; if left empty, {}. Existing files are not overwritten.", hint));
    ImGui::SameLine();
    if (button(gui, (name + "/write").c_str(), "Write", "Writes the file.") || entered) {
      files.save(format, path.data());
      ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
  }
}

}  // namespace aspic::app

// The section that films.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>

#include "app/app.h"
#include "app/panels.h"
#include "app/parameter_widget.h"
#include "run/outputs.h"

namespace aspic::app {
namespace {

constexpr const char* start_or_end = "start or end a film";

void format_widget(Gui& gui, FilmSettings& film) {
  label_column("Format");
  const bool open = ImGui::BeginCombo("##format", film.format->label.data());
  gui.mark("record/format");
  const char* const help =
      "What the film becomes: a file (mp4, webm and GIF need the program ffmpeg), or a directory of numbered "
      "pictures.";
  tooltip(help);
  if (!open) return;
  for (const FilmFormat& format : film_formats()) {
    if (ImGui::Selectable(format.label.data(), &format == film.format)) film.format = &format;
    gui.mark(fmt::format("record/format/{}", format.name));
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
      fmt::format("Pictures that the film shows in a second, 1 … {:g} in this format. Each shows the state "
                  "speed/rate seconds of simulated time after the one before.\nDrag to change, Ctrl+click "
                  "to type.",
                  most));
}

void name_widget(App& app, FilmSettings& film) {
  label_column("Name");
  std::array<char, 1024> text = {};
  film.path.copy(text.data(), text.size() - 1);
  const std::string hint = free_name(app.editor().source(), film_ending(*film.format));
  if (ImGui::InputTextWithHint("##film", hint.c_str(), text.data(), text.size())) film.path = text.data();
  app.gui().mark("record/path");
  tooltip(
      fmt::format("Where the film goes; left empty, {}. The format gives the ending. What exists is never "
                  "overwritten.",
                  hint));
}

/// A button for each format of states, with a popup that asks for the name.
void file_widgets(App& app) {
  Gui& gui = app.gui();
  static std::array<char, 1024> path = {};
  for (const StateFormat& format : state_formats()) {
    const std::string name = fmt::format("save/{}{}", format.option, format.ending);
    const std::string label = fmt::format("Save {}… ({})", format.option, format.ending);
    const std::string help =
        format.over_time ? "Writes the energies and momentum of the plot to a file, a row for each point."
                         : fmt::format("Writes the {} at this step to a file.", format.option);
    if (button(gui, name.c_str(), label.c_str(), help, "", true, -1.0f)) {
      path = {};
      ImGui::OpenPopup(name.c_str());
    }
    if (!ImGui::BeginPopup(name.c_str())) continue;
    const std::string hint = free_name(app.editor().source(), format.ending);
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 16.0f);
    const bool entered = ImGui::InputTextWithHint("##path", hint.c_str(), path.data(), path.size(),
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    gui.mark(name + "/path");
    tooltip(fmt::format("The file to write; if left empty, {}. One that exists is not overwritten.", hint));
    ImGui::SameLine();
    if (button(gui, (name + "/write").c_str(), "Write", "Writes the file.") || entered) {
      app.save_output(format, path.data());
      ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
  }
}

void film_widgets(App& app) {
  Gui& gui = app.gui();
  FilmSettings& film = app.film_settings();
  const Recording* const recording = app.recording();
  if (recording) {
    const std::string label = fmt::format("End the film ({:.2f} s)", recording->seconds());
    if (button(gui, "record/stop", label.c_str(), "Completes " + recording->options().path + ".",
               start_or_end, true, -1.0f)) {
      app.stop_recording();
      return;
    }
    const FilmOptions& o = recording->options();
    ImGui::TextDisabled("%llu pictures of %d × %d", static_cast<unsigned long long>(recording->pictures()),
                        o.size.width, o.size.height);
    tooltip("Pictures so far, and their size in pixels.");
    if (!recording->ready()) ImGui::TextDisabled("The motion waits for the encoder.");
    return;
  }
  if (button(
          gui, "record/start", "Start a film",
          "Films the scene without the panels, in step with simulated time: no picture is lost or doubled, "
          "however fast the solver and the window are. The film's size is that of the view now. While the "
          "motion pauses, so does the film.",
          start_or_end, true, -1.0f))
    app.start_recording();
  format_widget(gui, film);
  rate_widget(gui, film);
  name_widget(app, film);
  label_column("Parameters");
  ImGui::Checkbox("shown", &film.text);
  gui.mark("record/text");
  tooltip(
      "Terrain, integrator, time step, springs and time stand in the picture, as in aspic run --video, and "
      "the "
      "legend of the colours.");
  if (app.films_completing() > 0) ImGui::TextDisabled("Completing the last film …");
}

}  // namespace

void recording_section(App& app) {
  film_widgets(app);
  ImGui::Separator();
  file_widgets(app);
}

}  // namespace aspic::app

// The sections that plot: energy, and shadow mode.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/figure.h"
#include "app/panels.h"
#include "app/parameter_widget.h"
#include "app/units.h"
#include "base/printable.h"
#include "model/contact_surface.h"
#include "model/springs.h"

namespace aspic::app {
namespace {

using Sampled = double (*)(const EnergySample&);
struct Curve {
  const char* name;
  ImU32 color;
  Sampled value;
  bool counts = true;  ///< for the scale: work grows and grows
};

/// The last two where bodies can touch, and where actuators act.
std::vector<Curve> energy_curves(const Model& model) {
  std::vector<Curve> curves = {
      {"kinetic", IM_COL32(242, 176, 92, 255), [](const EnergySample& s) { return s.measures.kinetic; }},
      {"elastic", IM_COL32(120, 205, 140, 255), [](const EnergySample& s) { return s.measures.elastic; }},
      {"gravitational", IM_COL32(110, 165, 240, 255),
       [](const EnergySample& s) { return s.measures.gravitational; }},
      {"total", IM_COL32(230, 232, 236, 255), [](const EnergySample& s) { return s.measures.total(); }}};
  if (has_body_contact(model))
    curves.push_back({"of contact", IM_COL32(225, 130, 190, 255),
                      [](const EnergySample& s) { return s.measures.contact.value_or(0.0); }});
  if (!model.actuation.empty())
    curves.push_back({"actuator work", IM_COL32(90, 205, 210, 255),
                      [](const EnergySample& s) { return s.work.value_or(0.0); }, false});
  return curves;
}

constexpr std::array<Curve, 4> momentum_curves = {
    {{"p, along x", IM_COL32(238, 120, 110, 255),
      [](const EnergySample& s) { return s.measures.momentum.x; }},
     {"p, along y", IM_COL32(120, 205, 140, 255),
      [](const EnergySample& s) { return s.measures.momentum.y; }},
     {"p, along z", IM_COL32(110, 165, 240, 255),
      [](const EnergySample& s) { return s.measures.momentum.z; }},
     {"|p|", IM_COL32(230, 232, 236, 255),
      [](const EnergySample& s) { return length(s.measures.momentum); }}}};

/// The ground of a plot over the time of some samples.
template <class Sample>
struct Plot {
  ImVec2 size, corner = ImGui::GetCursorScreenPos();
  double scale, start = 0.0, span = 0.0;  // of time [s]; a span of 0: there is nothing to draw
  float pad;
  bool pressed = false, held = false, hovered = false;  // by the mouse
  ImDrawList& draw = *ImGui::GetWindowDrawList();

  Plot(Gui& gui, const char* name, double height, const std::deque<Sample>& samples, std::string_view help)
      : size(ImGui::GetContentRegionAvail().x, static_cast<float>(height * gui.scale())),
        scale(gui.scale()),
        pad(static_cast<float>(6.0 * scale)) {
    ImGui::InvisibleButton(name, size);
    pressed = ImGui::IsItemActivated();
    held = ImGui::IsItemActive();
    hovered = ImGui::IsItemHovered();
    named(gui, name, help);
    draw.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, IM_COL32(20, 21, 23, 255), 4.0f);
    if (samples.size() < 2) return;
    start = samples.front().time;
    span = std::max(samples.back().time - start, 0.0);
  }
  /// A time and a height, 0 … 1 of what `above` and `below` leave [window units].
  ImVec2 place(double time, double height, float above = 0.0f, float below = 0.0f) const {
    return {
        corner.x + pad + static_cast<float>((time - start) / span) * (size.x - 2.0f * pad),
        corner.y + size.y - pad - static_cast<float>(height) * (size.y - 2.0f * pad - above - below) - below};
  }
};

/// A length of 1, 2 or 5 times a power of ten, four or so of which make up a span > 0.
double tick_length(double span) {
  const double power = std::pow(10.0, std::floor(std::log10(span / 4.0)));
  const double rest = span / 4.0 / power;
  return (rest > 5.0 ? 10.0 : rest > 2.0 ? 5.0 : rest > 1.0 ? 2.0 : 1.0) * power;
}

/// Its multiples from `low` to `high`.
std::vector<double> ticks(double low, double high, double length) {
  std::vector<double> places;
  const auto last = static_cast<std::int64_t>(std::floor(high / length));
  for (auto n = static_cast<std::int64_t>(std::ceil(low / length)); n <= last; ++n)
    places.push_back(static_cast<double>(n) * length);
  return places;
}

/// A time in a plot that the mouse points at [s].
struct Pointed {
  double time = 0.0;
  bool pressed = false;  ///< or dragged to
};

/// A curve of a run.
struct Line {
  const std::deque<EnergySample>* samples;
  ImU32 color;
  Sampled value;
  bool counts = true;  ///< for the scale; one that does not may leave the plot
};

/// The largest magnitude in a plot: figures far below it are rounding.
double largest(std::span<const Line> lines) {
  double most = 0.0;
  for (const Line& line : lines)
    for (const EnergySample& s : *line.samples) most = std::max(most, std::abs(line.value(s)));
  return std::isfinite(most) ? most : 0.0;
}

/// The points of a curve: of each column of pixels the first, the highest, the lowest and the last, which
/// look like all of them.
template <class Place>
std::vector<ImVec2> seen(const Line& line, const Place& place) {
  std::vector<ImVec2> points;
  ImVec2 first, top, bottom, last;
  bool one = true;  // in the column at hand
  const auto end_column = [&] {
    if (one) return;
    points.insert(points.end(), {top.x < bottom.x ? top : bottom, top.x < bottom.x ? bottom : top, last});
  };
  for (const EnergySample& s : *line.samples) {
    const ImVec2 point = place(s.time, line.value(s));
    if (!points.empty() && std::floor(point.x) == std::floor(first.x)) {
      if (point.y < top.y) top = point;
      if (point.y > bottom.y) bottom = point;
      last = point;
      one = false;
      continue;
    }
    end_column();
    points.push_back(point);
    first = top = bottom = last = point;
    one = true;
  }
  end_column();
  return points;
}

/// Curves over time with their scale.
std::optional<Pointed> plot(Gui& gui, const char* name, std::span<const Line> lines, const char* unit,
                            std::string_view help, double now) {
  const auto end_time = [](const Line& line) {
    return line.samples->empty() ? 0.0 : line.samples->back().time;
  };
  const Plot plot(gui, name, 145.0, *std::ranges::max_element(lines, {}, end_time)->samples, help);
  if (!(plot.span > 0.0)) return std::nullopt;
  double low = 0.0, high = 0.0;
  const bool all_count = std::ranges::none_of(lines, &Line::counts);
  for (const Line& line : lines) {
    if (!line.counts && !all_count) continue;
    for (const EnergySample& s : *line.samples) {
      low = std::min(low, line.value(s));
      high = std::max(high, line.value(s));
    }
  }
  if (!(high > low) || !std::isfinite(high - low)) return std::nullopt;
  const ImVec2 size = plot.size, corner = plot.corner;
  const double start = plot.start, span = plot.span;
  const float pad = plot.pad;
  ImDrawList& draw = plot.draw;
  const float text_height = ImGui::GetTextLineHeight();
  const double time_tick = tick_length(span), tick = tick_length(high - low);
  const std::string top = with_prefix(high, unit), bottom = with_prefix(low, unit),
                    each = fmt::format("lines every {}, {:.3g} s", with_prefix(tick, unit), time_tick),
                    end = fmt::format("{:.3g} s", start + span);
  const auto width = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
  // Next to the upper end where both fit, else in a separate line.
  const bool beside = width(top) + width(each) + 4.0f * pad < size.x;
  const float above = beside ? text_height : 2.0f * text_height;
  const auto place = [&](double t, double e) {
    return plot.place(t, (e - low) / (high - low), above, text_height);
  };
  for (const double t : ticks(start, start + span, time_tick))
    draw.AddLine(place(t, low), place(t, high), IM_COL32(38, 40, 43, 255));
  for (const double e : ticks(low, high, tick))
    draw.AddLine(place(start, e), place(start + span, e), IM_COL32(38, 40, 43, 255));
  draw.AddLine(place(start, 0.0), place(start + span, 0.0), IM_COL32(80, 84, 90, 255));
  draw.PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
  for (const Line& line : lines) {
    for (const ImVec2& point : seen(line, place)) draw.PathLineTo(point);
    draw.PathStroke(line.color, 0, static_cast<float>(1.5 * plot.scale));
  }
  draw.PopClipRect();
  const double at = std::clamp(now, start, start + span);
  draw.AddLine(place(at, low), place(at, high), IM_COL32(242, 176, 92, 200), static_cast<float>(plot.scale));
  const auto write = [&](const std::string& text, float right, float down) {
    draw.AddText({corner.x + pad + right, corner.y + 2.0f + down}, IM_COL32(140, 145, 152, 255),
                 text.c_str());
  };
  const auto flush = [&](const std::string& text) { return size.x - 2.0f * pad - width(text); };
  const float foot = size.y - text_height - 4.0f;
  write(top, 0.0f, 0.0f);
  write(each, beside ? flush(each) : 0.0f, beside ? 0.0f : text_height);
  write(bottom, 0.0f, foot);
  write(end, flush(end), foot);
  if (!plot.held && !plot.hovered) return std::nullopt;
  const double share =
      static_cast<double>((ImGui::GetIO().MousePos.x - corner.x - pad) / (size.x - 2.0f * pad));
  const double time = start + std::clamp(share, 0.0, 1.0) * span;
  draw.AddLine(place(time, low), place(time, high), IM_COL32(150, 155, 162, 255));
  return Pointed{time, plot.held && (plot.pressed || ImGui::GetIO().MouseDelta.x != 0.0f)};
}

constexpr ImU32 same = IM_COL32(120, 205, 140, 255), other = IM_COL32(240, 120, 95, 255);

/// Places 0 at the bottom and powers of ten above, from 1 ULP on.
double height_of(const DifferenceSample& sample) {
  if (!std::isfinite(sample.meters)) return 1.0;
  return std::min(std::log10(1.0 + static_cast<double>(sample.ulp)) / 10.0, 1.0);
}

void plot_differences(Gui& gui, const std::deque<DifferenceSample>& samples) {
  const Plot plot(
      gui, "shadow/plot", 70.0, samples,
      "Plots the largest difference of the states [ulp], logarithmic, 0 to 10¹⁰. Green: identical bits.");
  for (std::size_t i = 1; i < samples.size() && plot.span > 0.0; ++i) {
    const auto place = [&](const DifferenceSample& s) { return plot.place(s.time, height_of(s)); };
    plot.draw.AddLine(place(samples[i - 1]), place(samples[i]), samples[i].identical ? same : other,
                      static_cast<float>(2.0 * plot.scale));
  }
}

/// What the run can be compared with: the reference first.
std::vector<const BackendRow*> others_than(const BackendRow& leader) {
  std::vector<const BackendRow*> rows;
  for (const BackendRow& row : backends()) {
    if (&row != &leader) rows.insert(rows.begin(), &row);
  }
  return rows;
}

/// One quantity of all runs in their colors.
void compared_runs(Gui& gui, const char* name, std::span<const Curve> curves, std::size_t& compared,
                   const char* unit, std::string_view help, ComparisonView& comparison_view,
                   RunControl& run) {
  const Comparison& comparison = comparison_view.comparison();

  std::vector<std::string_view> names;
  for (const Curve& c : curves) names.emplace_back(c.name);
  label_column("Compare");
  choice(gui, fmt::format("{}/compared", name), names, names, compared,
         "Selects the quantity to plot; colors match the runs' names.");
  compared = std::min(compared, curves.size() - 1);
  const Curve& curve = curves[compared];
  std::vector<Line> lines;
  for (std::size_t i = 0; i < comparison.count(); ++i)
    lines.push_back({&comparison.run(i).samples().energies(), ComparisonView::packed_color(i), curve.value,
                     !comparison.run(i).divergence().has_value()});
  // All figures are of one moment: the newest that all runs have come to.
  const double now = comparison.clock().figures_time();
  const auto pointed = plot(gui, name, lines, unit, help, now);
  if (pointed && pointed->pressed && !comparison_view.go_to(pointed->time)) run.go_to(pointed->time);
  const double time = pointed ? pointed->time : now;
  const EnergySample* const first = comparison.run(0).samples().nearest(time);
  const bool first_has_it = first && !comparison.run(0).divergence();
  const double shown = pointed && first_has_it ? first->time : time;
  figure(pointed ? "t under the mouse" : "t", fmt::format("{:.4g} s", shown), help);
  gui.mark("{}/time", name);
  std::vector<std::string> runs, values;
  const double size = largest(lines);
  bool fits = true;
  const float column = ImGui::GetWindowContentRegionMax().x * figure_column;
  for (std::size_t i = 0; i < comparison.count(); ++i) {
    const EnergySample* const sample = comparison.run(i).samples().nearest(shown);
    runs.push_back(comparison_view.name(i));
    values.push_back(sample ? with_prefix(without_noise(curve.value(*sample), size), unit, 5) : "-");
    // Another time step comes to another time, and a run that diverged to none later.
    if (sample && std::abs(sample->time - shown) > 1e-6 * std::max(shown, 1e-3))
      values.back() += fmt::format(" at {:.4g} s", sample->time);
    fits = fits && ImGui::CalcTextSize(runs.back().c_str()).x + ImGui::GetStyle().ItemSpacing.x < column;
  }
  for (std::size_t i = 0; i < comparison.count(); ++i) {
    ImGui::PushStyleColor(ImGuiCol_Text, ComparisonView::packed_color(i));
    wrapped_text(runs[i], ImGui::GetContentRegionAvail().x);
    ImGui::PopStyleColor();
    gui.mark("{}/run {}/name", name, i + 1);
    tooltip(help);
    if (fits) ImGui::SameLine();
    ImGui::SetCursorPosX(column);
    ImGui::TextUnformatted(values[i].c_str());
    gui.mark("{}/run {}", name, i + 1);
    tooltip(help);
  }
}

}  // namespace

void energy_section(Gui& gui, ComparisonView& comparison_view, RunControl& run, Layouts& layout) {
  const Comparison& comparison = comparison_view.comparison();

  const PlaybackSession& s = comparison.run(0);
  const auto show = [&](const char* name, std::span<const Curve> curves, std::size_t& compared,
                        const char* unit, std::string_view help) {
    if (comparison.active())
      return compared_runs(gui, name, curves, compared, unit, help, comparison_view, run);
    std::vector<Line> lines;
    for (const Curve& c : curves) lines.push_back({&s.samples().energies(), c.color, c.value, c.counts});
    const double now = comparison.clock().time();
    const auto pointed = plot(gui, name, lines, unit, help, now);
    if (pointed && pointed->pressed) run.go_to(pointed->time);
    // Without figures, as after a restart, their rows stay: what is below keeps its place under the mouse.
    const EnergySample* const sample = s.samples().nearest(pointed ? pointed->time : now);
    figure(pointed ? "t under the mouse" : "t", sample ? fmt::format("{:.4g} s", sample->time) : "-", help);
    const double size = largest(lines);
    for (const Curve& c : curves) {
      figure(c.name, sample ? with_prefix(without_noise(c.value(*sample), size), unit) : std::string("-"),
             help, ImGui::ColorConvertU32ToFloat4(c.color));
      gui.mark("{}/{}", name, c.name);
    }
  };
  show("energy/plot", energy_curves(s.model()), comparison_view.compared[0], "J",
       "Plots the energies of the run [J]. Click: go to that time.");
  if (!folded(gui, layout, "Energy", "momentum", "Momentum over time.")) return;
  show("energy/momentum", momentum_curves, comparison_view.compared[1], "N·s",
       "Plots the total momentum by axis and in magnitude [N·s]. Click: go to that time.");
}

void shadow_section(Gui& gui, const PlaybackSession& s, RunControl& run) {
  const std::vector<const BackendRow*> others = others_than(s.present().backend());
  bool on = s.present().engines().shadowed();
  if (check_box(gui, "compare", "shadow/on", on,
                "Runs the same steps on a second backend and compares the states."))
    run.set_shadow(on ? others.front() : nullptr);
  if (!s.present().engines().shadowed()) return;
  // A machine with two backends has no choice to offer.
  for (std::size_t i = 0; others.size() > 1 && i < others.size(); ++i) {
    const std::string label(others[i]->title);
    if (ImGui::RadioButton(label.c_str(), others[i] == s.present().engines().shadow().row))
      run.set_shadow(others[i]);
    tooltip(others[i]->summary);
  }
  ImGui::TextDisabled("%s ∥ %s", std::string(s.present().solver().backend()).c_str(),
                      std::string(s.present().engines().shadow().solver->backend()).c_str());
  tooltip(fmt::format("Leads: {}. Alongside: {}.", s.present().solver().description(),
                      s.present().engines().shadow().solver->description()));
  plot_differences(gui, s.samples().differences());
  if (s.samples().differences().empty()) {
    ImGui::TextDisabled("not compared yet");
    return;
  }
  const DifferenceSample& last = s.samples().differences().back();
  const ImVec4 color = ImGui::ColorConvertU32ToFloat4(last.identical ? same : other);
  const std::string text = !std::isfinite(last.meters) ? "one backend diverged"
                           : last.identical            ? "0 ULP, 0 m: identical bits"
                                            : fmt::format("{} ULP, {:.3g} m", last.ulp, last.meters);
  ImGui::TextColored(color, "%s", text.c_str());
  gui.mark("shadow/difference");
  if (last.identical && s.samples().ever_differed())
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(other), "they differed before");
}

}  // namespace aspic::app

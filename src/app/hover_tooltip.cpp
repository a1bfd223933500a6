// What is known of the particle or ball under the mouse.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "app/panels.h"
#include "model/terrain.h"
#include "render/camera.h"

namespace aspic::app {
namespace {

/// A vector's name, norm, unit and, where there is room, components, in columns.
void row(const char* name, const Vec3& v, const char* unit, bool components) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", name);
  ImGui::TableNextColumn();
  ImGui::Text("%.4g", length(v));
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", unit);
  for (int axis = 0; components && axis < 3; ++axis) {
    ImGui::TableNextColumn();
    const std::string number = fmt::format("{:.4g}", v[axis]);
    // Flush right, in columns wider than the longest number.
    const float width = ImGui::CalcTextSize(" -0.000e-00").x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + width - ImGui::CalcTextSize(number.c_str()).x);
    ImGui::TextDisabled("%s", number.c_str());
  }
}

/// Whether a particle may be in contact with terrain.
bool in_contact(const PlaybackSession& simulation, const Vec3& x) {
  const Model& model = simulation.model();
  return std::ranges::any_of(model.terrain, [&](const Terrain& t) {
    const Terrain now = terrain_at(t, model.simulation.timestep, simulation.snapshot().step);
    return signed_distance(now, x) < 1e-3;
  });
}

}  // namespace

Box particle_readout(const Gui& gui, const PlaybackSession& simulation, const Hovered& h, const Box& view,
                     std::span<const Box> taken) {
  const ParticleForce& f = h.force;
  const auto gap = static_cast<float>(16.0 * gui.scale());
  const auto width = static_cast<float>(view.right - view.left);
  // In a corner, so that it is never in the way of what it tells of.
  const bool components = width > 34.0f * ImGui::GetFontSize();
  // Always in the same corner; a legend that reaches so far to the left lifts it.
  const ImGuiWindow* const before = ImGui::FindWindowByName("##particle");
  const double right = view.left + static_cast<double>(gap + (before ? before->Size.x : 0.0f));
  double bottom = view.bottom;
  for (const Box& box : taken)
    if (box.left < right && box.bottom > view.center_y()) bottom = std::min(bottom, box.top);
  ImGui::SetNextWindowPos({static_cast<float>(view.left) + gap, static_cast<float>(bottom) - gap},
                          ImGuiCond_Always, {0.0f, 1.0f});
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * gap);
  ImGui::Begin("##particle", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::BeginGroup();
  ImGui::Text("%s %u", h.ball ? "ball" : "particle", h.particle);
  ImGui::SameLine();
  const std::string kind = h.pinned ? "pinned, " : h.ball ? fmt::format("radius {:.4g} m, ", h.radius) : "";
  ImGui::TextDisabled("%s%.4g kg, step %llu", kind.c_str(), h.mass,
                      static_cast<unsigned long long>(simulation.snapshot().step));
  ImGui::Text("x  (%.4g, %.4g, %.4g) m", h.position.x, h.position.y, h.position.z);
  if (ImGui::BeginTable("values", components ? 6 : 3, ImGuiTableFlags_SizingFixedFit)) {
    row("v", h.velocity, "m/s", components);
    if (h.ball) row("ω", h.angular_velocity, "rad/s", components);
    // Contacts act on a ball by impulses.
    row(h.ball && !h.contact.empty() ? "f without contact" : "f", f.net, "N", components);
    for (const ForceRow& part : force_rows)
      if (f.*part.force != Vec3{})
        row(fmt::format("  {}", part.name).c_str(), f.*part.force, "N", components);
    ImGui::EndTable();
  }
  if (h.ball)
    ImGui::TextDisabled("%s", h.contact.empty() ? "no contact" : h.contact.c_str());
  else if (simulation.model().contact.model == ContactModel::coulomb && !h.pinned && f.contact == Vec3{} &&
           in_contact(simulation, h.position))
    ImGui::TextDisabled("A bounce changes v at the end of a step and is not part of f.");
  ImGui::EndGroup();
  gui.mark("particle");
  const Box place = window_box();
  ImGui::End();
  ImGui::PopStyleVar();
  return place;
}

void ball_mark(const Gui& gui, const std::optional<Pull>& hand, const Hovered& h, const View& view,
               const Box& image) {
  if (!h.ball) return;
  const Camera camera(view.seen(), static_cast<int>(image.right - image.left),
                      static_cast<int>(image.bottom - image.top));
  const glm::mat4 through = camera.projection() * camera.view();
  const auto place = [&](const Vec3& x) -> std::optional<ImVec2> {
    const glm::vec4 p = through * glm::vec4(to_glm(x), 1.0f);
    if (!(p.w > 0.0f)) return std::nullopt;
    return ImVec2(
        static_cast<float>(image.left) + 0.5f * (1.0f + p.x / p.w) * static_cast<float>(camera.width()),
        static_cast<float>(image.top) + 0.5f * (1.0f - p.y / p.w) * static_cast<float>(camera.height()));
  };
  const auto center = place(h.position);
  if (!center) return;
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  const auto unit = static_cast<float>(gui.scale());
  constexpr ImU32 bright = IM_COL32(255, 255, 255, 235), dark = IM_COL32(20, 24, 28, 150);
  draw.PushClipRect({static_cast<float>(image.left), static_cast<float>(image.top)},
                    {static_cast<float>(image.right), static_cast<float>(image.bottom)});
  // A sphere is seen under the angle whose sine is R/distance.
  const double away = length(h.position - view.seen().position), sine = std::min(h.radius / away, 0.99);
  const auto radius =
      static_cast<float>(0.5 * camera.height() * static_cast<double>(camera.projection()[1][1]) * sine /
                         std::sqrt(1.0 - sine * sine));
  draw.AddCircle(*center, radius + 3.0f * unit, dark, 0, 4.0f * unit);
  draw.AddCircle(*center, radius + 3.0f * unit, bright, 0, 2.0f * unit);
  if (const auto anchor = hand && hand->ball ? place(hand->anchor) : std::nullopt) {
    draw.AddLine(*center, *anchor, dark, 5.0f * unit);
    draw.AddLine(*center, *anchor, bright, 2.5f * unit);
    draw.AddCircleFilled(*anchor, 5.0f * unit, bright);
  }
  draw.PopClipRect();
}

}  // namespace aspic::app

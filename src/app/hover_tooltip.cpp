// What is known of the particle under the mouse.
#include <fmt/format.h>
#include <imgui.h>

#include <string>

#include "app/panels.h"

namespace aspic::app {
namespace {

/// A vector's name, components, norm and unit, in columns.
void row(const char* name, const Vec3& v, const char* unit, bool with_norm = true) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", name);
  for (int axis = 0; axis < 3; ++axis) {
    ImGui::TableNextColumn();
    const std::string number = fmt::format("{:.4g}", v[axis]);
    // Flush right, in columns as wide as the longest number.
    const float width = ImGui::CalcTextSize("-0.0000e-00").x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + width - ImGui::CalcTextSize(number.c_str()).x);
    ImGui::TextUnformatted(number.c_str());
  }
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", unit);
  ImGui::TableNextColumn();
  if (with_norm) ImGui::TextDisabled("| %.4g |", length(v));
}

/// Next to the mouse, on the side where the view has room; while a hand pulls in a corner of the view,
/// away from the mouse and from the colours' legend.
void place(double scale, const Box& view, bool pulls) {
  const auto gap = static_cast<float>(16.0 * scale);
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool right = mouse.x > view.centre_x(), low = mouse.y > view.centre_y();
  if (pulls) {
    const double x = low ? view.right : view.left, y = low ? view.top : view.bottom;
    const ImVec2 corner = {static_cast<float>(x) + (low ? -gap : gap),
                           static_cast<float>(y) + (low ? gap : -gap)};
    return ImGui::SetNextWindowPos(corner, ImGuiCond_Always, {low ? 1.0f : 0.0f, low ? 0.0f : 1.0f});
  }
  ImGui::SetNextWindowPos({mouse.x + (right ? -gap : gap), mouse.y + (low ? -gap : gap)}, ImGuiCond_Always,
                          {right ? 1.0f : 0.0f, low ? 1.0f : 0.0f});
}

}  // namespace

void hover_tooltip(double scale, const Simulation& simulation, const Hovered& h, const Box& view) {
  const ParticleForce& f = h.force;
  place(scale, view, simulation.hand().has_value());
  ImGui::BeginTooltip();
  ImGui::Text("particle %u", h.particle);
  ImGui::SameLine();
  ImGui::TextDisabled("%s%.4g kg, step %llu", h.pinned ? "pinned, " : "", h.mass,
                      static_cast<unsigned long long>(simulation.snapshot().step));
  if (ImGui::BeginTable("particle", 6, ImGuiTableFlags_SizingFixedFit)) {
    row("x", h.position, "m", false);
    row("v", h.velocity, "m/s");
    row("f", f.net, "N");
    row("  gravity", f.gravity, "N");
    row("  springs", f.springs, "N");
    if (f.pull != Vec3{}) row("  hand", f.pull, "N");
    if (f.contact != Vec3{}) row("  contact", f.contact, "N");
    ImGui::EndTable();
  }
  // The Coulomb model's contacts act on velocities at the end of a step.
  if (simulation.model().contact.model == ContactModel::coulomb)
    ImGui::TextDisabled("Coulomb contact is an impulse and is not included in f.");
  ImGui::EndTooltip();
}

}  // namespace aspic::app

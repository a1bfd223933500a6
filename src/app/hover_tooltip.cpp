// What is known of the particle under the mouse.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <string>

#include "app/panels.h"
#include "model/terrain.h"

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
    // Flush right, in columns as wide as the longest number.
    const float width = ImGui::CalcTextSize("-0.000e-00").x;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + width - ImGui::CalcTextSize(number.c_str()).x);
    ImGui::TextDisabled("%s", number.c_str());
  }
}

/// Whether a terrain is so near that the particle may feel it.
bool touches(const Simulation& simulation, const Vec3& x) {
  const Model& model = simulation.model();
  return std::ranges::any_of(model.terrain, [&](const Terrain& t) {
    const Terrain now = terrain_at(t, model.simulation.timestep, simulation.snapshot().step);
    return signed_distance(now, x) < 1e-3;
  });
}

}  // namespace

void particle_readout(const Gui& gui, const Simulation& simulation, const Hovered& h, const Box& view,
                      double above) {
  const ParticleForce& f = h.force;
  const auto gap = static_cast<float>(16.0 * gui.scale());
  const auto width = static_cast<float>(view.right - view.left);
  // In a corner, so that it is never in the way of what it tells of.
  const bool components = width > 34.0f * ImGui::GetFontSize();
  const float lifted = width > 56.0f * ImGui::GetFontSize() ? 0.0f : static_cast<float>(above);
  ImGui::SetNextWindowPos(
      {static_cast<float>(view.left) + gap, static_cast<float>(view.bottom) - gap - lifted}, ImGuiCond_Always,
      {0.0f, 1.0f});
  ImGui::SetNextWindowBgAlpha(0.72f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.5f * gap);
  ImGui::Begin("##particle", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::BeginGroup();
  ImGui::Text("particle %u", h.particle);
  ImGui::SameLine();
  ImGui::TextDisabled("%s%.4g kg, step %llu", h.pinned ? "pinned, " : "", h.mass,
                      static_cast<unsigned long long>(simulation.snapshot().step));
  ImGui::Text("x  (%.4g, %.4g, %.4g) m", h.position.x, h.position.y, h.position.z);
  if (ImGui::BeginTable("values", components ? 6 : 3, ImGuiTableFlags_SizingFixedFit)) {
    row("v", h.velocity, "m/s", components);
    row("f", f.net, "N", components);
    row("  gravity", f.gravity, "N", components);
    row("  springs", f.springs, "N", components);
    if (f.pull != Vec3{}) row("  hand", f.pull, "N", components);
    if (f.contact != Vec3{}) row("  contact", f.contact, "N", components);
    ImGui::EndTable();
  }
  // The Coulomb model's contacts act on velocities at the end of a step.
  if (simulation.model().contact.model == ContactModel::coulomb && touches(simulation, h.position))
    ImGui::TextDisabled("Contact acts on v at the end of a step: no part of f.");
  ImGui::EndGroup();
  gui.mark("particle");
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace aspic::app

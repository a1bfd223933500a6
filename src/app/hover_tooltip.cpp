// What is known of the particle under the mouse.
#include <imgui.h>

#include "app/app.h"
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
    ImGui::Text("%9.4g", v[axis]);
  }
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", unit);
  ImGui::TableNextColumn();
  if (with_norm) ImGui::TextDisabled("%.4g %s in all", length(v), unit);
}

}  // namespace

void hover_tooltip(App& app) {
  const auto& h = app.hovered();
  if (!h) return;
  const ParticleForce& f = h->force;
  ImGui::BeginTooltip();
  ImGui::Text("particle %u", h->particle);
  ImGui::SameLine();
  ImGui::TextDisabled("m = %.4g kg%s", h->mass, h->pinned ? ", pinned" : "");
  if (ImGui::BeginTable("particle", 6, ImGuiTableFlags_SizingFixedFit)) {
    row("x", h->position, "m", false);
    row("v", h->velocity, "m/s");
    row("f", f.net, "N");
    if (f.springs != Vec3{}) row("  of springs", f.springs, "N");
    if (f.pull != Vec3{}) row("  of the hand", f.pull, "N");
    if (f.contact != Vec3{}) row("  of contact", f.contact, "N");
    ImGui::EndTable();
  }
  // The Coulomb model's contacts act on velocities at the end of a step, not as a force.
  ImGui::TextDisabled("step %llu; f = gravity and springs%s",
                      static_cast<unsigned long long>(app.simulation().snapshot().step),
                      f.contact != Vec3{} ? " and contact" : ", without impulses of contact");
  ImGui::EndTooltip();
}

}  // namespace aspic::app

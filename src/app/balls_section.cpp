// The section of balls: those that hands throw, and how hands pull.
#include <fmt/format.h>
#include <imgui.h>

#include "app/panels.h"
#include "app/parameter_widget.h"

namespace aspic::app {
void balls_section(Gui& gui, const Simulation& simulation, Hands& hands) {
  const float third = share_of_line(3);
  command_button(gui, "balls/throw", "Throw",
                 "Throws a ball from the camera into the middle of the picture; the key throws it at what is "
                 "under the mouse.",
                 "throw a ball", true, third);
  ImGui::SameLine();
  if (button(gui, "balls/many", "Throw many", "Throws a dozen balls, side by side.", true, third))
    hands.throw_many();
  ImGui::SameLine();
  const std::size_t thrown = simulation.setup().thrown.size();
  if (button(gui, "balls/clear", "Clear",
             thrown > 0 ? fmt::format("Remove the {} thrown balls; the scene's own stay.", thrown)
                        : std::string("There are no thrown balls; the scene's own stay."),
             thrown > 0, third))
    hands.clear_balls();
  slider(gui, "Radius", "balls/radius", hands.radius, 0.02, 2.0, "%.3g m",
         "Radius of the next ball to be thrown [m], 0.02 to 2.");
  slider(gui, "Mass", "balls/mass", hands.mass, 0.01, 1000.0, "%.3g kg",
         "Mass of the next ball to be thrown [kg], 0.01 to 1000.");
  slider(gui, "Speed", "balls/speed", hands.speed, 0.5, 200.0, "%.3g m/s",
         "Speed of the next ball to be thrown [m/s], 0.5 to 200.");
  slider(gui, "Pull", "balls/strength", hands.strength, 0.01, 100.0, "×%.3g",
         "How hard Ctrl+drag pulls a particle: a factor on twice the stiffness of the stiffest spring, "
         "0.01 to 100, limited by the time step.");
  ImGui::TextDisabled("%zu of the scene, %zu thrown",
                      static_cast<std::size_t>(simulation.model().ball_count()) - thrown, thrown);
}

}  // namespace aspic::app

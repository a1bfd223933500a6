#include "render/overlay_text.h"

#include <fmt/format.h>

#include <cmath>

#include "model/cube.h"
#include "model/model.h"
#include "model/terrain.h"

namespace aspic {
namespace {

std::string triple(const Vec3& v) {
  return fmt::format("({}, {}, {})", short_number(v.x), short_number(v.y), short_number(v.z));
}

std::string springs(const SpringSettings& s) {
  return fmt::format("k {} N/m   c {} N·s/m", short_number(s.stiffness), short_number(s.damping));
}

std::string terrain_names(const std::vector<TerrainSettings>& terrain) {
  std::string names;
  for (const TerrainSettings& t : terrain) {
    names += names.empty() ? "" : ", ";
    names += terrain_row(t.shape).title;
  }
  return names.empty() ? "none" : names;
}

}  // namespace

std::string short_number(double value) {
  if (value == 0.0) return "0";
  std::string text = fmt::format("{:.4g}", value);
  const double size = std::abs(value);
  if (size >= 1e4 && size < 1e6) text = fmt::format("{:.0f}", value);
  if (text.starts_with('-')) text = "−" + text.substr(1);
  return text;
}

std::vector<OverlayLine> overlay_lines(const ModelSettings& settings, double time) {
  std::vector<OverlayLine> lines;
  lines.push_back({"terrain", terrain_names(settings.terrain)});
  lines.push_back({"integrator", std::string(row_of(settings.simulation.integrator).title)});
  lines.push_back({"time step h", short_number(1000.0 * settings.simulation.timestep) + " ms"});
  if (!settings.cubes.empty()) {
    const CubeSettings& cube = settings.cubes.front();
    SpringSettings structural = cube.structural, shear = cube.shear, bending = cube.bending;
    if (cube.material)
      structural = shear = bending =
          material_springs(*cube.material, cube.particles_per_edge, cube.edge_length);
    lines.push_back({"structural", springs(structural)});
    lines.push_back({"shear", springs(shear)});
    lines.push_back({"bending", springs(bending)});
    const std::string more =
        settings.cubes.size() > 1 ? fmt::format("   (first of {} cubes)", settings.cubes.size()) : "";
    lines.push_back({"offset", triple(cube.position) + " m" + more});
    lines.push_back({"rotation", fmt::format("{}° about {}", short_number(cube.rotation.angle),
                                             triple(cube.rotation.axis))});
  }
  lines.push_back({"time", fmt::format("{:.3f} s", time)});
  return lines;
}

}  // namespace aspic

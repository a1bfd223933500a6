#include "scene/reference.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>
#include <vector>

#include "aspic/scene.h"
#include "model/terrain.h"
#include "scene/diagnostics.h"
#include "scene/parameters.h"

namespace aspic {
namespace {

std::string section_heading(std::string_view section, std::string_view option) {
  if (section.empty()) return "## Top of the file\n\n";
  std::string heading = fmt::format("## `{}`\n\n", diagnostics::table_text(section));
  if (section.ends_with("[]")) {
    heading += fmt::format("Repeatable. `{}` counts from 0: `{}[0]`.\n\n", option,
                           section.substr(0, section.size() - 2));
  }
  return heading;
}

std::vector<std::string_view> shapes_with(const Parameter& p) {
  std::vector<std::string_view> titles;
  for (const TerrainShapeRow& row : terrain_shapes) {
    if (belongs_to_shape(p, row.value)) titles.push_back(row.title);
  }
  return titles;
}

std::string condition(const Parameter& p) {
  switch (p.belonging) {
    case Belonging::always:
      break;
    case Belonging::geometry:
      return fmt::format(" Only for {}.", diagnostics::list_text(shapes_with(p), false));
    case Belonging::motion:
      return " Without `motion` a terrain never moves.";
    case Belonging::explicit_springs:
      return " Not together with `material`.";
    case Belonging::material:
      return " With `material`.";
    case Belonging::material_name:
      return p.section() == "voxels[]" ? " Not together with `palette`; short: `material = \"…\"`."
                                       : " Short: `material = \"…\"`.";
    case Belonging::material_numbers:
      if (p.section() == "voxels[]") return " Not together with `palette`.";
      return " Instead of `particle-mass`, `structural`, `shear` and `bending`.";
    case Belonging::equal_edges:
      return " Not together with `particles`.";
    case Belonging::box:
      return " Instead of `particles-per-edge`.";
    case Belonging::amplitude:
      return " Not together with `volume-change`.";
    case Belonging::wave:
      return " With `along`.";
    case Belonging::signal_table:
      return " With `signal = \"table\"`.";
  }
  return "";
}

std::string table_row(const Parameter& p) {
  return fmt::format("| `{}` | {}{} | {} | {} | {} |\n", p.key(), p.meaning, condition(p), allowed_text(p),
                     default_text(p), p.live ? "yes" : "no");
}

}  // namespace

std::string scene_reference(std::string_view option) {
  std::string page = fmt::format(
      "# Scene file reference\n\nA scene is one TOML file. Aspic generates this page from its parameter "
      "table: every key, its meaning,\nallowed values and default. Units are SI. Every key can be set on the "
      "command line as well,\nby its path: `{0} simulation.timestep=0.002`, `{0} "
      "'cube[0].shear.stiffness=10'`, `{0} contact.model=course`,\n`{0} 'cube[0].pinned=[\"top\", 3]'`. A "
      "value is written as in the file; a single word needs no quotation marks.\n`[+]` in the place of an "
      "index adds an element: `{0} 'ball[+]={{ radius = 0.2 }}'`.\nA key marked *live* may change while a "
      "simulation runs; changing any other restarts it.\n\nA scene has only the parts that its file has: "
      "without `[[cube]]` there is no cube. Inner tables may be written\ninline, `shear = {{ stiffness = "
      "2000.0, damping = 60.0 }}`, or as separate tables.\n\n",
      option);
  std::string_view section = "-";
  for (const Parameter& p : parameters()) {
    if (p.section() != section) {
      section = p.section();
      if (!page.ends_with("\n\n")) page += '\n';
      page += section_heading(section, option) +
              "| key | meaning | allowed | default | live |\n|---|---|---|---|---|\n";
    }
    page += table_row(p);
  }
  page += "\n## Built-in scenes\n\n| group | name | |\n|---|---|---|\n";
  std::string_view group;
  for (const BuiltinScene& scene : list_builtin_scenes()) {
    const bool first = std::exchange(group, scene.group) != scene.group;
    page += fmt::format("| {} | `{}` | {} |\n", first ? group : "", scene.name, scene.description);
  }
  return page;
}

}  // namespace aspic

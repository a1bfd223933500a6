#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/json_report.h"
#include "cli/stability_text.h"
#include "scene/import_configuration.h"
#include "scene/load.h"
#include "scene/write.h"

namespace aspic::cli {
Status scene_list_command(const SceneListOptions& options) {
  const std::vector<BuiltinScene> scenes = list_builtin_scenes();
  if (options.json) {
    JsonArray array;
    for (const BuiltinScene& scene : scenes) {
      array.emplace_back(JsonObject{{"name", scene.name}, {"description", scene.description}});
    }
    return print_data(to_json({{"scenes", array}}));
  }
  std::string text;
  for (const BuiltinScene& scene : scenes) text += fmt::format("{:<20} {}\n", scene.name, scene.description);
  return print_data(text);
}

Status scene_show_command(const SceneShowOptions& options) {
  const auto scene = load_scene(options.scene, options.overrides);
  if (!scene) return scene.error();
  return print_data(to_toml(*scene));
}

Status scene_import_command(const SceneImportOptions& options) {
  const auto text = read_text_file(options.file);
  if (!text) return text.error();
  const auto imported = import_configuration(*text, options.file);
  if (!imported) return imported.error();
  for (const std::string& note : imported->notes) print_warning(note);
  return print_data(imported_toml(*imported, options.file));
}

Status scene_check_command(const SceneCheckOptions& options) {
  const auto scene = load_scene(options.scene, options.overrides);
  if (!scene) return scene.error();
  const auto model = build_model(scene->model);
  if (!model) return model.error();
  const ModelCounts counts = count(*model);
  const Integrator own = model->simulation.integrator;
  const double timestep = model->simulation.timestep;
  const std::vector<StabilityLimit> limits = stability_limits(*model, explicit_integrators);

  if (options.json) {
    JsonObject bytes, steps;
    for (const BackendBytes& backend : bytes_by_backend(*model))
      bytes.emplace_back(backend.backend, backend.bytes);
    for (std::size_t i = 0; i < limits.size(); ++i) {
      steps.emplace_back(std::string(name_of(explicit_integrators[i])),
                         JsonObject{{"step", limits[i].step ? JsonValue(*limits[i].step) : JsonValue(0.0)},
                                    {"exact", limits[i].exact}});
    }
    const Status printed = print_data(to_json({{"scene", scene->name},
                                               {"particles", counts.particles},
                                               {"pinned", counts.pinned},
                                               {"springs", JsonObject{{"structural", counts.structural},
                                                                      {"shear", counts.shear},
                                                                      {"bending", counts.bending},
                                                                      {"total", counts.springs()}}},
                                               {"balls", counts.balls},
                                               {"bytes", bytes},
                                               {"integrator", name_of(own)},
                                               {"timestep", timestep},
                                               {"stable_steps", steps}}));
    if (!printed) return printed;
  } else {
    std::string text = fmt::format("scene        {}\n", scene->name);
    text += fmt::format("particles    {}, {} of them pinned\n", counts.particles, counts.pinned);
    text += fmt::format("springs      {} ({} structural, {} shear, {} bending)\n", counts.springs(),
                        counts.structural, counts.shear, counts.bending);
    text += fmt::format("balls        {}\n", counts.balls);
    for (const BackendBytes& backend : bytes_by_backend(*model)) {
      text += fmt::format("memory       {:<24} {:>10}\n", backend.backend, gl::human_bytes(backend.bytes));
    }
    for (std::size_t i = 0; i < limits.size(); ++i) {
      text += fmt::format("stable step  {:<24} {:>10}\n", name_of(explicit_integrators[i]),
                          stability_figure(limits[i]));
    }
    text += fmt::format("time step    {:<24} {:>8} s\n", name_of(own), timestep);
    if (const Status printed = print_data(text); !printed) return printed;
  }
  const auto at = std::find(explicit_integrators.begin(), explicit_integrators.end(), own);
  if (at != explicit_integrators.end()) {
    const StabilityLimit& limit = limits[static_cast<std::size_t>(at - explicit_integrators.begin())];
    if (exceeds(timestep, limit)) {
      print_warning(
          fmt::format("the time step {} s is not stable: {}.", timestep, stability_sentence(own, limit)));
    }
  }
  return {};
}

}  // namespace aspic::cli

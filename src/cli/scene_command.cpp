#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/body_overlap.h"
#include "analysis/stability.h"
#include "aspic/run.h"
#include "aspic/scene.h"
#include "base/files.h"
#include "base/printable.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "cli/run_summary.h"
#include "cli/scene_contact.h"
#include "cli/scene_materials.h"
#include "io/program.h"
#include "model/counts.h"
#include "model/springs.h"
#include "model/voxels.h"
#include "run/capacity.h"
#include "scene/import_configuration.h"
#include "scene/import_mesh.h"
#include "scene/parameters.h"
#include "scene/scene_checks.h"

namespace aspic::cli {
namespace {

/// What is printed of each body of cells.
struct CellFacts {
  std::size_t cells = 0, materials = 0, pieces = 0, hinges = 0;
};

CellFacts facts_of(const ModelSettings& settings, const VoxelsSettings& voxels) {
  const auto found = shape_of(voxels);
  const auto* const shape = std::get_if<VoxelShape>(&found);  // the scene was checked
  if (!shape) return {};
  const std::size_t pieces = voxels.pieces == Pieces::all ? shape->pieces : 1;
  return {shape->full, materials_of(settings, voxels, *shape).materials.size(), pieces,
          hinges(shape->lattice)};
}

std::string cells_text(const ModelSettings& settings, const VoxelsSettings& voxels) {
  const auto several = [](std::size_t count, std::string_view what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  const CellFacts f = facts_of(settings, voxels);
  return fmt::format("cells        {} of {}, {}, {}{}\n", f.cells, several(f.materials, "material"),
                     several(f.pieces, "piece"), several(f.hinges, "hinge"),
                     voxels.name.empty() ? "" : fmt::format(" ({})", printable_line(voxels.name)));
}

Json cells_of(const ModelSettings& settings) {
  Json all = Json::array();
  for (const VoxelsSettings& voxels : settings.voxels) {
    const CellFacts f = facts_of(settings, voxels);
    all.push_back(
        {{"cells", f.cells}, {"materials", f.materials}, {"pieces", f.pieces}, {"hinges", f.hinges}});
  }
  return all;
}

}  // namespace

Status execute(const SceneListOptions& options) {
  const std::vector<BuiltinScene> scenes = list_builtin_scenes();
  if (options.json) {
    Json array = Json::array();
    for (const BuiltinScene& scene : scenes)
      array.push_back({{"name", scene.name}, {"group", scene.group}, {"description", scene.description}});
    return print_data(to_text({{"scenes", array}}));
  }
  std::size_t widest = 0;
  for (const BuiltinScene& scene : scenes) widest = std::max(widest, scene.name.size());
  std::string text;
  std::string_view group;
  for (const BuiltinScene& scene : scenes) {
    if (std::exchange(group, scene.group) != scene.group)
      text += fmt::format("{}{}\n", text.empty() ? "" : "\n", group);
    text += fmt::format("  {:<{}}  {}\n", scene.name, widest, scene.description);
  }
  return print_data(text);
}

Status execute(const SceneShowOptions& options) {
  ASPIC_TRY(const auto scene, load_scene(options.scene, options.overrides, by_set));
  return print_data(to_toml(scene));
}

namespace {

Status import_as_body(const SceneImportOptions& options) {
  MeshImport import = {options.file, options.cells, options.height};
  if (options.up) import.up = *options.up;
  if (options.pieces) import.pieces = *options.pieces;
  ProgressBar bar(100, "part");
  import.watch = [&](double share) { bar.update(static_cast<std::uint64_t>(70.0 * share));
};
ASPIC_TRY(auto imported, import_mesh(import));
for (const std::string& note : imported.notes)
  print_message(fmt::format("{}: {}.", printable_line(options.file), note));
ASPIC_TRY(const auto model, build_model(imported.scene.model));
bar.update(85);
double& timestep = imported.scene.model.simulation.timestep;
timestep =
    usual_timestep(stability_limit(model, model.simulation.integrator, StabilityEffort::quick), timestep);
timestep = std::min(timestep, find_parameter("simulation.timestep")->range.max);
if (const auto wrong = check_scene(imported.scene); !wrong.empty())
  return fail(ErrorCode::scene_rejected,
              "{}: a scene of this size is out of range: {}. Give another --height.",
              printable_line(options.file), wrong.front().message);
return print_data(imported_toml(imported, options.file));
}  // namespace

/// Springs that an actuator acts on, alone or among others.
std::vector<std::uint64_t> springs_by_actuator(const Model& model) {
  const Actuation& all = model.actuation;
  const std::vector<std::uint64_t> springs = springs_by_class(model);
  std::vector<std::uint64_t> counts(all.actuators.size(), 0);
  for (const ActuatedClass& each : all.classes) {
    std::set<std::uint32_t> acting;
    for (std::uint32_t s = each.first_share; s < each.first_share + each.share_count; ++s)
      for (const std::uint32_t drive : all.stretches[all.shares[s].stretch].drives)
        acting.insert(all.drives[drive].actuator);
    for (const std::uint32_t actuator : acting) counts[actuator] += springs[each.spring_class];
  }
  return counts;
}

/// Its law with its numbers: "r = r0·(1 + 0.1·w), w = sin 2π(2·(t − 1) + φ), 5 phases".
std::string formula(const Model& model, std::size_t index) {
  const Actuator& a = model.actuation.actuators[index];
  const std::string time = a.start == 0.0 ? "t" : fmt::format("(t - {:.6g})", a.start);
  std::set<double> phases;
  for (const Drive& drive : model.actuation.drives)
    if (drive.actuator == index) phases.insert(drive.phase);
  const bool one = phases.size() == 1;
  std::string phase =
      one ? *phases.begin() == 0.0
                ? ""
                : fmt::format(" {} {:.6g}", *phases.begin() < 0.0 ? '-' : '+', std::abs(*phases.begin()))
          : " + phase";
  std::string w;
  if (a.signal == Signal::sine)
    w = fmt::format("sin 2π({:.6g}·{}{})", a.frequency, time, phase);
  else if (a.signal == Signal::input)
    w = fmt::format("channel {}", a.channel);
  else
    w = fmt::format("{}({:.6g}·{}{})", name_of(a.signal), a.frequency, time, phase);
  std::string text =
      fmt::format("r = r0·(1 {} {:.6g}·w), w = {}", a.amplitude < 0.0 ? '-' : '+', std::abs(a.amplitude), w);
  if (!one && a.signal != Signal::input) text += fmt::format(", {} phases", phases.size());
  if (a.axis != BodyAxis::none) text += fmt::format(", along {}", "?xyz"[static_cast<std::size_t>(a.axis)]);
  if (a.ramp > 0.0) text += fmt::format(", growing for {:.6g} s", a.ramp);
  return text;
}

double shortest_share(const Model& model) {
  double least = 1.0;
  const std::vector<LengthRange> ranges = rest_length_ranges(model);
  for (std::size_t c = 0; c < ranges.size(); ++c)
    if (const double r = model.spring_classes[c].rest_length; r > 0.0)
      least = std::min(least, ranges[c].least / r);
  return least;
}

Json actuators_of(const Model& model) {
  Json list = Json::array();
  const std::vector<std::uint64_t> springs = springs_by_actuator(model);
  for (std::size_t a = 0; a < springs.size(); ++a)
    list.push_back({{"name", model.actuation.actuators[a].name},
                    {"springs", springs[a]},
                    {"formula", formula(model, a)}});
  return list;
}

std::string actuators_text(const Model& model) {
  std::string text;
  const std::vector<std::uint64_t> springs = springs_by_actuator(model);
  for (std::size_t a = 0; a < springs.size(); ++a)
    text += fmt::format("actuator     {}: {} springs, {}\n",
                        printable_line(model.actuation.actuators[a].name), springs[a], formula(model, a));
  if (text.empty()) return text;
  return text + fmt::format(
                    "actuation    shortest rest length {:.4g} of that at rest; held there, its springs would "
                    "store {:.4g} J\n",
                    shortest_share(model), largest_actuation_energy(model));
}

/// Keys that were changed and act on nothing: a net has springs of a kind only where that has a stiffness.
std::vector<std::string> idle_keys(const ModelSettings& settings) {
  std::vector<std::string> notes;
  for (std::size_t n = 0; n < settings.goal_nets.size(); ++n) {
    const GoalNetSettings &net = settings.goal_nets[n], usual;
    const auto look = [&](std::string_view kind, const OptionalSpringSettings& spring,
                          const OptionalSpringSettings& otherwise) {
      if (spring.stiffness == 0.0 && spring.damping != otherwise.damping)
        notes.push_back(fmt::format(
            "goal-net[{}].{}.damping has no effect: its {}.stiffness is 0, so the net has no such springs.",
            n, kind, kind));
    };
    if (net.material) continue;
    look("shear", net.shear, usual.shear);
    look("bending", net.bending, usual.bending);
  }
  return notes;
}

/// Whether a file's name ends as those of meshes do that other programs read.
bool is_another_mesh(const std::string& file) {
  constexpr std::string_view endings[] = {".3mf",  ".blend", ".dae",  ".fbx", ".glb", ".gltf",
                                          ".msh",  ".off",   ".step", ".stp", ".usd", ".usda",
                                          ".usdc", ".usdz",  ".vtk",  ".vtu", ".wrl", ".x3d"};
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(endings, ending) != std::end(endings);
}

}  // namespace aspic::cli

Status execute(const SceneImportOptions& options) {
  if (names_mesh(options.file)) return import_as_body(options);
  if (options.cells || options.height || options.up || options.pieces)
    return fail(ErrorCode::usage,
                "--cells, --height, --up and --pieces apply to mesh files only (.obj, .stl, .ply), and {} is "
                "not one.",
                printable_line(options.file));
  if (is_another_mesh(options.file))
    return fail(ErrorCode::scene_rejected,
                "{}: unsupported mesh format (supported: .obj, .stl and .ply). Convert it, for example in "
                "Python by trimesh.load(…, force=\"mesh\").export(\"mesh.ply\").",
                printable_line(options.file));
  ASPIC_TRY(const auto text, read_file(options.file));
  ASPIC_TRY(const auto imported, import_configuration(text, options.file));
  for (const std::string& note : imported.notes) print_warning(note);
  return print_data(imported_toml(imported, options.file));
}

Status execute(const SceneCheckOptions& options) {
  const InterruptGuard interrupt;
  std::vector<std::string> notes;
  LoadOptions how = by_set;
  how.notes = &notes;
  ASPIC_TRY(const auto scene, load_scene(options.scene, options.overrides, how));
  for (const std::string& note : notes) print_message(note + ".");
  ASPIC_TRY(const auto model, build_model(scene.model));
  const ModelCounts counts = count(model);
  const Integrator own = model.simulation.integrator;
  const double timestep = model.simulation.timestep;
  std::vector<StabilityLimit> limits;
  const ContactFacts contacts = contact_facts(model);
  ContactLimits contact_steps;
  {
    ProgressBar bar(100, "stable steps: part");
    const auto watch = [&](double share) {
      bar.update(static_cast<std::uint64_t>(100.0 * share));
      return !interrupt.interrupted();
    };
    limits = stability_limits(model, explicit_integrators, StabilityEffort::thorough, watch);
    if (!contacts.pairings.empty()) {
      const auto steps_in_contact = [&](Meeting meeting) {
        return contact_limits(model, explicit_integrators, meeting, StabilityEffort::thorough, watch);
      };
      contact_steps = {steps_in_contact(Meeting::faces), steps_in_contact(Meeting::edges)};
    }
  }
  if (interrupt.interrupted())
    return Error{ErrorCode::interrupted,
                 "interrupted before the stable steps were known; nothing was printed."};

  const std::vector<Diagnostic> found = RunWatch(scene.model, model).at_start();
  const std::optional<DeviceCapacity> capacity = device_capacity(own);
  // Measured on solvers, which a crowd makes large.
  const bool crowd = has_crowd(model, initial_state(model, Precision::double_));
  const auto backend_bytes = crowd ? decltype(bytes_by_backend(model)){} : bytes_by_backend(model);
  if (options.json) {
    Json largest = Json::object();
    if (capacity)
      for (const CubeCapacity& cube : capacity->cubes)
        largest[std::string(cube.force_path)] = cube.particles_per_edge;
    Json bytes = backend_bytes.empty() ? Json() : Json::object();
    Json steps = limits.empty() ? Json() : Json::object();
    for (const BackendBytes& backend : backend_bytes)
      bytes[backend.backend] = backend.bytes ? Json(*backend.bytes) : Json();
    for (std::size_t i = 0; i < limits.size(); ++i) {
      steps[std::string(name_of(explicit_integrators[i]))] = {{"step", limits[i].step.value_or(0.0)},
                                                              {"exact", limits[i].exact}};
    }
    ASPIC_CHECK(print_data(to_text({{"scene", scene.name},
                                    {"particles", counts.particles},
                                    {"pinned", counts.pinned},
                                    {"springs", Json{{"structural", counts.structural},
                                                     {"shear", counts.shear},
                                                     {"bending", counts.bending},
                                                     {"total", counts.springs()}}},
                                    {"balls", counts.balls},
                                    {"voxels", cells_of(scene.model)},
                                    {"actuators", actuators_of(model)},
                                    {"model_bytes", model_bytes(model)},
                                    {"state_bytes", state_bytes(counts)},
                                    {"bytes", bytes},
                                    {"integrator", name_of(own)},
                                    {"timestep", timestep},
                                    {"stable_steps", steps},
                                    {"contact", contact_json(scene, model, contacts, contact_steps)},
                                    {"materials", materials_json(scene.model)},
                                    {"diagnostics", to_json(found)},
                                    {"largest_cubes", capacity ? largest : Json()}})));
  } else {
    std::string text = fmt::format("scene        {}\n", scene.name);
    text += fmt::format("particles    {}, {} of them pinned\n", counts.particles, counts.pinned);
    text += fmt::format("springs      {} ({} structural, {} shear, {} bending)\n", counts.springs(),
                        counts.structural, counts.shear, counts.bending);
    text += fmt::format("balls        {}\n", counts.balls);
    for (const VoxelsSettings& voxels : scene.model.voxels) text += cells_text(scene.model, voxels);
    text += actuators_text(model);
    const std::uint64_t shared = model_bytes(model) + state_bytes(counts);
    text += fmt::format("memory       {:<24} {:>10}\n", "model", human_bytes(model_bytes(model)));
    text += fmt::format("memory       {:<24} {:>10}\n", "state", human_bytes(state_bytes(counts)));
    if (crowd)
      text += fmt::format("memory       unknown for backends: more than {} bodies are in one place\n",
                          most_crowded);
    for (const auto& [backend, bytes] : backend_bytes) {
      text += bytes ? fmt::format("memory       {:<24} {:>10}, a run {}\n", backend, human_bytes(*bytes),
                                  human_bytes(shared + *bytes))
                    : fmt::format("memory       {:<24} more than is free\n", backend);
    }
    if (capacity) {
      for (const CubeCapacity& cube : capacity->cubes)
        text += fmt::format("largest cube gpu:{:<20} {:>10}, by {}\n", cube.force_path,
                            fmt::format("{}^3", cube.particles_per_edge), limit_text(cube));
    }
    for (std::size_t i = 0; i < limits.size(); ++i) {
      text += fmt::format("stable step  {:<24} {:>10}", name_of(explicit_integrators[i]),
                          stability_figure(limits[i]));
      if (!contact_steps.faces.empty())
        text += fmt::format("; in contact {}, edges on edges {}", stability_figure(contact_steps.faces[i]),
                            stability_figure(contact_steps.edges[i]));
      text += "\n";
    }
    text += fmt::format("time step    {:<24} {:>8} s\n", name_of(own), timestep);
    text += materials_text(scene.model);
    text += contact_text(scene, model, contacts);
    ASPIC_CHECK(print_text(text));
  }
  const auto at = std::find(explicit_integrators.begin(), explicit_integrators.end(), own);
  if (at != explicit_integrators.end()) {
    const StabilityLimit& limit = limits[static_cast<std::size_t>(at - explicit_integrators.begin())];
    if (exceeds(timestep, limit)) {
      print_warning(unstable_sentence(timestep, own, limit));
    }
  }
  for (const std::string& note : idle_keys(scene.model)) print_message(note);
  for (const Diagnostic& each : found) print_warning(each.sentence());
  for (const std::string& warning : contact_warnings(model, contacts, contact_steps)) print_warning(warning);
  return {};
}

}  // namespace aspic::cli

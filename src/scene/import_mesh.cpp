#include "scene/import_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/files.h"
#include "base/printable.h"
#include "mesh/read_mesh.h"
#include "scene/write.h"

namespace aspic {
namespace {

/// What every imported scene has. The mesh comes by argument, so that messages speak of its file.
constexpr std::string_view frame = R"(schema = 1
[simulation]
integrator = "symplectic-euler"
timestep = 0.001
[[terrain]]
shape = "plane"
point = [0, 0, 0]
[[voxels]]
material = { density = 1000.0, damping-ratio = 0.2 }
)";

/// The number of one digit that is nearest by ratio.
double rounded_to_a_digit(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  return std::round(x / power) * power;
}

/// Three digits, as a person would write them.
double to_digits(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)) - 2.0);
  return power < 1.0 ? std::round(x / power) / std::round(1.0 / power) : std::round(x / power) * power;
}

}  // namespace

bool names_mesh(const std::string& file) {
  const auto builtin = builtin_meshes();
  return std::ranges::find(mesh_endings, ending_of(file)) != std::end(mesh_endings) ||
         std::ranges::find(builtin, file) != builtin.end();
}

Result<ImportedMesh> import_mesh(const MeshImport& import) {
  std::vector<std::string> keys = {"mesh=" + toml_value(Value(import.file)),
                                   "up=" + toml_value(Value(import.up)),
                                   "pieces=" + toml_value(Value(import.pieces))};
  if (import.cells) keys.push_back(fmt::format("cells={}", *import.cells));
  if (import.height) keys.push_back(fmt::format("height={}", *import.height));
  for (std::string& key : keys) key.insert(0, "voxels[0].");
  if (const auto file = load_mesh(import.file); !file) return file.error();
  ImportedMesh made;
  ASPIC_TRY(made.scene, parse_scene(frame, "import.toml", keys, {.notes = &made.notes}));
  const std::string said_before = printable_line(import.file) + ": ";
  for (std::string& note : made.notes)
    if (note.starts_with(said_before)) note.erase(0, said_before.size());
  made.scene.name = std::filesystem::path(import.file).stem().string();

  VoxelsSettings& body = made.scene.model.voxels.front();
  const double high = body.size * static_cast<double>(body.layers.size());
  const double reach =
      body.size *
      static_cast<double>(std::max({body.layers.size(), body.layers[0].size(), body.layers[0][0].size()}));
  body.position = {0.0, to_digits(high), 0.0};  // half its height above the ground
  // A column of height H shrinks by ρ·g·H/2E of its height at rest: a fortieth.
  body.material.youngs_modulus = rounded_to_a_digit(20.0 * body.material.density * 9.8 * high);
  CameraSettings& camera = made.scene.view.camera;
  camera.target = {0.0, to_digits(0.7 * high), 0.0};
  camera.position = {to_digits(1.5 * reach), to_digits(0.7 * high + 0.8 * reach), to_digits(2.4 * reach)};
  camera.fov = 35.0;
  return made;
}

std::string imported_toml(const ImportedMesh& imported, const std::string& file_name) {
  std::string text = fmt::format("# Imported from {}.\n", printable_line(file_name));
  for (const std::string& note : imported.notes) text += fmt::format("# {}.\n", printable_line(note));
  return text + to_toml(imported.scene);
}

}  // namespace aspic

#include "scene/import_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/files.h"
#include "base/printable.h"
#include "mesh/read_mesh.h"
#include "scene/mesh_cells.h"
#include "scene/new_body.h"
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

constexpr double usual_gravity = 9.8;  // m/s²

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

double longest_edge(const Vec3& extent) {
  return std::max({extent.x, extent.y, extent.z});
}

/// Vertices of files may be no finite numbers, which repairs leave out.
Vec3 finite_extent(const TriangleMesh& mesh) {
  Bounds bounds;
  for (const Vec3& v : mesh.vertices)
    if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) bounds.add(v);
  return bounds.extent();
}

/// The height to which a mesh of that extent is scaled among bodies that long [m]; 0: its own.
double height_among(const Vec3& extent, double among) {
  constexpr double most = 10.0;  // times as long
  const double own = longest_edge(extent);
  if (!(own > 0.0) || !std::isfinite(own) || !(among > 0.0)) return 0.0;
  return own > most * among || own < among / most ? extent.y * to_digits(among) / own : 0.0;
}

/// Young's modulus with which a body of that height [m] shrinks by a fortieth under its weight: a column of
/// height H by ρ·g·H/2E of its height at rest.
double modulus_to_stand(const MaterialSettings& material, double gravity, double high) {
  return rounded_to_a_digit(20.0 * material.density * gravity * high);
}

double height_of(const VoxelsSettings& body) {
  return body.size * static_cast<double>(body.layers.size());
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
  ASPIC_TRY(made.scene,
            parse_scene(frame, "import.toml", keys, {.notes = &made.notes, .watch = import.watch}));
  const std::string said_before = printable_line(import.file) + ": ";
  for (std::string& note : made.notes)
    if (note.starts_with(said_before)) note.erase(0, said_before.size());
  made.scene.name = std::filesystem::path(import.file).stem().string();

  VoxelsSettings& body = made.scene.model.voxels.front();
  const double high = height_of(body);
  const double reach =
      body.size *
      static_cast<double>(std::max({body.layers.size(), body.layers[0].size(), body.layers[0][0].size()}));
  body.position = {0.0, to_digits(high), 0.0};  // half its height above the ground
  body.material.youngs_modulus = modulus_to_stand(body.material, usual_gravity, high);
  // Bodies rest up to the contact distance above terrain.
  ContactSettings& contact = made.scene.model.contact;
  if (contact.distance > 0.1 * body.size)
    contact.distance = contact.resting_speed = to_digits(0.02 * body.size);
  CameraSettings& camera = made.scene.view.camera;
  camera.target = {0.0, to_digits(0.7 * high), 0.0};
  camera.position = {to_digits(1.5 * reach), to_digits(0.7 * high + 0.8 * reach), to_digits(2.4 * reach)};
  camera.fov = 35.0;
  made.scene.view.aimed = false;
  return made;
}

Result<std::vector<std::string>> add_mesh(Scene& scene, const std::string& file) {
  ASPIC_TRY(const MeshFile mesh, load_mesh(file));
  const Vec3 extent = finite_extent(mesh.mesh);
  VoxelizationSettings how;
  how.cells = usual_mesh_cells;
  how.height = height_among(extent, longest_extent(scene.model));
  VoxelsSettings body;
  ASPIC_TRY(std::vector<std::string> notes, take_mesh(body, mesh, how, file));
  if (how.height > 0.0)
    notes.push_back(fmt::format("its file gives {:.4g} m; scaled to {:.4g} m, the size of the other bodies",
                                longest_edge(extent), longest_edge(extent) * how.height / extent.y));
  body.material.density = 1000.0;
  body.material.damping_ratio = 0.2;
  const double gravity = length(scene.model.simulation.gravity);
  body.material.youngs_modulus =
      modulus_to_stand(body.material, gravity > 0.0 ? gravity : usual_gravity, height_of(body));
  scene.model.voxels.push_back(std::move(body));
  const auto is_of_cells = [](const BodyRow& row) { return row.list.key == "voxels"; };
  place_body(scene, std::ranges::find_if(body_rows(), is_of_cells)->list, scene.model.voxels.size() - 1);
  return notes;
}

std::string imported_toml(const ImportedMesh& imported, const std::string& file_name) {
  std::string text = fmt::format("# Imported from {}.\n", printable_line(file_name));
  for (const std::string& note : imported.notes) text += fmt::format("# {}.\n", printable_line(note));
  return text + to_toml(imported.scene);
}

}  // namespace aspic

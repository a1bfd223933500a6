// Readers of meshes, and what becomes of what they read.
#include <cmath>
#include <cstring>

#include "fuzz/targets.h"
#include "mesh/read_mesh.h"
#include "mesh/voxelize.h"
#include "model/skin.h"

namespace aspic::fuzz {
namespace {

/// What is accepted has its indices in range; repaired it is finite, oriented the same when it is repaired
/// again, and becomes cells with a skin or an error.
void run_mesh(Result<MeshFile> (*parse)(std::string_view, const std::string&), std::string_view bytes) {
  const auto read = parse(bytes, "fuzz.mesh");
  if (!read) return require_message(read.error(), {ErrorCode::scene_rejected});
  require(!read->mesh.triangles.empty(), "an accepted mesh has a face");
  for (const Triangle& t : read->mesh.triangles)
    for (const std::uint32_t v : t)
      require(v < read->mesh.vertices.size(), "faces name vertices that there are");
  if (read->mesh.triangles.size() > 2000) return;  // as much as is quickly repaired
  const RepairedMesh repaired = repair_mesh(read->mesh);
  for (const Vec3& v : repaired.mesh.vertices) require(is_finite(v), "repaired vertices are finite");
  const auto made = voxelize(read->mesh, {.cells = 6}, "fuzz.mesh");
  if (!made) return require_message(made.error(), {ErrorCode::scene_rejected});
  require(made->grid.full_count() > 0, "a body has cells");
  std::vector<Vec3> in_cells = made->skin.vertices;
  for (Vec3& v : in_cells) v = (v - made->grid.origin) / made->grid.size;
  const SkinBinding binding = bind_skin(lattice_of(made->grid), in_cells);
  for (const SkinVertex& v : binding.vertices)
    require(made->grid.is_full(v.cell[0], v.cell[1], v.cell[2]) && is_finite(v.at),
            "a skin hangs on full cells");
}

void run_obj(std::string_view bytes) {
  run_mesh(parse_obj, bytes);
}
void run_stl(std::string_view bytes) {
  run_mesh(parse_stl, bytes);
}
void run_ply(std::string_view bytes) {
  run_mesh(parse_ply, bytes);
}

/// The corners of a cube, and its sides.
constexpr double corners[8][3] = {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1},
                                  {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}};
constexpr int sides[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                             {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};

std::vector<std::string> obj_seeds() {
  std::string whole = "# cube\no cube\n", relative = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  for (const auto& c : corners)
    whole += "v " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) + "\n";
  for (const auto& s : sides) {
    whole += "f";
    for (const int corner : s) whole += " " + std::to_string(corner + 1) + "/1/1";
    whole += "\n";
  }
  relative += "f -4 -2 -3\nf -4 -3 -1\\\n\nf -4 -1 -2\nf -3 -2 -1 # end\n";
  return {whole, relative};
}

std::vector<std::string> stl_seeds() {
  std::string ascii = "solid cube\n", binary(80, 'x');
  const auto append = [&](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    binary.append(raw, sizeof value);
  };
  append(std::uint32_t{12});
  for (const auto& s : sides) {
    for (const auto& t : {std::array{s[0], s[1], s[2]}, std::array{s[0], s[2], s[3]}}) {
      ascii += "facet normal 0 0 0\nouter loop\n";
      for (int i = 0; i < 3; ++i) append(0.0f);
      for (const int corner : t) {
        ascii += "vertex";
        for (const double x : corners[corner]) {
          ascii += " " + std::to_string(x);
          append(static_cast<float>(x));
        }
        ascii += "\n";
      }
      ascii += "endloop\nendfacet\n";
      append(std::uint16_t{0});
    }
  }
  return {ascii + "endsolid cube\n", binary};
}

std::vector<std::string> ply_seeds() {
  std::vector<std::string> seeds;
  for (const int format : {0, 1, 2}) {
    const char* const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    std::string file = "ply\nformat " + std::string(names[format]) +
                       " 1.0\ncomment cube\nelement vertex 8\nproperty float x\nproperty double y\nproperty "
                       "short z\nelement face 6\nproperty "
                       "list uchar int vertex_indices\nend_header\n";
    const auto append = [&](auto value) {
      if (format == 0) {
        file += std::to_string(static_cast<double>(value)) + " ";
        return;
      }
      char raw[sizeof value];
      std::memcpy(raw, &value, sizeof value);
      for (std::size_t i = 0; i < sizeof value; ++i) file += raw[format == 1 ? i : sizeof value - 1 - i];
    };
    for (const auto& c : corners) {
      append(static_cast<float>(c[0]));
      append(c[1]);
      append(static_cast<std::int16_t>(c[2]));
    }
    for (const auto& s : sides) {
      append(std::uint8_t{4});
      for (const std::int32_t corner : s) append(corner);
    }
    seeds.push_back(file);
  }
  return seeds;
}

std::vector<std::string> obj_words() {
  return {"v ",   "f ", "vn ", "vt ",     "usemtl ", "surf ",   "-1",         "1//1", "1/1/1",
          "\\\n", "#",  "nan", "1.#QNAN", "1e308",   "-1e-320", "4294967295", "0,5"};
}
std::vector<std::string> stl_words() {
  return {"solid",
          "facet normal",
          "outer loop",
          "vertex ",
          "endloop",
          "endfacet",
          "endsolid",
          "nan",
          "inf",
          "1e39",
          std::string(4, '\0'),
          "\xff\xff\xff\xff",
          std::string("\x01\0\0\0", 4)};
}
std::vector<std::string> ply_words() {
  return {"ply\n",
          "format ascii 1.0\n",
          "format binary_little_endian 1.0\n",
          "format binary_big_endian 1.0\n",
          "element vertex ",
          "element face ",
          "element tristrips ",
          "property float x\n",
          "property list uchar int vertex_indices\n",
          "property list int uint vertex_index\n",
          "property double ",
          "comment ",
          "end_header\n",
          "9223372036854775807",
          "-1",
          "nan",
          "\xff\xff\xff\xff"};
}

}  // namespace

const Target mesh_obj_target = {"mesh-obj", run_obj, obj_seeds, obj_words};
const Target mesh_stl_target = {"mesh-stl", run_stl, stl_seeds, stl_words};
const Target mesh_ply_target = {"mesh-ply", run_ply, ply_seeds, ply_words};

}  // namespace aspic::fuzz

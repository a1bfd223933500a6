// From the bytes of a mesh file to cells and a skin (Google Benchmark):
//   build/release/bench/mesh_figures
// The mesh is a torus of 20,000 triangles of which 5 % are missing, as a binary STL; the argument is cells
// along its longest edge.
#include <benchmark/benchmark.h>

#include "checked.h"
#include "mesh/read_mesh.h"
#include "mesh/shapes.h"
#include "mesh/voxelize.h"
#include "mesh/winding.h"
#include "model/skin.h"

namespace aspic {
namespace {

const std::string& file() {
  static const std::string made =
      test::as_stl(test::without_share(test::torus_mesh(200, 50, 1.0, 0.4), 0.05, 8));
  return made;
}

void voxelize_file(benchmark::State& state) {
  const int cells = static_cast<int>(state.range(0));
  double full = 0.0, share = 0.0;
  for ([[maybe_unused]] auto _ : state) {
    const MeshFile read = checked(parse_stl(file(), "torus.stl"));
    const VoxelizedMesh made = checked(voxelize(read.mesh, {.cells = cells}, "torus.stl"));
    std::vector<Vec3> in_cells = made.skin.vertices;
    for (Vec3& v : in_cells) v = (v - made.grid.origin) / made.grid.size;
    benchmark::DoNotOptimize(bind_skin(lattice_of(made.grid), in_cells));
    full = static_cast<double>(made.grid.full_count());
    share = made.grid.volume() / test::torus_volume(200, 50, 1.0, 0.4);
  }
  state.counters["full cells"] = full;
  state.counters["volume/true"] = share;
}
BENCHMARK(voxelize_file)->Arg(16)->Arg(32)->Arg(64)->Unit(benchmark::kMillisecond);

void read_and_repair(benchmark::State& state) {
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(repair_mesh(checked(parse_stl(file(), "torus.stl")).mesh));
}
BENCHMARK(read_and_repair)->Unit(benchmark::kMillisecond);

void winding_number_by_tree(benchmark::State& state) {
  const RepairedMesh mesh = repair_mesh(checked(parse_stl(file(), "torus.stl")).mesh);
  const WindingTree tree(mesh.mesh);
  double x = -1.4;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(tree.at({x, 0.1, 0.2}));
    x = x > 1.4 ? -1.4 : x + 0.0137;
  }
}
BENCHMARK(winding_number_by_tree);

}  // namespace
}  // namespace aspic

BENCHMARK_MAIN();

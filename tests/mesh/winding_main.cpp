// winding_points MESH POINTS: winding numbers of the mesh as it is, without repair, at points of three
// numbers a line; a line each: by the tree, and of every triangle one by one. For comparison with other
// programs (tests/python/winding_test.py).
#include <fmt/format.h>

#include <cstdio>
#include <fstream>

#include "mesh/read_mesh.h"
#include "mesh/winding.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: winding_points MESH POINTS\n");
    return 2;
  }
  const auto read = aspic::load_mesh(argv[1]);
  if (!read) {
    fmt::print(stderr, "{}\n", read.error().message());
    return 6;
  }
  const aspic::WindingTree tree(read->mesh);
  std::ifstream points(argv[2]);
  for (aspic::Vec3 p; points >> p.x >> p.y >> p.z;)
    fmt::print("{} {}\n", tree.at(p), aspic::winding_number(read->mesh, p));
  return 0;
}

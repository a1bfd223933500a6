#pragma once
// Reads a page's file as a browser does, by code that knows nothing of the writer's.
#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "aspic/vec.h"

namespace aspic::test {

/// One image of one run.
struct ReadImage {
  std::vector<Vec3> particles, balls, spins, changes;
};

/// The mesh of a body: of each vertex eight particles, and how far it is along x, y and z in their cell.
struct ReadMesh {
  std::vector<std::array<std::uint32_t, 8>> corners;
  std::vector<Vec3> at;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

struct ReadPage {
  nlohmann::json facts, ends;
  std::vector<std::vector<ReadImage>> images;  ///< by image, by run
  std::vector<std::vector<ReadMesh>> meshes;   ///< by run, by body that has one
  std::string start, module;                   ///< of a live page: the state's bytes; WebAssembly
  std::string error;                           ///< what is wrong with the file; empty: nothing
};

ReadPage read_page(const std::string& html);

}  // namespace aspic::test

#pragma once
// Reads a page's file as a browser does, by code that knows nothing of the writer's.
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "aspic/vec.h"

namespace aspic::test {

/// One picture of one run.
struct ReadPicture {
  std::vector<Vec3> particles, balls, spins, changes;
};

struct ReadPage {
  nlohmann::json facts, ends;
  std::vector<std::vector<ReadPicture>> pictures;  ///< by picture, by run
  std::string start, module;                       ///< of a live page: the state's bytes; WebAssembly
  std::string error;                               ///< what is wrong with the file; empty: nothing
};

ReadPage read_page(const std::string& html);

}  // namespace aspic::test

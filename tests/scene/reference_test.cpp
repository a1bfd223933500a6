#include "scene/reference.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace aspic {
namespace {

TEST(Reference, IsUpToDate) {
  std::ifstream file(ASPIC_SOURCE_DIR "/docs/scene-reference.md");
  std::stringstream committed;
  committed << file.rdbuf();
  EXPECT_TRUE(committed.str() == scene_reference("--set"))
      << "docs/scene-reference.md is stale; write it anew with\n"
         "  build/release/src/scene/aspic_scene_reference > docs/scene-reference.md";
}

}  // namespace
}  // namespace aspic

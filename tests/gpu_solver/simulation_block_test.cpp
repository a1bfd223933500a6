#include <gtest/gtest.h>

#include "gpu_solver/kernels.h"
#include "support/model_building.h"

namespace aspic {
namespace {

TEST(SimulationBlock, RefusesWhatItCannotHold) {
  ModelSettings settings = test::cube_on_plane(2);
  settings.terrain.resize(MAX_TERRAINS + 1);
  EXPECT_EQ(simulation_block(test::build(settings)).error().code, ErrorCode::scene_rejected);
  settings.terrain.resize(MAX_TERRAINS);
  EXPECT_TRUE(simulation_block(test::build(settings)).ok());
  settings.cubes.resize(MAX_SPRING_CLASSES / 4, settings.cubes[0]);
  EXPECT_TRUE(simulation_block(test::build(settings)).ok());
  settings.cubes.resize(MAX_SPRING_CLASSES / 4 + 1, settings.cubes[0]);
  EXPECT_EQ(simulation_block(test::build(settings)).error().code, ErrorCode::scene_rejected);
}

}  // namespace
}  // namespace aspic

// What is said of bodies within each other: at the start, and once of each pair that is too deep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "aspic/run.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

ModelSettings row_of_cubes(int count, double apart) {
  ModelSettings settings;
  for (int i = 0; i < count; ++i) {
    CubeSettings& cube = settings.cubes.emplace_back();
    cube.particles_per_edge = 5;
    cube.edge_length = 2.0;
    cube.position = {i * apart, 3.0, 0.0};
  }
  return settings;
}

TEST(OverlapWatch, NamesWhatOverlapsAtTheStart) {
  const ModelSettings settings = row_of_cubes(3, 1.9);
  const std::string text = OverlapWatch(settings, test::build(settings)).at_start();
  EXPECT_THAT(text, HasSubstr("2 pairs of bodies overlap at the start: cube[0] and cube[1] by 0.1 m, "));
  EXPECT_THAT(text, HasSubstr(" J; cube[1] and cube[2] by 0.1 m, "));
  EXPECT_THAT(text, HasSubstr("eased apart"));
  const ModelSettings apart = row_of_cubes(3, 2.1);
  EXPECT_THAT(OverlapWatch(apart, test::build(apart)).at_start(), IsEmpty());
}

TEST(OverlapWatch, NamesAFewOfManyPairs) {
  const ModelSettings settings = row_of_cubes(9, 1.9);
  const std::string text = OverlapWatch(settings, test::build(settings)).at_start();
  EXPECT_THAT(text, HasSubstr("8 pairs"));
  EXPECT_THAT(text, HasSubstr("; and 4 more."));
}

TEST(OverlapWatch, TellsOnceOfAPairThatIsTooDeep) {
  const ModelSettings settings = row_of_cubes(3, 3.0);
  const Model model = test::build(settings);
  OverlapWatch watch(settings, model);
  State state = initial_state(model, Precision::single);
  EXPECT_THAT(watch.look(state), IsEmpty());
  const auto shift = [&](std::uint32_t body, double by) {
    for (std::uint32_t i = 0; i < 125; ++i) state.position[125 * body + i].x += by;
  };
  shift(0, 2.0);  // one metre below the surface of the second, D being 0.5 m
  state.step = 1200;
  const std::string text = watch.look(state);
  EXPECT_THAT(text, HasSubstr("cube[0] and cube[1]"));
  EXPECT_THAT(text, HasSubstr("step 1200 (t = 1.2 s)"));
  EXPECT_THAT(watch.look(state), IsEmpty()) << "it was told";
  OverlapWatch other(settings, model);
  other.knows_what(watch);
  EXPECT_THAT(other.look(state), IsEmpty());
  shift(2, -2.0);
  EXPECT_THAT(watch.look(state), HasSubstr("cube[1] and cube[2]"));
}

TEST(OverlapWatch, LooksTenTimesASecondWhereBodiesTouch) {
  ModelSettings settings = row_of_cubes(2, 3.0);
  settings.simulation.timestep = 0.002;
  EXPECT_EQ(OverlapWatch(settings, test::build(settings)).next_step(0), 50u);
  EXPECT_EQ(OverlapWatch(settings, test::build(settings)).next_step(50), 100u);
  EXPECT_EQ(OverlapWatch(settings, test::build(settings)).next_step(149), 150u);
  settings.contact.bodies = false;
  EXPECT_EQ(OverlapWatch(settings, test::build(settings)).next_step(0), std::uint64_t(-1));
}

}  // namespace
}  // namespace aspic

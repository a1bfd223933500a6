#include "io/series_csv.h"

#include <gtest/gtest.h>

#include "support/temporary_directory.h"

namespace aspic {
namespace {

Model one_particle() {
  Model model;
  model.simulation.timestep = 0.5;
  model.simulation.gravity = {0.0, -10.0, 0.0};
  model.mass = {2.0};
  model.inverse_mass = {0.5};
  return model;
}

TEST(SeriesCsv, IsTheSpecifiedTableAndRepeatsNoStep) {
  const test::TemporaryDirectory dir;
  auto series = SeriesWriter::create(dir.file("e.csv"), Overwrite::refuse);
  ASSERT_TRUE(series.ok());
  State state;
  state.position = {{0.0, 3.0, 0.0}};
  state.velocity = {{1.0, 0.0, 0.0}};
  ASSERT_TRUE(series->add(one_particle(), state).ok());
  ASSERT_TRUE(series->add(one_particle(), state).ok());
  state.step = 3;
  state.position[0].y = -1.0;
  ASSERT_TRUE(series->add(one_particle(), state).ok());
  ASSERT_TRUE(series->finish().ok());
  EXPECT_EQ(dir.read("e.csv"),
            "step,time,kinetic,elastic,gravitational,total,px,py,pz,max_speed,min_height\n"
            "0,0,1,0,60,61,2,0,0,1,3\n"
            "3,1.5,1,0,-20,-19,2,0,0,1,-1\n");
}

TEST(SeriesCsv, NotANumberIsNeverWritten) {
  const test::TemporaryDirectory dir;
  auto series = SeriesWriter::create(dir.file("e.csv"), Overwrite::refuse);
  ASSERT_TRUE(series.ok());
  State state;
  state.position = {{0.0, 3.0, 0.0}};
  state.velocity = {{std::numeric_limits<double>::infinity(), 0.0, 0.0}};
  const Status added = series->add(one_particle(), state);
  ASSERT_FALSE(added.ok());
  EXPECT_EQ(added.error().code, ErrorCode::diverged);
}

}  // namespace
}  // namespace aspic

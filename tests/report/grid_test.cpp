#include "report/grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "aspic/scene.h"
#include "report/csv.h"
#include "scene/short_keys.h"

namespace aspic::report {
namespace {

using testing::ElementsAre;

Scene scene(const char* name = "cube-plane") {
  return load_scene(name).value();
}

std::vector<std::string> values(const std::string& axis) {
  const auto parsed = parse_axis(axis, scene());
  EXPECT_TRUE(parsed.ok()) << parsed.error().message();
  return parsed ? parsed->values : std::vector<std::string>{};
}

TEST(Axis, HasItsEndsAndEvenSteps) {
  EXPECT_THAT(values("h=0.001:0.002:3"), ElementsAre("0.001", "0.0015", "0.002"));
  EXPECT_THAT(values("k=500:8000:5:log"), ElementsAre("500", "1000", "2000", "4000", "8000"));
  EXPECT_THAT(values("mu=0.6:0:2"), ElementsAre("0.6", "0"));
  EXPECT_THAT(values("e=0.5:1:1"), ElementsAre("0.5"));
}

TEST(Axis, RoundsWholeNumbersAndKeepsEachOnce) {
  EXPECT_THAT(values("n=4:6:5"), ElementsAre("4", "5", "6"));
  EXPECT_THAT(values("cube[0].particles-per-edge=4:16:3:log"), ElementsAre("4", "8", "16"));
}

TEST(Axis, ListsKeepBracketsQuotesAndColons) {
  EXPECT_THAT(values("cube[0].velocity=[1,0,0],[2,0,0]"), ElementsAre("[1,0,0]", "[2,0,0]"));
  EXPECT_THAT(values("backend=cpu,reference:double"), ElementsAre("cpu", "reference:double"));
  EXPECT_THAT(values("name=\"a,b\",c"), ElementsAre("\"a,b\"", "c"));
}

TEST(Grid, LastAxisVariesFastest) {
  const auto grid = make_grid(scene(), {}, {}, {"h=0.001,0.002", "k=1:3:3"});
  ASSERT_TRUE(grid.ok()) << grid.error().message();
  ASSERT_EQ(grid->size(), 6u);
  EXPECT_THAT(grid->values(0), ElementsAre("0.001", "1"));
  EXPECT_THAT(grid->values(1), ElementsAre("0.001", "2"));
  EXPECT_THAT(grid->values(5), ElementsAre("0.002", "3"));
  const SweepRun run = grid_run(*grid, 5);
  ASSERT_FALSE(run.error);
  EXPECT_EQ(run.scene.model.simulation.timestep, 0.002);
  EXPECT_EQ(run.scene.model.cubes[0].bending.stiffness, 3.0);
}

TEST(Grid, VariesBackends) {
  const auto grid = make_grid(scene(), {}, {}, {"backend=cpu,reference:double"});
  ASSERT_TRUE(grid.ok());
  EXPECT_EQ(grid_run(*grid, 0).backend.row->name, "cpu");
  EXPECT_EQ(grid_run(*grid, 1).backend.precision, Precision::double_);
}

TEST(Grid, IdentityTellsGridsApart) {
  const auto identity = [](const char* name, const RunLength& length, const std::vector<std::string>& vary) {
    return make_grid(scene(name), {}, length, vary)->identity();
  };
  const std::string one = identity("cube-plane", {}, {"h=0.001,0.002"});
  EXPECT_EQ(one, identity("cube-plane", {}, {"h=0.001,0.002"}));
  EXPECT_NE(one, identity("cube-plane", {}, {"h=0.001,0.003"}));
  EXPECT_NE(one, identity("cube-plane", {}, {"simulation.timestep=0.001,0.002"}));
  EXPECT_NE(one, identity("cube-plane", {3, {}}, {"h=0.001,0.002"}));
  EXPECT_NE(one, identity("cube-sphere", {}, {"h=0.001,0.002"}));
}

TEST(ShortKeys, KeepRatiosOfStiffness) {
  const auto set = assignments(scene("flag"), "k", "800");  // 400, 150 and 4 N/m
  ASSERT_TRUE(set.ok()) << set.error().message();
  EXPECT_THAT(*set, ElementsAre("cloth[0].structural.stiffness=800", "cloth[0].shear.stiffness=300",
                                "cloth[0].bending.stiffness=8"));
  const auto row = find_short_key("k");
  EXPECT_EQ(present_value(scene("flag"), *row), 400.0);
  EXPECT_EQ(present_value(scene("ball-pit"), *row), std::nullopt);
}

TEST(ShortKeys, AMistypedShortNameIsFoundOut) {
  const auto set = assignments(scene(), "integratr", "heun-3");
  ASSERT_FALSE(set.ok());
  EXPECT_EQ(set.error().code, ErrorCode::usage);
  EXPECT_EQ(set.error().message(), "unknown key 'integratr'; did you mean 'integrator'?");
  EXPECT_TRUE(assignments(scene(), "name", "other").ok()) << "a key of the scene itself";
}

TEST(ShortKeys, ReachEveryTerrain) {
  const auto set = assignments(scene(), "mu", "0.5");
  ASSERT_TRUE(set.ok());
  EXPECT_THAT(*set, ElementsAre("contact.friction=0.5", "terrain[0].friction=0.5"));
}

TEST(Csv, QuotesWhatNeedsIt) {
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"no\""), "\"say \"\"no\"\"\"");
  EXPECT_EQ(csv_field("two\nlines"), "two lines");
  EXPECT_EQ(csv_number(0.1), "0.1");
  EXPECT_EQ(csv_number(-0.0), "0");
  EXPECT_EQ(csv_number(1.0 / 0.0), "");
}

}  // namespace
}  // namespace aspic::report

#include "io/series_csv.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "aspic/model.h"
#include "support/actuated.h"
#include "support/model_building.h"
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
  ASSERT_TRUE(series->add({one_particle(), state}).ok());
  ASSERT_TRUE(series->add({one_particle(), state}).ok());
  state.step = 3;
  state.position[0].y = -1.0;
  ASSERT_TRUE(series->add({one_particle(), state}).ok());
  ASSERT_TRUE(series->finish().ok());
  EXPECT_EQ(dir.read("e.csv"),
            "step,time,kinetic,elastic,gravitational,total,px,py,pz,max_speed,min_height\n"
            "0,0,1,0,60,61,2,0,0,1,3\n"
            "3,1.5,1,0,-20,-19,2,0,0,1,-1\n");
}

// A signal that inputs give stretches springs: the elastic energy is with their rest lengths.
TEST(SeriesCsv, EnergiesAreThoseOfTheInputs) {
  const test::TemporaryDirectory dir;
  const Model model = test::build(test::actuated(Integrator::symplectic_euler, ContactModel::coulomb));
  const State state = initial_state(model, Precision::double_);
  Inputs inputs;
  inputs.channels = {0.8};
  auto series = SeriesWriter::create(dir.file("e.csv"), Overwrite::refuse);
  ASSERT_TRUE(series.ok());
  ASSERT_TRUE(series->add({.model = model, .state = state, .inputs = &inputs}).ok());
  ASSERT_TRUE(series->finish().ok());
  const double with = measure(model, state, inputs).elastic, without = measure(model, state).elastic;
  EXPECT_GT(std::abs(with - without), 0.01 * with);
  EXPECT_THAT(dir.read("e.csv"), testing::HasSubstr(fmt::format(",{},", with)));
}

TEST(SeriesCsv, NotANumberIsNeverWritten) {
  const test::TemporaryDirectory dir;
  auto series = SeriesWriter::create(dir.file("e.csv"), Overwrite::refuse);
  ASSERT_TRUE(series.ok());
  State state;
  state.position = {{0.0, 3.0, 0.0}};
  state.velocity = {{std::numeric_limits<double>::infinity(), 0.0, 0.0}};
  const Status added = series->add({one_particle(), state});
  ASSERT_FALSE(added.ok());
  EXPECT_EQ(added.error().code, ErrorCode::diverged);
}

TEST(SeriesCsv, SolveColumnsHoldWhatCameSinceTheRowBefore) {
  const test::TemporaryDirectory dir;
  const Model model = one_particle();
  State state;
  state.position = {{0.0, 3.0, 0.0}};
  state.velocity = {{1.0, 0.0, 0.0}};
  auto series = SeriesWriter::create(dir.file("e.csv"), Overwrite::refuse, true);
  ASSERT_TRUE(series.ok());
  SolveStatistics solves;
  ASSERT_TRUE(series->add({model, state, solves}).ok());
  solves.add({3, 40, 0.5, SolveEnd::converged});
  solves.add({5, 60, 0.25, SolveEnd::stagnated});
  state.step = 2;
  ASSERT_TRUE(series->add({model, state, solves}).ok());
  solves.add({1, 7, 0.125, SolveEnd::not_converged});
  state.step = 3;
  ASSERT_TRUE(series->add({model, state, solves}).ok());
  ASSERT_TRUE(series->finish().ok());
  EXPECT_EQ(dir.read("e.csv"), std::string(series_csv_header) + std::string(series_csv_solve_header) +
                                   "\n0,0,1,0,60,61,2,0,0,1,3,0,0,0,0,0,0\n"
                                   "2,1,1,0,60,61,2,0,0,1,3,8,100,0.25,1,1,0\n"
                                   "3,1.5,1,0,60,61,2,0,0,1,3,1,7,0.125,0,0,1\n");
}

// In a model whose bodies can touch, the energy of their contact comes last; other columns keep their places.
TEST(SeriesCsv, EnergyOfContactFollowsInModelsWithBodyContact) {
  const test::TemporaryDirectory dir;
  auto series = SeriesWriter::create(dir.file("e.csv"), Overwrite::refuse, true);
  ASSERT_TRUE(series.ok());
  Measures m;
  m.elastic = 7.0;
  m.contact = 2.5;
  ASSERT_TRUE(series->add(0, 0.0, m).ok());
  ASSERT_TRUE(series->finish().ok());
  EXPECT_EQ(dir.read("e.csv"), std::string(series_csv_header) + std::string(series_csv_solve_header) +
                                   ",contact\n0,0,0,7,0,7,0,0,0,0,0,0,0,0,0,0,0,2.5\n");
}

// In a model with actuators their work comes last, from the first row on.
TEST(SeriesCsv, WorkOfActuatorsFollowsWhereThereAreAny) {
  const test::TemporaryDirectory dir;
  const Model model = test::build(test::actuated(Integrator::symplectic_euler, ContactModel::coulomb));
  State state = initial_state(model, Precision::double_);
  Inputs inputs;
  auto series = SeriesWriter::create(dir.file("e.csv"), Overwrite::refuse);
  ASSERT_TRUE(series.ok());
  EXPECT_EQ(series->work(), std::nullopt);
  ActuatorWork work;
  std::string last;
  for (const double channel : {0.0, 0.8, -0.3}) {
    inputs.channels = {channel};
    ASSERT_TRUE(series->add({.model = model, .state = state, .inputs = &inputs}).ok());
    EXPECT_EQ(series->work(), work.add(model, state, inputs));
    last = fmt::format(",{}", *series->work());
    state.step += 10;
  }
  ASSERT_TRUE(series->finish().ok());
  const std::string text = dir.read("e.csv");
  EXPECT_THAT(text, testing::StartsWith(std::string(series_csv_header) + ",contact,actuator_work\n0,"));
  EXPECT_THAT(text, testing::EndsWith(last + "\n"));
  EXPECT_NE(last, ",0");
}

TEST(SeriesCsv, HasItsHeaderWithoutARowToo) {
  const test::TemporaryDirectory dir;
  auto series = SeriesWriter::create(dir.file("e.csv"), Overwrite::refuse);
  ASSERT_TRUE(series.ok() && series->finish().ok());
  EXPECT_EQ(dir.read("e.csv"), std::string(series_csv_header) + "\n");
}

}  // namespace
}  // namespace aspic

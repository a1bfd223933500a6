#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "aspic/analysis.h"
#include "aspic/model.h"
#include "aspic/sweep.h"
#include "run/backends.h"

namespace aspic {
namespace {

using testing::HasSubstr;

Scene swept_scene() {
  const std::vector<std::string> keys = {"cube[0].particles-per-edge=3"};
  return load_scene("cube-plane", keys).value();
}

SweepRun run_of(const Scene& scene, const std::vector<Difference>& differences, const char* backend = "cpu",
                const RunLength& length = {10, {}}) {
  return sweep_run(scene, parse_backend(backend).value(), length, differences);
}

TEST(SweepRun, IsTheSceneWithItsDifferences) {
  const SweepRun run =
      run_of(swept_scene(), {{"k", "500"}, {"backend", "reference:double"}, {"n", "4"}}, "cpu", {{}, 0.05});
  ASSERT_FALSE(run.error);
  EXPECT_EQ(run.scene.model.cubes[0].structural.stiffness, 500.0);
  EXPECT_EQ(run.backend_words, "reference:double");
  EXPECT_EQ(run.backend.precision, Precision::double_);
  EXPECT_EQ(run.steps, 50u);
  EXPECT_EQ(run.particles, 64u);
  ASSERT_EQ(run.values.size(), 3u);
  EXPECT_EQ(run.values[0].second, ParameterValue(500.0));
  EXPECT_EQ(run.values[1].second, ParameterValue(std::string("reference:double")));
  EXPECT_EQ(run.values[2].second, ParameterValue(std::int64_t{4}));
}

TEST(SweepRun, OneMotionHasOneKey) {
  const Scene scene = swept_scene();
  Scene looks = scene;
  looks.name = "another";
  looks.author = "somebody";
  looks.view.color = ViewColor::strain;
  looks.model.simulation.duration = 77.0;
  const std::string key = run_of(scene, {{"cube[0].velocity", "[1,0,0]"}, {"h", "0.001"}}).key;
  EXPECT_EQ(key.size(), 32u);
  EXPECT_EQ(run_of(looks, {{"h", "1e-3"}, {"cube[0].velocity", "[ 1.0, 0, 0.0 ]"}}).key, key);
  EXPECT_EQ(run_of(looks, {{"h", "1e-3"}, {"cube[0].velocity", "[1,0,0]"}}, "cpu", {{}, 0.01}).key, key);
}

TEST(SweepRun, WhatMakesAnotherRunMakesAnotherKey) {
  const Scene scene = swept_scene();
  Scene heavier = scene;
  heavier.model.simulation.gravity.y = -20.0;
  std::set<std::string> keys;
  std::size_t runs = 0;
  const auto add = [&](const SweepRun& run) {
    keys.insert(run.key);
    EXPECT_EQ(keys.size(), ++runs) << run.backend_words << " " << run.steps;
  };
  add(run_of(scene, {{"h", "0.001"}}));
  add(run_of(scene, {{"h", "0.0010000000000000002"}}));
  add(run_of(scene, {{"simulation.timestep", "0.001"}}));  // another column
  add(run_of(scene, {}));
  add(run_of(heavier, {{"h", "0.001"}}));
  add(run_of(scene, {{"h", "0.001"}}, "cpu", {11, {}}));
  for (const char* backend : {"auto", "gpu", "gpu:gather", "gpu:fast", "reference", "reference:double"})
    add(run_of(scene, {{"h", "0.001"}}, backend));
  add(run_of(scene, {{"h", "-1"}}));
  add(run_of(scene, {{"h", "-2"}}));
}

TEST(SweepRun, ARejectedOneSaysWhyAndKeepsItsValues) {
  const SweepRun run = run_of(swept_scene(), {{"k", "500"}, {"n", "1"}});
  ASSERT_TRUE(run.error);
  EXPECT_THAT(run.error->what, HasSubstr("particles-per-edge"));
  EXPECT_EQ(run.values[0].second, ParameterValue(500.0));
  EXPECT_EQ(run.key, run_of(swept_scene(), {{"n", "1"}, {"k", "500"}}).key);
  EXPECT_TRUE(run_of(swept_scene(), {{"backend", "cpus"}}).error);
  EXPECT_TRUE(run_of(swept_scene(), {}, "cpu", {{}, 1e300}).error);
}

TEST(RunFigures, AreThoseOfItsStates) {
  const SharedModel model = make_model(swept_scene().model).value();
  auto backend = make_backend(parse_backend("reference").value(), model).value();
  RunFigures figures(model);
  EXPECT_EQ(RunFigures::interval(0.001), 17u);
  EXPECT_EQ(RunFigures::interval(1.0), 1u);
  figures.take(backend.solver->state().value());
  ASSERT_TRUE(backend.solver->advance(17).ok());
  const State last = backend.solver->state().value();
  figures.take(last);
  const Measures measures = measure(*model, last);
  std::vector<std::string> names;
  std::map<std::string, std::optional<double>> values;
  for (const RunFigure& figure : figures.figures()) {
    names.emplace_back(figure.name);
    values[names.back()] = figure.value;
  }
  EXPECT_EQ(values["kinetic"], measures.kinetic);
  EXPECT_EQ(values["total"], measures.total());
  EXPECT_EQ(values["time"], 0.017);
  EXPECT_FALSE(values["rest_time"]);
  EXPECT_THAT(names, testing::ElementsAre("time", "height", "lowest", "kinetic", "elastic", "gravitational",
                                          "total", "max_speed", "contact_time", "squash", "squash_time",
                                          "rest_time", "slide"));
}

}  // namespace
}  // namespace aspic

// Runs that are compared, and their names.

#include "variants/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "aspic/scene.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Scene small_scene() {
  const std::vector<std::string> small = {"cube[0].particles-per-edge=3"};
  return load_scene("cube-plane", small).value();
}

TEST(Comparison, ParsesKeyAndValue) {
  const auto variation = parse_difference("cube[0].name-of=a=b");
  ASSERT_TRUE(variation.ok());
  EXPECT_EQ(variation->key, "cube[0].name-of");
  EXPECT_EQ(variation->value, "a=b");
  for (const char* text : {"", "k", "=5", "k="}) {
    const auto bad = parse_difference(text);
    ASSERT_FALSE(bad.ok()) << text;
    EXPECT_EQ(bad.error().code, ErrorCode::usage);
    EXPECT_THAT(bad.error().message(), HasSubstr("KEY=VALUE"));
  }
}

TEST(Comparison, GivesEachRunOneDifference) {
  const Scene scene = small_scene();
  const auto runs =
      variants_of(scene, {}, {{"integrator", "implicit-euler"}, {"h", "0.002"}, {"backend", "cpu"}});
  ASSERT_TRUE(runs.ok()) << runs.error().message();
  ASSERT_EQ(runs->size(), 4u);
  const auto simulation = [&](std::size_t i) { return (*runs)[i].scene.model.simulation; };
  EXPECT_EQ(simulation(0).integrator, scene.model.simulation.integrator);
  EXPECT_EQ(simulation(1).integrator, Integrator::implicit_euler);
  EXPECT_EQ(simulation(1).timestep, scene.model.simulation.timestep);
  EXPECT_EQ(simulation(2).integrator, scene.model.simulation.integrator);
  EXPECT_EQ(simulation(2).timestep, 0.002);
  EXPECT_EQ((*runs)[0].backend.row, nullptr);
  ASSERT_NE((*runs)[3].backend.row, nullptr);
  EXPECT_EQ((*runs)[3].backend.row->name, "cpu");
}

TEST(Comparison, NamesTheWrongDifferenceAndTheReason) {
  const auto message = [](const std::vector<Difference>& differences) {
    const auto runs = variants_of(small_scene(), {}, differences);
    EXPECT_FALSE(runs.ok());
    return runs.ok() ? std::string() : runs.error().message();
  };
  EXPECT_THAT(message({{"simulation.integratr", "x"}}),
              testing::AllOf(HasSubstr("the variant simulation.integratr=x"),
                             HasSubstr("did you mean 'integrator'")));
  EXPECT_THAT(message({{"h", "-1"}}), HasSubstr("the variant h=-1"));
  EXPECT_THAT(message({{"backend", "xpu"}}), HasSubstr("auto, gpu, cpu, reference"));
  EXPECT_THAT(message({{"k", "stiff"}}), HasSubstr("the variant k=stiff"));
  EXPECT_THAT(message({{"h", "0.1"}, {"h", "0.2"}, {"h", "0.3"}, {"h", "0.4"}}), HasSubstr("at most 3"));
}

TEST(Comparison, LabelsEachKeyOnce) {
  const std::vector<Difference> differences = {{"integrator", "implicit-euler"},
                                               {"h", "0.002"},
                                               {"h", "0.004"},
                                               {"backend", "cpu"},
                                               {"cube[0].shear.stiffness", "10"}};
  const auto label = label_of(differences, small_scene(), "reference");
  std::vector<std::string> keys, values;
  for (const OverlayLine& line : label) {
    keys.push_back(line.label);
    values.push_back(line.value);
  }
  EXPECT_THAT(keys, ElementsAre("integrator", "time step h", "backend", "cube[0].shear.stiffness"));
  EXPECT_THAT(values, ElementsAre("explicit Euler", "0.001 s", "reference", testing::EndsWith(" N/m")));
}

TEST(Comparison, NamesRunsByTheirDifferences) {
  const std::vector<Difference> differences = {
      {"integrator", "implicit-euler"}, {"h", "0.002"}, {"h", "0.004"}, {"cube[0].shear.stiffness", "10"}};
  const Scene scene = small_scene();
  EXPECT_EQ(short_name(0, {differences[0]}, scene, "cpu"), "explicit Euler");
  EXPECT_EQ(short_name(0, {differences[0], differences[1], differences[2]}, scene, "cpu"),
            "explicit Euler, h 0.001 s");
  const auto runs = variants_of(scene, {}, {differences[0], differences[1], differences[3]});
  ASSERT_TRUE(runs.ok());
  const auto name = [&](std::size_t run) {
    return short_name(run, {differences[0], differences[1], differences[3]}, (*runs)[run].scene, "cpu");
  };
  EXPECT_EQ(name(1), "implicit Euler");
  EXPECT_EQ(name(2), "h 0.002 s");
  EXPECT_EQ(name(3), "shear stiffness 10 N/m");
}

TEST(Comparison, NumbersFilesBeforeTheirEnding) {
  EXPECT_EQ(numbered_path("energy.csv", 2), "energy-2.csv");
  EXPECT_EQ(numbered_path("out.d/states", 1), "out.d/states-1");
}

}  // namespace
}  // namespace aspic

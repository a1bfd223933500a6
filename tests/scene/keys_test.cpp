// The keys of scenes as programs meet them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "aspic/model.h"
#include "aspic/parameters.h"

namespace aspic {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

Scene scene(const std::string& name) {
  return load_scene(name).value();
}

template <class T>
T value(const Scene& s, const std::string& key) {
  return std::get<T>(value_of(s, key).value().value());
}

TEST(Keys, ValuesHaveTheirTypes) {
  Scene s = scene("cube-plane");
  EXPECT_EQ(value<double>(s, "simulation.timestep"), 0.001);
  EXPECT_EQ(value<std::string>(s, "simulation.integrator"), "explicit-euler");
  EXPECT_EQ(value<Vec3>(s, "simulation.gravity"), (Vec3{0.0, -9.8, 0.0}));
  EXPECT_EQ(value<std::int64_t>(s, "cube[0].particles-per-edge"), 10);
  EXPECT_EQ(value<bool>(s, "contact.spin"), true);
  s.model.cubes[0].pinned.names = {"top"};
  EXPECT_EQ(value<PinnedSettings>(s, "cube[0].pinned").names, std::vector<std::string>{"top"});
}

TEST(Keys, WhatIsAbsentOrHasNoMeaningHasNoValue) {
  const Scene s = scene("cube-plane");
  EXPECT_FALSE(value_of(s, "view.follow").value());
  EXPECT_FALSE(value_of(s, "cube[0].material.density").value());
  EXPECT_THAT(list_keys(s), Not(Contains("cube[0].material.density")));
}

TEST(Keys, EveryListedKeyCanBeRead) {
  for (const BuiltinScene& builtin : list_builtin_scenes()) {
    const Scene s = scene(std::string(builtin.name));
    for (const std::string& key : list_keys(s)) EXPECT_TRUE(value_of(s, key)) << builtin.name << " " << key;
  }
}

TEST(Keys, AnUnknownOneNamesTheNearest) {
  const Scene s = scene("cube-plane");
  const auto refused = value_of(s, "simulation.timestp");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::scene_rejected);
  EXPECT_THAT(refused.error().message(), HasSubstr("did you mean 'timestep'?"));
}

TEST(Keys, PlacesThatAreNoneAreRefused) {
  const Scene s = scene("cube-plane");
  for (const char* key : {"", "simulation", "cube", "cube[0]", "cube[1].edge-length", "cube[].edge-length",
                          "cube[00].edge-length", "cube[0x].edge-length", "cube[-1].edge-length",
                          "cube.edge-length", "simulation.timestep=0.1", "name"}) {
    const auto found = value_of(s, key);
    EXPECT_EQ(found.ok(), std::string_view(key) == "name") << key;
  }
}

TEST(Keys, TheTableSaysWhatTheReferenceSays) {
  const std::vector<ParameterInfo> all = list_parameters();
  const auto row = std::ranges::find(all, "simulation.timestep", &ParameterInfo::path);
  ASSERT_NE(row, all.end());
  EXPECT_EQ(row->unit, "s");
  EXPECT_EQ(row->by_default, "0.001");
  EXPECT_THAT(row->allowed, HasSubstr("> 0"));
  EXPECT_TRUE(row->live);
}

TEST(Keys, BodiesAreNamedInTheModelsOrder) {
  const Scene s = scene("goal-net");
  const auto names = body_names(s.model);
  EXPECT_THAT(particle_ranges(**make_model(s.model)), SizeIs(names.size()));
  EXPECT_THAT(body_names(scene("cube-plane").model), ElementsAre("cube[0]"));
}

}  // namespace
}  // namespace aspic

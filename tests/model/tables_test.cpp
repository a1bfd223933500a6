// The tables of terrain shapes and of bodies: every row does what it says.
#include <gtest/gtest.h>

#include <set>

#include "model/bodies.h"
#include "model/terrain.h"

namespace aspic {
namespace {

TEST(TerrainShapes, HaveDistinctNamesAndAreFoundByThem) {
  std::set<std::string_view> names;
  for (const TerrainShapeRow& row : terrain_shapes) {
    EXPECT_EQ(&terrain_row(row.value), &row);
    EXPECT_EQ(row.defaults.shape, row.value);
    EXPECT_EQ(name_of(row.value), row.name);
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
  }
}

TEST(TerrainShapes, TakeOwnGeometryAndDefaultsForTheRest) {
  for (const TerrainShapeRow& row : terrain_shapes) {
    TerrainSettings settings;
    settings.shape = row.value;
    const Terrain by_default = make_terrain(settings, {});
    const Vec3& place = row.defaults.point ? *row.defaults.point : *row.defaults.centre;
    EXPECT_EQ(by_default.point, place) << row.name;
    EXPECT_NEAR(length(by_default.normal), 1.0, 4e-16) << row.name;
    EXPECT_EQ(by_default.radius, row.defaults.radius.value_or(0.0)) << row.name;
    (row.defaults.point ? settings.point : settings.centre) = Vec3{1.0, 2.0, 3.0};
    EXPECT_EQ(make_terrain(settings, {}).point, (Vec3{1.0, 2.0, 3.0})) << row.name;
    EXPECT_EQ(make_terrain(settings, {}).radius, by_default.radius) << row.name;
  }
}

TEST(Bodies, PredictWhatTheyMake) {
  for (const BodyRow& row : body_rows()) {
    ModelSettings settings;
    row.list.append(settings);
    row.list.append(settings);
    ASSERT_EQ(row.list.size(settings), 2u) << row.list.key;
    ModelCounts predicted = row.counts(settings, 0);
    predicted += row.counts(settings, 1);
    const auto model = build_model(settings);
    ASSERT_TRUE(model.ok()) << model.error().message;
    const ModelCounts made = count(*model);
    EXPECT_GT(made.particles + made.balls, 0u) << row.list.key;
    EXPECT_EQ(predicted.particles, made.particles) << row.list.key;
    EXPECT_EQ(predicted.pinned, made.pinned) << row.list.key;
    EXPECT_EQ(predicted.structural, made.structural) << row.list.key;
    EXPECT_EQ(predicted.shear, made.shear) << row.list.key;
    EXPECT_EQ(predicted.bending, made.bending) << row.list.key;
    EXPECT_EQ(predicted.balls, made.balls) << row.list.key;
  }
}

TEST(SettingsLists, AreTerrainAndTheBodies) {
  std::set<std::string_view> keys;
  for (const SettingsList& list : settings_lists()) keys.insert(list.key);
  EXPECT_EQ(keys.size(), body_rows().size() + 1);
  EXPECT_TRUE(keys.contains("terrain"));
  for (const BodyRow& row : body_rows()) EXPECT_TRUE(keys.contains(row.list.key)) << row.list.key;
}

}  // namespace
}  // namespace aspic

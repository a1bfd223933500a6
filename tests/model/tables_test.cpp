// The tables of terrain shapes and of bodies: every row does what it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>

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

TEST(Bodies, HaveSurfacesOfTheirOwnParticlesAndClassesOfTheirOwnSprings) {
  for (const BodyRow& row : body_rows()) {
    ModelSettings settings;
    settings.cubes.resize(1);
    row.list.append(settings);
    const auto model = build_model(settings);
    ASSERT_TRUE(model.ok()) << model.error().message;
    std::uint32_t next_particle = 0, next_class = 0;
    for (const Body& body : model->bodies) {
      EXPECT_EQ(body.first_particle, next_particle) << row.list.key;
      EXPECT_EQ(body.first_class, next_class) << row.list.key;
      next_particle += body.particle_count;
      next_class += body.class_count;
      EXPECT_EQ(body.surface.empty(), body.style == SurfaceStyle::cords) << row.list.key;
      for (const Patch& patch : body.surface) {
        const std::uint32_t last =
            patch.first + (patch.count[0] - 1) * patch.stride[0] + (patch.count[1] - 1) * patch.stride[1];
        EXPECT_GE(patch.first, body.first_particle) << row.list.key;
        EXPECT_LT(last, next_particle) << row.list.key;
        EXPECT_GE(std::min(patch.count[0], patch.count[1]), 2u) << row.list.key;
      }
      for (const Rod& rod : body.rods) EXPECT_GT(length(rod.to - rod.from), rod.radius) << row.list.key;
    }
    EXPECT_EQ(next_particle, model->particle_count()) << row.list.key;
    EXPECT_EQ(next_class, model->spring_classes.size()) << row.list.key;
    for (const Spring& s : model->springs) {
      const auto owner = std::ranges::find_if(model->bodies, [&](const Body& b) {
        return s.a >= b.first_particle && s.a < b.first_particle + b.particle_count;
      });
      EXPECT_LT(s.b, owner->first_particle + owner->particle_count) << row.list.key;
      EXPECT_GE(s.spring_class, owner->first_class) << row.list.key;
      EXPECT_LT(s.spring_class, owner->first_class + owner->class_count) << row.list.key;
    }
  }
}

TEST(Bodies, PinTheSidesAndCornersTheyName) {
  for (const BodyRow& row : body_rows()) {
    if (!row.pins) continue;
    std::array<int, 3> lattice = {1, 1, 1};
    for (const Side& side : row.pins->sides) lattice[side.axis] = 4;
    for (const Side& side : row.pins->sides) {
      PinnedSettings pinned;
      pinned.names = {std::string(side.name)};
      const auto held = pinned_particles(*row.pins, pinned, lattice);
      ASSERT_TRUE(held.ok()) << held.error().message;
      for (int i = 0; i < lattice[0]; ++i) {
        for (int j = 0; j < lattice[1]; ++j) {
          for (int k = 0; k < lattice[2]; ++k) {
            const int at = std::array{i, j, k}[side.axis];
            EXPECT_EQ((*held)[static_cast<std::size_t>((i * lattice[1] + j) * lattice[2] + k)],
                      at == (side.high ? 3 : 0))
                << row.list.key << " " << side.name;
          }
        }
      }
    }
    PinnedSettings wrong;
    wrong.names = {"middle"};
    const auto refused = pinned_particles(*row.pins, wrong, lattice);
    ASSERT_FALSE(refused.ok());
    EXPECT_TRUE(refused.error().message.starts_with("pinned: \"middle\" is neither a"))
        << refused.error().message;
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

// The tables of terrain shapes and of bodies: every row does what it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "model/bodies.h"
#include "model/springs.h"
#include "model/terrain.h"

namespace aspic {
namespace {

TEST(TerrainShapes, HaveDistinctNamesAndAreFoundByThem) {
  std::set<std::string_view> names;
  for (const TerrainShapeRow& row : terrain_shapes) {
    EXPECT_EQ(&terrain_row(row.value), &row);
    EXPECT_EQ(name_of(row.value), row.name);
    EXPECT_EQ(row.keys.front().kind, GeometryKind::place) << row.name;
    EXPECT_TRUE(names.insert(row.name).second) << row.name;
  }
}

TEST(TerrainShapes, TakeOwnGeometryAndDefaultsForTheRest) {
  for (const TerrainShapeRow& row : terrain_shapes) {
    const Terrain by_default = make_terrain({.shape = row.value}, {});
    std::size_t vectors = 0, numbers = 0;
    for (const GeometryKey& key : row.keys) {
      TerrainSettings settings = {.shape = row.value, .geometry = {{std::string(key.name), 5.0}}};
      if (key.kind != GeometryKind::length) settings.geometry = {{std::string(key.name), Vec3{0, 5, 0}}};
      Geometry<double> expected = by_default.geometry;
      if (key.kind == GeometryKind::length) {
        EXPECT_EQ(expected.numbers[numbers], std::get<double>(key.value)) << row.name;
        expected.numbers[numbers++] = 5.0;
      } else if (key.kind == GeometryKind::place) {
        EXPECT_EQ(expected.vectors[vectors], std::get<Vec3>(key.value)) << row.name;
        expected.vectors[vectors++] = {0, 5, 0};
      } else {
        EXPECT_NEAR(length(expected.vectors[vectors]), 1.0, 4e-16) << row.name;
        expected.vectors[vectors++] = {0, 1, 0};
      }
      const Terrain own = make_terrain(settings, {});
      EXPECT_EQ(own.geometry.vectors, expected.vectors) << row.name << " " << key.name;
      EXPECT_EQ(own.geometry.numbers, expected.numbers) << row.name << " " << key.name;
    }
  }
}

TEST(TerrainShapes, ShareKeysOfOneKind) {
  for (const TerrainShapeRow& row : terrain_shapes) {
    for (const TerrainShapeRow& other : terrain_shapes) {
      for (const GeometryKey& key : row.keys) {
        const GeometryKey* same = geometry_key(other.value, key.name);
        if (same) {
          EXPECT_EQ(same->kind, key.kind) << key.name << " of " << row.name << " and " << other.name;
        }
      }
    }
  }
}

/// Points around a shape by default, on both sides of its surface.
std::vector<Vec3> points_near(const TerrainShapeRow& row) {
  const Terrain terrain = make_terrain({.shape = row.value}, {});
  std::vector<Vec3> points = {row.drop};
  for (int i = 0; i < 200; ++i) {
    const Vec3 off = {5.0 * std::sin(1.0 * i), 5.0 * std::sin(2.3 * i + 1.0), 5.0 * std::sin(3.1 * i + 2.0)};
    points.push_back(terrain.geometry.vectors[0] + off);
  }
  return points;
}

// The gradient of d, by differences over 1e-5 m: their error is the curvature times that and rounding over
// it. Points where the gradient jumps, nearer to an edge of the distance than the difference, are none here.
TEST(TerrainShapes, NormalIsTheGradientOfTheDistance) {
  constexpr double step = 1e-5;
  for (const TerrainShapeRow& row : terrain_shapes) {
    const Terrain terrain = make_terrain({.shape = row.value}, {});
    for (const Vec3& x : points_near(row)) {
      const auto [d, n] = terrain_gap(terrain, x);
      EXPECT_EQ(d, signed_distance(terrain, x)) << row.name;
      EXPECT_NEAR(length(n), 1.0, 8 * 2.3e-16) << row.name;
      Vec3 gradient;
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 to = x, from = x;
        to[axis] += step;
        from[axis] -= step;
        gradient[axis] = (signed_distance(terrain, to) - signed_distance(terrain, from)) / (2.0 * step);
      }
      EXPECT_LT(length(gradient - n), 1e-8) << row.name << " at " << x.x << " " << x.y << " " << x.z;
    }
  }
}

// In single precision the same formula, within the rounding of numbers of that size.
TEST(TerrainShapes, FormulasOfBothPrecisionsAgree) {
  for (const TerrainShapeRow& row : terrain_shapes) {
    const Terrain terrain = make_terrain({.shape = row.value}, {});
    Geometry<float> rounded;
    const auto narrow = [](const Vec3& v) {
      return Vec<float>{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    };
    for (std::size_t k = 0; k < geometry_size; ++k) {
      rounded.vectors[k] = narrow(terrain.geometry.vectors[k]);
      rounded.numbers[k] = static_cast<float>(terrain.geometry.numbers[k]);
    }
    for (const Vec3& x : points_near(row)) {
      const auto [d, n] = row.in_single.gap(rounded, narrow(x));
      EXPECT_EQ(d, row.in_single.distance(rounded, narrow(x))) << row.name;
      EXPECT_NEAR(static_cast<double>(d), signed_distance(terrain, x), 16 * 1.2e-7 * extent(terrain))
          << row.name;
    }
  }
}

// The surface that is drawn, and where the normals lead from above it.
TEST(TerrainShapes, SurfacesLieAtDistanceZero) {
  for (const TerrainShapeRow& row : terrain_shapes) {
    ASSERT_TRUE(row.flat || row.surface) << row.name;
    const Terrain terrain = make_terrain({.shape = row.value}, {});
    const double rounding = 16 * 2.3e-16 * extent(terrain);
    if (row.flat) {
      const FlatPart flat = row.flat(terrain.geometry);
      EXPECT_NEAR(dot(flat.normal, terrain_gap(terrain, flat.point + 50.0 * Vec3{1, 1, 1}).n), 1.0, 1e-15);
    }
    for (int u = 0; row.surface && u <= 16; ++u) {
      for (int v = 0; v <= 16; ++v) {
        EXPECT_NEAR(signed_distance(terrain, row.surface(terrain.geometry, u / 16.0, v / 16.0)), 0.0,
                    rounding)
            << row.name << " at " << u << "/16, " << v << "/16";
      }
    }
    const double drop = signed_distance(terrain, row.drop);
    EXPECT_GT(drop, 0.0) << row.name;
    // d is the distance or less, so the way along the normals ends on the surface and not beyond.
    Vec3 x = row.drop;
    for (int step = 0; step < 100; ++step) {
      const auto [d, n] = terrain_gap(terrain, x);
      EXPECT_GE(d, -rounding) << row.name;
      x = x - d * n;
    }
    EXPECT_NEAR(signed_distance(terrain, x), 0.0, rounding) << row.name;
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
    ASSERT_TRUE(model.ok()) << model.error().message();
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
    ASSERT_TRUE(model.ok()) << model.error().message();
    std::uint32_t next_particle = 0, next_class = 0;
    for (const Body& body : model->bodies) {
      EXPECT_EQ(body.first_particle, next_particle) << row.list.key;
      EXPECT_EQ(body.first_class, next_class) << row.list.key;
      next_particle += body.particle_count;
      next_class += body.class_count;
      const QuadMesh surface = surface_of(body);
      EXPECT_EQ(surface.quads.empty(), body.style == SurfaceStyle::cords) << row.list.key;
      for (const Quad& quad : surface.quads) {
        EXPECT_GE(std::ranges::min(quad), body.first_particle) << row.list.key;
        EXPECT_LT(std::ranges::max(quad), next_particle) << row.list.key;
      }
      std::size_t in_groups = 0;
      for (const NormalGroup& group : surface.groups) in_groups += group.quads;
      EXPECT_EQ(in_groups, surface.quads.size()) << row.list.key;
      for (const Rod& rod : body.rods) EXPECT_GT(length(rod.to - rod.from), rod.radius) << row.list.key;
    }
    EXPECT_EQ(next_particle, model->particle_count()) << row.list.key;
    EXPECT_EQ(next_class, model->spring_classes.size()) << row.list.key;
    for (const Spring& s : springs_of(*model)) {
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
      ASSERT_TRUE(held.ok()) << held.error().message();
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
    EXPECT_TRUE(refused.error().message().starts_with("pinned: \"middle\" is neither a"))
        << refused.error().message();
  }
}

TEST(SettingsLists, AreTerrainMaterialsActuatorsAndTheBodies) {
  std::set<std::string_view> keys;
  for (const SettingsList& list : settings_lists()) keys.insert(list.key);
  EXPECT_EQ(keys.size(), body_rows().size() + 3);
  EXPECT_TRUE(keys.contains("terrain"));
  EXPECT_TRUE(keys.contains("material"));
  EXPECT_TRUE(keys.contains("actuator"));
  for (const BodyRow& row : body_rows()) EXPECT_TRUE(keys.contains(row.list.key)) << row.list.key;
}

}  // namespace
}  // namespace aspic

#include "model/material.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "model/counts.h"
#include "model/springs.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using testing::HasSubstr;

ModelSettings with_materials() {
  ModelSettings settings;
  settings.materials = {{1000.0, 1e5, 0.1, "muscle"}, {1200.0, 2e6, 0.05, "canvas"}};
  return settings;
}

double total_mass(const Model& model) {
  return std::accumulate(model.mass.begin(), model.mass.end(), 0.0);
}

TEST(Material, NameMeansTheSameAsItsNumbers) {
  ModelSettings named = with_materials(), spelt = with_materials();
  named.cubes.resize(1);
  named.cubes[0].material.emplace().name = "muscle";
  spelt.cubes.resize(1);
  spelt.cubes[0].material = {1000.0, 1e5, 0.1};
  const Model a = test::build(named), b = test::build(spelt);
  EXPECT_EQ(a.mass, b.mass);
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_EQ(a.spring_classes[c].stiffness, b.spring_classes[c].stiffness);
    EXPECT_EQ(a.spring_classes[c].damping, b.spring_classes[c].damping);
  }
}

TEST(Material, UnknownNameIsRefusedByEveryBody) {
  for (const char* const list : {"cube", "cloth", "goal-net"}) {
    ModelSettings settings = with_materials();
    MaterialSettings wood;
    wood.name = "wood";
    if (list == std::string_view("cube")) settings.cubes.emplace_back().material = wood;
    if (list == std::string_view("cloth")) settings.cloths.emplace_back().material = wood;
    if (list == std::string_view("goal-net")) settings.goal_nets.emplace_back().material = wood;
    const auto refused = build_model(settings);
    ASSERT_FALSE(refused.ok()) << list;
    EXPECT_THAT(refused.error().what,
                HasSubstr("\"wood\", which the scene does not have; it has muscle, canvas"));
  }
}

/// Energy of a sheet per area [J/m²] under a small uniform strain, by its springs.
double energy(const Model& model, double xx, double yy, double xy, double area) {
  double sum = 0.0;
  for (const Spring& s : springs_of(model)) {
    const SpringClass& kind = model.spring_classes[s.spring_class];
    const Vec3 d = model.initial_position[s.b] - model.initial_position[s.a];
    const double stretch = (xx * d.x * d.x + yy * d.y * d.y + xy * d.x * d.y) / kind.rest_length;
    sum += 0.5 * kind.stiffness * stretch * stretch;
  }
  return sum / area;
}

// Of a large sheet, whose edges count little: that of an isotropic membrane in plane stress with ν = 1/3.
// Edges have fewer springs two steps long and shear springs, and more structural ones, than their share: the
// error is of order 1/n.
TEST(Material, SheetIsAnIsotropicMembraneWhateverItsCells) {
  for (const double height : {2.0, 1.3, 2.9}) {
    ModelSettings settings = with_materials();
    ClothSettings& cloth = settings.cloths.emplace_back();
    cloth.particles = {201, 201};
    cloth.size = {2.0, height};
    cloth.thickness = 0.002;
    cloth.material.emplace().name = "canvas";
    const Model model = test::build(settings);
    const double area = 2.0 * height, e = 2e6 * 0.002, nu = 1.0 / 3.0, strain = 1e-4, tolerance = 0.02;
    const double c11 = e / (1.0 - nu * nu), c12 = nu * c11, c66 = e / (2.0 * (1.0 + nu));
    const double squared = 0.5 * strain * strain;
    EXPECT_NEAR(energy(model, strain, 0, 0, area), squared * c11, tolerance * squared * c11) << height;
    EXPECT_NEAR(energy(model, 0, strain, 0, area), squared * c11, tolerance * squared * c11) << height;
    EXPECT_NEAR(energy(model, strain, strain, 0, area), squared * 2 * (c11 + c12),
                tolerance * squared * 3 * c11);
    EXPECT_NEAR(energy(model, 0, 0, strain, area), squared * c66, tolerance * squared * c66) << height;
    EXPECT_NEAR(total_mass(model), 1200.0 * 0.002 * area, 1e-9);
  }
}

TEST(Material, SheetOfLongCellsIsRefused) {
  ModelSettings settings = with_materials();
  ClothSettings& cloth = settings.cloths.emplace_back();
  cloth.particles = {11, 11};
  cloth.size = {2.0, 1.0};
  cloth.material.emplace();
  const auto refused = build_model(settings);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().what, HasSubstr("cells of 0.2 m × 0.1 m are too long one way"));
}

TEST(Material, CordsOfANetAreBarsOfTheirLength) {
  ModelSettings settings = with_materials();
  GoalNetSettings& net = settings.goal_nets.emplace_back();
  net.particles = {4, 5, 7};
  net.size = {0.6, 1.0, 1.8};
  net.cord_diameter = 0.004;
  net.shear.stiffness = 10.0;  // decided by the material
  net.material.emplace().name = "canvas";
  const Model model = test::build(settings);
  const double area = std::numbers::pi / 4.0 * 0.004 * 0.004;
  double cords = 0.0;
  for (const Spring& s : springs_of(model)) {
    const SpringClass& kind = model.spring_classes[s.spring_class];
    EXPECT_EQ(kind.type, SpringType::structural);
    EXPECT_NEAR(kind.stiffness, 2e6 * area / kind.rest_length, 1e-9 * kind.stiffness);
    EXPECT_NEAR(kind.damping, 2.0 * 0.05 * std::sqrt(kind.stiffness * model.mass[0] / 2.0), 1e-12);
    cords += kind.rest_length;
  }
  EXPECT_NEAR(total_mass(model), 1200.0 * area * cords, 1e-12 * total_mass(model));
  EXPECT_EQ(predict_counts(settings).springs(), spring_count(model));
}

}  // namespace
}  // namespace aspic

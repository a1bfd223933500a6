// The rules that keep rounding from deciding about contact, in both precisions.
#include "support/contact_rules.h"

#include <gtest/gtest.h>

#include <random>

#include "cpu_reference/ground.h"
#include "cpu_reference/reference_solver.h"
#include "physics/terrain/implicit.h"
#include "support/epsilon.h"

namespace aspic {
namespace {

constexpr Precision both[] = {Precision::single, Precision::double_};

TEST(ContactRules, WithoutRestitutionALandingComesToRest) {
  for (const Precision precision : both) {
    test::expect_landing_to_rest(
        [&](const Model& model) { return std::move(make_reference_solver(model, precision)).value(); });
  }
}

TEST(ContactRules, OfPlanesInOneTheOneWithMoreFrictionHolds) {
  for (const Precision precision : both) {
    test::expect_more_friction_to_hold(
        [&](const Model& model) { return std::move(make_reference_solver(model, precision)).value(); });
  }
}

// The limit of a bounce that gives nothing back and v_rest are apart by a factor of two or more, at any time
// step.
TEST(ContactRules, NoBounceEndsAtTheRestingSpeed) {
  using namespace reference;
  Model model;
  for (const double h : {1e-5, 1e-4, 1e-3, 1.0 / 60.0}) {
    model.simulation.timestep = h;
    const ContactConstants<double> contact(model);
    const double u = bounced_speed<double>(plane(0.0), contact, 1.0, 0.0, 1.0, -2.0, 50.0, -50.0);
    EXPECT_EQ(u, contact.fall);
    EXPECT_LE(u, contact.resting_speed / 2) << h;
    const double light =
        bounced_speed<double>(plane(0.5, 0.0, 10.0), contact, 1.0, 0.0, 1.0, -2.0, 50.0, -50.0);
    EXPECT_GT(light, contact.resting_speed) << h;
    EXPECT_EQ(bounced_speed<double>(plane(0.5, 0.0, 10.0), contact, 10.0, 0.0, 1.0, -2.0, 50.0, -50.0),
              contact.fall)
        << "heavier than the ground gives back";
  }
}

/// The plane through a point of the slope of this normal through the origin.
Terrain slope(const Vec3& normal, const Vec3& along, double shift, double friction) {
  TerrainSettings settings;
  settings.geometry["point"] = shift * along;
  settings.geometry["normal"] = (1.0 + std::abs(shift)) * normal;
  settings.friction = friction;
  return make_terrain(settings, ContactSettings{});
}

// P with several planes in one, in any order and with a wall among them, is P with the one of more friction
// alone; of planes with equal friction the first holds.
TEST(ContactRules, PlanesInOneReactAsTheOneWithMoreFriction) {
  using namespace reference;
  std::mt19937 random(21);
  std::normal_distribution<double> some;
  const auto vector = [&] { return Vec3{some(random), some(random), some(random)}; };
  Model model;
  const ContactConstants<float> contact(model);
  const auto react = [&](const std::vector<Terrain>& terrain, const Vec3& x, const Vec3& v) {
    const std::vector<Ground<float>> grounds(terrain.begin(), terrain.end());
    GroundAhead<float> ahead(grounds, contact, true);
    ahead.start(Field<float>(rounded<float>(x)));
    return ahead.react(0, 1.0f, rounded<float>(v));
  };
  int held = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Vec3 n = vector() + Vec3{0.0, 2.0, 0.0}, along = cross(n, vector());
    const Vec3 x = 1e-4 * n, v = vector() - n;
    const Terrain slick = slope(n, along, 0.3, 0.1), rough = slope(n, along, -0.2, 0.4),
                  middle = slope(n, along, 0.7, 0.2), wall = slope(along, n, 0.0, 0.3);
    const Vector<float> alone = react({rough}, x, v).v, cornered = react({rough, wall}, x, v).v;
    EXPECT_EQ(react({slick, rough, middle}, x, v).v, alone);
    EXPECT_EQ(react({middle, slick, rough}, x, v).v, alone);
    EXPECT_EQ(react({rough, middle, slick}, x, v).v, alone);
    EXPECT_EQ(react({slick, rough, wall}, x, v).v, cornered);
    const auto twice = react({slope(n, along, 0.5, 0.2), slope(n, along, -0.4, 0.2)}, x, v);
    EXPECT_FALSE(twice.holds(1));
    held += twice.holds(0);
  }
  EXPECT_GT(held, 1000);
}

// Not one surface: the upper of two parallel planes holds, whatever their friction, and opposite ones both
// do.
TEST(ContactRules, PlanesApartReactAsBefore) {
  using namespace reference;
  Model model;
  const ContactConstants<double> contact(model);
  const Vec3 up = {0.0, 1.0, 0.0};
  Terrain lower = slope(up, {}, 0.0, 0.9), upper = slope(up, {}, 0.0, 0.0);
  for (const double gap : {1e-4, 0.5}) {
    TerrainSettings raised;
    raised.geometry["point"] = Vec3{0.0, gap, 0.0};
    raised.geometry["normal"] = up;
    raised.friction = 0.0;
    upper = make_terrain(raised, ContactSettings{});
    for (const auto& terrain : {std::vector{lower, upper}, std::vector{upper, lower}}) {
      const std::vector<Ground<double>> grounds(terrain.begin(), terrain.end());
      GroundAhead<double> ahead(grounds, contact, true);
      ahead.start(Field<double>(Vector<double>(0, gap, 0)));
      EXPECT_EQ(ahead.react(0, 1.0, Vector<double>(1, -2.0 - gap / contact.step, 0)).v,
                Vector<double>(1, 0, 0));
    }
  }
}

}  // namespace
}  // namespace aspic

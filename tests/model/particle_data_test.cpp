#include "model/particle_data.h"

#include <gtest/gtest.h>

#include "model/counts.h"
#include "model/springs.h"
#include "support/model_building.h"

namespace aspic {
namespace {

TEST(Runs, AreTheValuesOneByOne) {
  // Runs of every length from 1 to 5, then changes at their ends and within.
  std::vector<double> expected;
  Runs<double> runs;
  for (int value = 0; value < 5; ++value) {
    for (int n = 0; n <= value; ++n) expected.push_back(value);
    runs.push_back(value, static_cast<std::size_t>(value) + 1);
  }
  const auto agree = [&] {
    EXPECT_EQ(runs.size(), expected.size());
    EXPECT_EQ(std::vector<double>(runs.begin(), runs.end()), expected);
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(runs[i], expected[i]) << i;
  };
  agree();
  EXPECT_EQ(runs.runs().size(), 5u);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    expected[i] = 7.0;
    runs.set(i, 7.0);
    agree();
  }
  EXPECT_EQ(runs.runs().size(), 1u);
  EXPECT_EQ(Runs<float>(runs)[3], 7.0f);
  runs.assign(3, 1.0);
  expected.assign(3, 1.0);
  agree();
}

TEST(Places, AreThoseOfLatticesAndOfListedParticlesInOrder) {
  const LatticePlaces small = {{2, 2, 2}, 1.0, {0.5, 0.5, 0.5}, {10.0, 0.0, 0.0}},
                      large = {{3, 4, 2}, 2.0, {2.0, 3.0, 1.0}, {0.0, 20.0, 0.0}};
  Places places;
  std::vector<Vec3> expected;
  const auto list = [&](const Vec3& x) {
    places.push_back(x);
    expected.push_back(x);
  };
  const auto append = [&](const LatticePlaces& lattice) {
    places.append(lattice);
    for (std::size_t i = 0; i < lattice.count(); ++i) expected.push_back(lattice[i]);
  };
  list({1.0, 2.0, 3.0});
  append(small);
  append(large);
  list({4.0, 5.0, 6.0});
  list({7.0, 8.0, 9.0});
  append(small);
  EXPECT_EQ(large[0], (Vec3{-2.0, 17.0, -1.0}));
  EXPECT_EQ(large[5], (Vec3{-2.0, 21.0, 1.0})) << "k counts fastest";
  ASSERT_EQ(places.size(), expected.size());
  EXPECT_EQ(places.list(0, places.size()), expected);
  EXPECT_EQ(std::vector<Vec3>(places.begin(), places.end()), expected);
  places.set(12, {0.0, 0.0, 0.0});
  expected[12] = {};
  EXPECT_EQ(places.list(0, places.size()), expected);
}

/// Two cubes with a cloth and a net around them.
Model mixed() {
  ModelSettings settings = test::cube_on_plane(5);
  settings.cubes.push_back(settings.cubes[0]);
  settings.cubes[1].particles_per_edge = 2;
  settings.cloths.emplace_back();
  settings.goal_nets.emplace_back().particles = {4, 3, 5};
  return test::build(settings);
}

TEST(Springs, WalkInTheSameOrderWhetherListedOrNot) {
  const Model model = mixed();
  ASSERT_GT(model.listed_springs.size(), 0u);
  const std::vector<Spring> all = all_springs(model);
  EXPECT_EQ(all.size(), spring_count(model));
  EXPECT_TRUE(std::ranges::is_sorted(all, {}, [](const Spring& s) { return std::pair(s.a, s.b); }));
  std::vector<std::uint64_t> by_class(model.spring_classes.size(), 0);
  for (const Spring& s : all) ++by_class[s.spring_class];
  EXPECT_EQ(springs_by_class(model), by_class);
  std::vector<Spring> by_body;
  for (const Body& body : model.bodies)
    for (const Spring& s : springs_of(model, body.first_particle, body.particle_count)) by_body.push_back(s);
  EXPECT_EQ(by_body, all);

  Model listed = model;
  list_springs(listed);
  EXPECT_EQ(listed.listed_springs, all);
  EXPECT_EQ(all_springs(listed), all);
  EXPECT_EQ(spring_count(listed), all.size());
  EXPECT_EQ(count(listed).shear, count(model).shear);
}

// A cube costs its model the same whatever its size: nothing is held for each particle or spring.
TEST(ModelBytes, DoNotGrowWithACube) {
  const auto bytes = [](int particles_per_edge) {
    return model_bytes(test::build(test::cube_on_plane(particles_per_edge)));
  };
  EXPECT_EQ(bytes(60), bytes(10));
}

}  // namespace
}  // namespace aspic

#include "model/incident_springs.h"

#include <gtest/gtest.h>

#include "model/springs.h"
#include "support/model_building.h"

namespace aspic {
namespace {

Model two_cubes() {
  ModelSettings settings = test::cube_on_plane(4);
  settings.cubes.push_back(settings.cubes[0]);
  settings.cubes[1].particles_per_edge = 3;
  settings.cubes[1].position.x = 20.0;
  return test::build(settings);
}

TEST(IncidentSpringsOfAModel, ListEverySpringOnceAtEachEndInAscendingNeighbourOrder) {
  const Model model = two_cubes();
  const std::vector<Spring> springs = all_springs(model);
  const IncidentSprings by_neighbour = *incident_springs(model, IncidentWords::neighbours),
                        by_spring = *incident_springs(model, IncidentWords::springs);
  ASSERT_EQ(by_neighbour.words.size(), 2 * springs.size());
  ASSERT_EQ(by_neighbour.start, by_spring.start);
  const std::uint32_t bits = class_bits(model);
  EXPECT_EQ(bits, 3u);  // eight classes
  std::vector<int> seen(springs.size(), 0);
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    std::int64_t last = -1;
    for (std::uint32_t n = by_neighbour.start[i]; n < by_neighbour.start[i + 1]; ++n) {
      const std::uint32_t neighbour = by_neighbour.words[n] >> bits,
                          spring_class = by_neighbour.words[n] & ((1u << bits) - 1u);
      EXPECT_GT(neighbour, last);
      last = neighbour;
      const Spring& spring = springs[by_spring.words[n] >> 1];
      const bool is_b = (by_spring.words[n] & 1u) != 0;
      EXPECT_EQ(is_b ? spring.b : spring.a, i);
      EXPECT_EQ(is_b ? spring.a : spring.b, neighbour);
      EXPECT_EQ(spring.spring_class, spring_class);
      ++seen[by_spring.words[n] >> 1];
    }
  }
  for (const int times : seen) EXPECT_EQ(times, 2);
  std::uint32_t most = 0;
  for (std::size_t i = 0; i + 1 < by_spring.start.size(); ++i)
    most = std::max(most, by_spring.start[i + 1] - by_spring.start[i]);
  EXPECT_EQ(highest_degree(model), most);
}

TEST(PackedSprings, KeepBothEndsAndTheClass) {
  const Model model = two_cubes();
  const std::vector<Spring> springs = all_springs(model);
  const auto packed = *packed_springs(model);
  ASSERT_EQ(packed.size(), springs.size());
  for (std::size_t s = 0; s < packed.size(); ++s) {
    EXPECT_EQ(packed[s][0], springs[s].a);
    EXPECT_EQ(packed[s][1] >> 3, springs[s].b);
    EXPECT_EQ(packed[s][1] & 7u, springs[s].spring_class);
  }
}

}  // namespace
}  // namespace aspic

#include "model/incident_springs.h"

#include <gtest/gtest.h>

#include <algorithm>

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

/// The words of the particle at this place, up to the first that is missing; none may follow.
std::vector<std::uint32_t> words_at(const IncidentSprings& springs, std::uint32_t place) {
  const std::uint32_t slice = place / spring_slice;
  std::vector<std::uint32_t> words;
  bool over = false;
  for (std::uint32_t n = springs.start[slice]; n < springs.start[slice + 1]; n += spring_slice) {
    const std::uint32_t word = springs.words[n + place % spring_slice];
    if (word == no_spring) {
      over = true;
    } else {
      EXPECT_FALSE(over) << place;
      words.push_back(word);
    }
  }
  return words;
}

TEST(IncidentSpringsOfAModel, ListEverySpringOnceAtEachEndInAscendingNeighborOrder) {
  const Model model = two_cubes();
  const std::vector<Spring> springs = all_springs(model);
  const IncidentSprings by_neighbor = *incident_springs(model, IncidentWords::neighbors),
                        by_spring = *incident_springs(model, IncidentWords::springs);
  ASSERT_EQ(by_neighbor.start, by_spring.start);
  const std::uint32_t bits = class_bits(model);
  EXPECT_EQ(bits, 3u);  // eight classes
  std::vector<int> seen(springs.size(), 0);
  std::size_t most = 0;
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    const auto neighbors = words_at(by_neighbor, i), ends = words_at(by_spring, i);
    ASSERT_EQ(neighbors.size(), ends.size());
    most = std::max(most, ends.size());
    std::int64_t last = -1;
    for (std::size_t n = 0; n < ends.size(); ++n) {
      const std::uint32_t neighbor = neighbors[n] >> bits, spring_class = neighbors[n] & ((1u << bits) - 1u);
      EXPECT_GT(neighbor, last);
      last = neighbor;
      const Spring& spring = springs[ends[n] >> 1];
      const bool is_b = (ends[n] & 1u) != 0;
      EXPECT_EQ(is_b ? spring.b : spring.a, i);
      EXPECT_EQ(is_b ? spring.a : spring.b, neighbor);
      EXPECT_EQ(spring.spring_class, spring_class);
      ++seen[ends[n] >> 1];
    }
  }
  for (const int times : seen) EXPECT_EQ(times, 2);
  EXPECT_EQ(highest_degree(model), most);
}

// A cube, cloth, a cube, a net: the words of cloth and net alone, as if there were nothing else.
TEST(IncidentSpringsOfAModel, BesideLatticesAreThoseOfAllOtherBodies) {
  ModelSettings settings = test::cube_on_plane(4);
  settings.cubes.push_back(settings.cubes[0]);
  settings.cubes[1].position.x = 20.0;
  settings.cloths.emplace_back();
  settings.goal_nets.emplace_back();
  Model model = test::build(settings);
  const IncidentSprings beside = *incident_springs(model, IncidentWords::beside_lattices),
                        all = *incident_springs(model, IncidentWords::neighbors);
  EXPECT_EQ(lattice_particles(model), 128u);
  std::uint32_t place = 0;
  for (const Body& body : model.bodies) {
    if (body.box()) continue;
    for (std::uint32_t i = 0; i < body.particle_count; ++i)
      EXPECT_EQ(words_at(beside, place++), words_at(all, body.first_particle + i));
  }
  EXPECT_EQ(place, model.particle_count() - 128u);
  for (const IncidentWords words :
       {IncidentWords::beside_lattices, IncidentWords::neighbors, IncidentWords::springs}) {
    const IncidentSprings made = *incident_springs(model, words);
    EXPECT_EQ(incident_counts(model, words).starts, made.start.size());
    EXPECT_EQ(incident_counts(model, words).words, made.words.size());
  }
  list_springs(model);
  EXPECT_EQ(incident_springs(model, IncidentWords::beside_lattices)->words, all.words);
}

// Of bodies of cells those that are left out have no words either.
TEST(IncidentSpringsOfAModel, BesideCellsAreThoseOfTheBodiesThatRemain) {
  ModelSettings settings = test::cube_on_plane(4);
  for (const double x : {20.0, 40.0}) {
    settings.voxels.emplace_back().layers = {{"11", "1."}};
    settings.voxels.back().position.x = x;
  }
  settings.cloths.emplace_back();
  const Model model = test::build(settings);
  std::vector<bool> left_out(model.bodies.size(), false);
  const auto first =
      std::ranges::find_if(model.bodies, [](const Body& body) { return body.lattice && !body.box(); });
  left_out[static_cast<std::size_t>(first - model.bodies.begin())] = true;
  const IncidentSprings beside = *incident_springs(model, IncidentWords::beside_cells, left_out),
                        all = *incident_springs(model, IncidentWords::neighbors);
  std::uint32_t place = 0;
  for (const Body& body : model.bodies) {
    if (body.box() || &body == &*first) continue;
    for (std::uint32_t i = 0; i < body.particle_count; ++i)
      EXPECT_EQ(words_at(beside, place++), words_at(all, body.first_particle + i));
  }
  EXPECT_EQ(place, model.particle_count() - 64u - first->particle_count);
  EXPECT_EQ(incident_counts(model, IncidentWords::beside_cells, left_out).words, beside.words.size());
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

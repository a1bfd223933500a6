#include "model/cell_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/incident_springs.h"
#include "model/springs.h"
#include "support/actuated.h"
#include "support/lattice_bodies.h"
#include "support/model_building.h"

namespace aspic {
namespace {

constexpr std::size_t any_bodies = 64;

/// By particle: neighbors in the order in which a kernel meets them, with the class of each spring.
using Neighbors = std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::uint32_t>>>;

/// What shaders/compute/cells.comp makes of the blocks.
Neighbors neighbors_of(const Model& model, const CellBlocks& cells) {
  Neighbors found;
  const auto particle_at = [](std::uint32_t word, int place) {
    const std::uint32_t before = word & 15u & ((1u << std::max(place, 0)) - 1u);
    return static_cast<std::int64_t>(word >> 4) + std::popcount(before) + std::min(place, 0) +
           std::max(place - 4, 0);
  };
  const auto take = [&](std::uint32_t record, const auto& class_of) {
    const CellBody& taken = cells.bodies[record >> block_bits];
    const std::uint32_t block = record & ((1u << block_bits) - 1u);
    const std::uint32_t own = cells.map[taken.first_block + block];
    for (int place = 0; place < 4; ++place) {
      if ((own >> place & 1u) == 0) continue;
      auto& springs = found[static_cast<std::uint32_t>(particle_at(own, place))];
      for (std::uint32_t d = 0; d < lattice_directions().size(); ++d) {
        const LatticeDirection& o = lattice_directions()[d];
        const auto c = class_of(place, d);
        if (!c) continue;
        const std::int64_t at = std::int64_t{block} + o.di * std::int64_t{taken.plane_blocks} +
                                o.dj * std::int64_t{taken.row_blocks};
        ASSERT_GE(at, 0);
        ASSERT_LT(at, taken.block_count);
        const std::uint32_t word = cells.map[taken.first_block + static_cast<std::uint32_t>(at)];
        springs.emplace_back(static_cast<std::uint32_t>(particle_at(word, place + o.dk)),
                             model.bodies[taken.body].first_class + *c);
      }
    }
  };
  using Class = std::optional<std::uint32_t>;
  for (std::size_t r = 0; r < cells.plain.size(); r += plain_words) {
    take(cells.plain[r], [&](int place, std::uint32_t d) {
      const std::uint32_t pattern =
          cells.plain[r + 1 + static_cast<std::size_t>(place) / 2] >> (16 * (place % 2)) & 0xffff;
      const bool joined = (cells.patterns[2 * pattern] >> d & 1u) != 0;
      return joined ? Class(cells.patterns[2 * pattern + 1] + lattice_directions()[d].spring_class) : Class();
    });
  }
  for (std::size_t r = 0; r < cells.mixed.size(); r += mixed_words) {
    take(cells.mixed[r], [&](int place, std::uint32_t d) {
      const std::uint32_t which = d < 16 ? 0 : 1, width = cells.class_width, none = (1u << width) - 1,
                          half =
                              cells.mixed[r + 1 + static_cast<std::size_t>(place)] >> (16 * which) & 0xffff;
      const auto at = std::ranges::find(half_directions[which], d) - half_directions[which].begin();
      const std::uint32_t bit = width * static_cast<std::uint32_t>(at),
                          c = cells.halves[half * half_words(width) + bit / 32] >> (bit % 32) & none;
      return c == none ? Class() : Class(c);
    });
  }
  return found;
}

/// The same from the list of springs, of these bodies.
Neighbors listed_neighbors(const Model& model, const CellBlocks& cells) {
  Neighbors found;
  for (const CellBody& taken : cells.bodies) {
    const Body& body = model.bodies[taken.body];
    for (const Spring& spring : springs_of(model, body.first_particle, body.particle_count)) {
      found[spring.a].emplace_back(spring.b, spring.spring_class);
      found[spring.b].emplace_back(spring.a, spring.spring_class);
    }
  }
  return found;
}

void expect_all_springs(const Model& model, std::size_t bodies) {
  const CellBlocks cells = cell_blocks(model, any_bodies);
  ASSERT_EQ(cells.bodies.size(), bodies);
  const Neighbors found = neighbors_of(model, cells);
  EXPECT_EQ(found, listed_neighbors(model, cells));
  EXPECT_EQ(found.size(), cells.particles);
}

ModelSettings cells_of(std::vector<std::vector<std::string>> layers) {
  ModelSettings settings;
  settings.materials = {{16.0, 33000.0, 0.4, "jelly"}, {30.0, 9000.0, 0.7, "fat"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.layers = std::move(layers);
  voxels.palette = {{"1", "jelly"}, {"2", "fat"}};
  voxels.pieces = Pieces::all;
  return settings;
}

/// A ball of so many cells across, with a shell four cells thick of another material.
ModelSettings ball(int across) {
  std::vector<std::vector<std::string>> layers;
  for (int y = 0; y < across; ++y) {
    auto& layer = layers.emplace_back();
    for (int z = 0; z < across; ++z) {
      std::string& row = layer.emplace_back();
      for (int x = 0; x < across; ++x) {
        const double half = (across - 1) / 2.0, r = std::hypot(x - half, y - half, z - half);
        row += r >= across / 2.0 ? '.' : r > across / 2.0 - 4.0 ? '2' : '1';
      }
    }
  }
  return cells_of(std::move(layers));
}

TEST(CellBlocks, HaveTheSpringsOfTheListInItsOrder) {
  expect_all_springs(test::build(cells_of({{"11221", "1.2.1", "11221"}, {"2....", ".1..2", "....2"}})), 1);
  expect_all_springs(test::build(ball(9)), 1);
  // Among other bodies; actuators make many classes.
  expect_all_springs(test::build(test::actuated(Integrator::midpoint, ContactModel::coulomb)), 2);
  const Model many = test::build(test::cells_of_many_classes(Integrator::midpoint));
  expect_all_springs(many, 1);
  EXPECT_EQ(cell_blocks(many, any_bodies).class_width, 16u);
  const auto one_material =
      test::with_cells(test::cube_on_plane(2), test::lattice_of("xxx,x.x,xxx;xxx,...,x.."));
  expect_all_springs(one_material, 1);
  EXPECT_EQ(cell_blocks(one_material, any_bodies).mixed_blocks(), 0u);
}

TEST(CellBlocks, BodiesOfOneShapeShareTheirPatterns) {
  ModelSettings settings = ball(9);
  const CellBlocks one = cell_blocks(test::build(settings), any_bodies);
  settings.voxels.push_back(settings.voxels[0]);
  settings.voxels.back().position.x += 20.0;
  const Model model = test::build(settings);
  expect_all_springs(model, 2);
  const CellBlocks two = cell_blocks(model, any_bodies);
  EXPECT_EQ(two.patterns, one.patterns);
  EXPECT_EQ(two.halves, one.halves);
  EXPECT_EQ(two.map.size(), 2 * one.map.size());
  EXPECT_EQ(cell_blocks(model, 1).bodies.size(), 1u);
}

// docs/voxels.md
TEST(CellBlocks, TakeLessThanEightBytesAParticle) {
  const Model model = test::build(ball(36));
  const CellBlocks cells = cell_blocks(model, any_bodies);
  EXPECT_EQ(cells.particles, model.particle_count());
  EXPECT_EQ(cells.class_width, 8u);
  EXPECT_LT(sizeof(std::uint32_t) * cells.words(), 8u * model.particle_count());
  EXPECT_GT(incident_counts(model, IncidentWords::neighbors).bytes(), 100u * model.particle_count());
}

// Two cells at the ends of a long diagonal: nearly all of the map would be empty.
TEST(CellBlocks, BodiesThatTakeLessAsListsStayThem) {
  std::vector<std::vector<std::string>> layers(40, std::vector<std::string>(40, std::string(40, '.')));
  layers.front().front().front() = layers.back().back().back() = '1';
  EXPECT_FALSE(cell_blocks(test::build(cells_of(std::move(layers))), any_bodies).any());
}

TEST(CellBlocks, AreOfLatticesAlone) {
  Model model = test::build(ball(9));
  Model joined = model;
  // A spring that leads nowhere in the lattice.
  joined.listed_springs.front().b = joined.particle_count() - 1;
  EXPECT_FALSE(cell_blocks(joined, any_bodies).any());
  model.bodies[0].lattice.reset();
  EXPECT_FALSE(cell_blocks(model, any_bodies).any());
  EXPECT_FALSE(cell_blocks(test::build(test::cube_on_plane(4)), any_bodies).any());
}

}  // namespace
}  // namespace aspic

#include "model/voxels.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "model/material.h"
#include "model/springs.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ModelSettings scene_of(CellLayers layers, CellPalette palette = {}) {
  ModelSettings settings;
  settings.materials = {{1000.0, 1e5, 0.1, "muscle"}, {500.0, 3e4, 0.3, "fat"}, {2000.0, 1e6, 0.0, "bone"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.size = 0.25;
  voxels.layers = std::move(layers);
  voxels.palette = std::move(palette);
  return settings;
}

const CellPalette three = {{"1", "muscle"}, {"2", "fat"}, {"3", "bone"}};

double total_mass(const Model& model) {
  return std::accumulate(model.mass.begin(), model.mass.end(), 0.0);
}

// A quarter is a power of two: the box and the layers have the same edges to the bit.
TEST(Voxels, FullBoxOfOneMaterialIsTheCubeToTheBit) {
  const std::vector<std::string> layer(4, "11111");
  ModelSettings settings = scene_of({layer, layer, layer}, {{"1", "muscle"}});
  settings.voxels[0].rotation = {{1.0, 0.3, 0.7}, 25.0};
  settings.voxels[0].velocity = {1.0, 2.0, 3.0};
  settings.voxels[0].pinned.names = {"left-top-front"};
  const Model cells = test::build(settings);
  CubeSettings& box = settings.cubes.emplace_back();
  box.particles = {6, 4, 5};
  box.edge_length = 5 * 0.25;
  box.position = settings.voxels[0].position;
  box.rotation = settings.voxels[0].rotation;
  box.velocity = settings.voxels[0].velocity;
  box.pinned = settings.voxels[0].pinned;
  box.material.emplace().name = "muscle";
  settings.voxels.clear();
  const Model cube = test::build(settings);
  ASSERT_TRUE(cells.bodies[0].box()) << "its springs follow from the lattice";
  EXPECT_TRUE(check_same_topology(cube, cells).ok());
  EXPECT_EQ(cells.initial_position.list(0, 120), cube.initial_position.list(0, 120));
  EXPECT_EQ(cells.initial_velocity, cube.initial_velocity);
  EXPECT_EQ(cells.mass, cube.mass);
  EXPECT_EQ(cells.inverse_mass, cube.inverse_mass);
  EXPECT_EQ(cells.bodies[0].size, cube.bodies[0].size);
  ASSERT_EQ(cells.spring_classes.size(), 4u);
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_EQ(cells.spring_classes[c].type, cube.spring_classes[c].type);
    EXPECT_EQ(cells.spring_classes[c].stiffness, cube.spring_classes[c].stiffness);
    EXPECT_EQ(cells.spring_classes[c].damping, cube.spring_classes[c].damping);
    EXPECT_EQ(cells.spring_classes[c].rest_length, cube.spring_classes[c].rest_length);
  }
}

TEST(Voxels, LayersGoUpRowsToTheFrontAndCharactersToTheRight) {
  ModelSettings settings = scene_of({{"1..", "111"}, {"1..", "..."}});
  const Model model = test::build(settings);
  const Lattice& lattice = *model.bodies[0].lattice;
  ASSERT_EQ(lattice.particles, (std::array{4, 3, 3}));
  std::set<Lattice::Place> full;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 2; ++y)
      for (int z = 0; z < 2; ++z)
        if (lattice.full({x, y, z})) full.insert({x, y, z});
  EXPECT_EQ(full, (std::set<Lattice::Place>{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 1, 0}}));
  EXPECT_EQ(model.initial_position[0], settings.voxels[0].position - (Vec3{0.375, 0.25, 0.25}));
}

// Empty cells around a body are no part of its box, and yet count for its place.
TEST(Voxels, BoxIsThatOfTheFullCellsAndTheCenterThatOfAll) {
  const Model bare = test::build(scene_of({{"11"}}));
  ModelSettings settings =
      scene_of({{"....", "....", "...."}, {"....", ".11.", "...."}, {"....", "....", "...."}});
  const Model model = test::build(settings);
  EXPECT_TRUE(model.bodies[0].box());
  EXPECT_EQ(model.bodies[0].lattice->particles, (std::array{3, 2, 2}));
  EXPECT_EQ(model.initial_position.list(0, 12), bare.initial_position.list(0, 12));
  settings.voxels[0].layers = {{"11..", "....", "...."}};
  const Model aside = test::build(settings);
  EXPECT_EQ(aside.initial_position[0], bare.initial_position[0] + (Vec3{-0.25, 0.0, -0.25}));
}

/// k, c and rest length of every spring by its ends' places, from each cell: what docs/physics.md says.
using Law = std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<double, 2>>;
Law law_of(const ModelSettings& settings, const Lattice& lattice, double particles, double full) {
  const VoxelsSettings& v = settings.voxels[0];
  const auto numbers = particle_numbers(lattice);
  struct Sum {
    double k = 0.0, c = 0.0;
    int cells = 0;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Sum> sums;
  const auto material_at = [&](const Lattice::Place& cell) -> const MaterialSettings& {
    const char c = v.layers[static_cast<std::size_t>(cell[1])][static_cast<std::size_t>(cell[2])]
                           [static_cast<std::size_t>(cell[0])];
    return *find_material(settings, v.palette.at(std::string(1, c)));
  };
  const auto share = [&](const Lattice::Place& a, const Lattice::Place& b, const Lattice::Place& cell) {
    const MaterialSettings& m = material_at(cell);
    const double k = m.youngs_modulus * v.size / 7.3125,
                 mass = m.density * std::pow(v.size, 3) * full / particles;
    Sum& sum = sums[std::minmax(numbers[lattice.index(a)], numbers[lattice.index(b)])];
    sum.k += k;
    sum.c += 2.0 * m.damping_ratio * std::sqrt(k * mass / 2.0);
    ++sum.cells;
  };
  const auto [nx, ny, nz] = lattice.cells();
  for (int x = 0; x < nx; ++x)
    for (int y = 0; y < ny; ++y)
      for (int z = 0; z < nz; ++z) {
        const Lattice::Place cell = {x, y, z};
        if (!lattice.full(cell)) continue;
        std::vector<Lattice::Place> corners;
        for (int n = 0; n < 8; ++n) corners.push_back({x + (n & 1), y + (n >> 1 & 1), z + (n >> 2)});
        for (std::size_t a = 0; a < 8; ++a)
          for (std::size_t b = a + 1; b < 8; ++b) share(corners[a], corners[b], cell);
        // Over two steps, with the next cell along an axis.
        for (std::size_t axis = 0; axis < 3; ++axis) {
          Lattice::Place next = cell;
          ++next[axis];
          if (!lattice.full(next)) continue;
          for (const Lattice::Place& from : corners) {
            if (from[axis] != cell[axis]) continue;
            Lattice::Place to = from;
            to[axis] += 2;
            share(from, to, cell);
            share(from, to, next);
          }
        }
      }
  Law law;
  for (const auto& [ends, sum] : sums) law[ends] = {sum.k / sum.cells, sum.c / sum.cells};
  return law;
}

TEST(Voxels, CellsShareTheirSpringsEqually) {
  const CellLayers bodies[] = {
      {{"12"}},
      {{"1.2", "311"}, {"222", "1.1"}},
      {{"1122", "3..1", "2211"}, {"1111", "2.33", "..12"}, {"1...", "1...", "1..."}}};
  for (const CellLayers& layers : bodies) {
    ModelSettings settings = scene_of(layers, three);
    settings.voxels[0].pieces = Pieces::all;
    const Model model = test::build(settings);
    const Lattice& lattice = *model.bodies[0].lattice;
    const auto full = static_cast<double>(std::ranges::count(lattice.full_cells, true));
    Law law = law_of(settings, lattice, model.particle_count(), full);
    std::pair<std::uint32_t, std::uint32_t> before;
    for (const Spring& s : springs_of(model)) {
      const SpringClass& kind = model.spring_classes[s.spring_class];
      ASSERT_TRUE(law.contains({s.a, s.b}));
      EXPECT_LT(before, std::pair(s.a, s.b));
      before = {s.a, s.b};
      EXPECT_NEAR(kind.stiffness, (law[{s.a, s.b}][0]), 1e-12 * kind.stiffness);
      EXPECT_NEAR(kind.damping, (law[{s.a, s.b}][1]), 1e-12 * kind.damping);
      EXPECT_NEAR(kind.rest_length, length(model.initial_position[s.a] - model.initial_position[s.b]), 1e-14);
      law.erase({s.a, s.b});
    }
    EXPECT_TRUE(law.empty()) << law.size() << " springs are missing";
    const ModelCounts made = count(model), said = voxel_counts(settings.voxels[0]);
    EXPECT_EQ(made.particles, said.particles);
    EXPECT_EQ(made.structural, said.structural);
    EXPECT_EQ(made.shear, said.shear);
    EXPECT_EQ(made.bending, said.bending);
    EXPECT_EQ(made.listed, said.listed);
  }
}

TEST(Voxels, MassIsThatOfTheCellsAndLiesWhereTheyAre) {
  ModelSettings settings = scene_of({{"13", "1."}, {"22", "1."}}, three);
  const Model model = test::build(settings);
  const double cell = std::pow(0.25, 3);
  EXPECT_NEAR(total_mass(model), cell * (3 * 1000.0 + 2 * 500.0 + 2000.0), 1e-12 * total_mass(model));
  // The corner of a bone alone against one of fat alone: as their densities.
  const Lattice& lattice = *model.bodies[0].lattice;
  const auto numbers = particle_numbers(lattice);
  EXPECT_NEAR(model.mass[numbers[lattice.index({2, 0, 0})]] / model.mass[numbers[lattice.index({2, 2, 0})]],
              4.0, 1e-12);
}

TEST(Voxels, MaterialsOfOneNameAreOneWhateverTheirCharacters) {
  const Model one = test::build(scene_of({{"111"}}, three)),
              other = test::build(scene_of({{"a1b"}}, {{"1", "muscle"}, {"a", "muscle"}, {"b", "muscle"}}));
  EXPECT_TRUE(other.bodies[0].box());
  EXPECT_EQ(other.spring_classes.size(), 4u);
  EXPECT_EQ(other.mass, one.mass);
}

// Numbers of materials may change while a run goes on.
TEST(Voxels, TopologyIsTheSameForOtherNumbers) {
  ModelSettings settings = scene_of({{"12", "21"}, {"11", "12"}}, three);
  const Model before = test::build(settings);
  settings.materials[0] = {10.0, 3e4, 0.3, "muscle"};
  settings.materials[1] = {500.0, 3e4, 0.3, "fat"};
  EXPECT_TRUE(check_same_topology(before, test::build(settings)).ok());
}

TEST(Voxels, PinsFacesOfTheFullCellsCornersAndParticles) {
  ModelSettings settings = scene_of({{".111", "...."}, {".1..", "...."}});
  const auto pinned = [&](PinnedSettings wanted) {
    settings.voxels[0].pinned = std::move(wanted);
    return pinned_indices(test::build(settings));
  };
  const Model model = test::build(settings);
  ASSERT_EQ(model.particle_count(), 16u + 4u);
  for (const std::uint32_t i : pinned({{"left"}, {}}))
    EXPECT_EQ(model.initial_position[i].x, model.initial_position[0].x);
  EXPECT_EQ(pinned({{"left"}, {}}).size(), 6u);
  EXPECT_EQ(pinned({{"top"}, {}}).size(), 4u);
  EXPECT_EQ(pinned({{"right"}, {}}).size(), 4u) << "its upper half is empty";
  EXPECT_EQ(pinned({{"right-top-front"}, {}}).size(), 0u) << "there is no particle at that corner";
  EXPECT_THAT(pinned({{}, {0, 19}}), ElementsAre(0u, 19u));
  settings.voxels[0].pinned = {{}, {20}};
  const auto refused = build_model(settings);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().what, "voxels[0].pinned: index 20 is not in the body; allowed: 0 … 19");
}

TEST(Voxels, PiecesAreJoinedByFaces) {
  const CellLayers layers = {{"1..11", ".1..."}, {"1....", "....."}};
  ModelSettings settings = scene_of(layers);
  const auto refused = build_model(settings);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().what, HasSubstr("3 pieces that share no face, of 2, 2 and 1 cells"));
  EXPECT_THAT(refused.error().what, HasSubstr("pieces = \"largest\""));
  settings.voxels[0].pieces = Pieces::largest;
  const Model largest = test::build(settings);
  EXPECT_EQ(largest.bodies[0].lattice->particles, (std::array{2, 3, 2})) << "the first of those as large";
  settings.voxels[0].pieces = Pieces::all;
  // Two of two cells, and one that shares an edge with the first.
  EXPECT_EQ(test::build(settings).particle_count(), 12u + 12u + 6u);
}

TEST(Voxels, HingesAreEdgesThatTwoCellsShareAlone) {
  const auto hinges_of = [](CellLayers layers) {
    ModelSettings settings = scene_of(std::move(layers));
    settings.voxels[0].pieces = Pieces::all;
    return hinges(std::get<VoxelShape>(shape_of(settings.voxels[0])).lattice);
  };
  EXPECT_EQ(hinges_of({{"111", "1.1"}}), 0u);
  EXPECT_EQ(hinges_of({{"1.", ".1"}}), 1u);
  EXPECT_EQ(hinges_of({{"1.", ".1"}, {"1.", ".1"}}), 2u);
  EXPECT_EQ(hinges_of({{"1."}, {".1"}, {"1."}}), 2u);
  EXPECT_EQ(hinges_of({{"1.", ".."}, {"..", ".1"}}), 0u) << "they share a corner alone";
}

TEST(Voxels, SayWhatIsWrongWithThem) {
  const CellPalette palette = {{"1", "muscle"}};
  const std::tuple<CellLayers, CellPalette, std::string, std::string> cases[] = {
      {{}, {}, "layers", "the body is empty"},
      {{{}}, {}, "layers", "the body is empty"},
      {{{""}}, {}, "layers", "the body is empty"},
      {{{"..0 "}}, {}, "layers", "the body is empty: all its cells are empty"},
      {{{"11", "11"}, {"11"}}, {}, "layers", "layer 1 has 1 rows and layer 0 has 2"},
      {{{"11", "1"}}, {}, "layers", "row 1 of layer 0 is 1 long and row 0 of layer 0 is 2"},
      {{{"1\xc3\xa9"}}, {}, "layers", "letters, digits and other signs of ASCII"},
      {{{std::string(5000, '1')}}, {}, "layers", "5000 cells along an axis; allowed: 4095"},
      {{{"1x"}},
       palette,
       "layers",
       "row 0 of layer 0 has a cell 'x', which 'palette' does not name; it names 1"},
      {{{"1"}}, {{"12", "muscle"}}, "palette", "\"12\" is not a cell"},
      {{{"1"}}, {{".", "muscle"}}, "palette", "\".\" is not a cell"},
      {{{"1"}},
       {{"1", "wood"}},
       "palette",
       "the material \"wood\", which the scene does not have; it has muscle, fat, bone"}};
  for (const auto& [layers, by_cell, key, message] : cases) {
    const ModelSettings settings = scene_of(layers, by_cell);
    const auto fault = fault_of(settings, settings.voxels[0]);
    ASSERT_TRUE(fault) << message;
    EXPECT_EQ(fault->key, key);
    EXPECT_THAT(fault->message, HasSubstr(message));
    const auto model = build_model(settings);
    ASSERT_FALSE(model.ok());
    EXPECT_THAT(model.error().what, HasSubstr(fmt::format("voxels[0].{}: ", key)));
  }
  EXPECT_EQ(fault_of(scene_of({{"11"}, {"1"}}), scene_of({{"11"}, {"1"}}).voxels[0])->element, 1u);
}

// Volume by the divergence theorem; each edge once in each direction, or where cells share an edge alone, as
// often.
TEST(Voxels, SurfaceEnclosesTheCells) {
  ModelSettings settings = scene_of({{"111", "1.1", "111"}, {"1..", "...", "..1"}}, {{"1", "fat"}});
  const Model model = test::build(settings);
  double volume = 0.0;
  const auto& x = model.initial_position;
  for (const Quad& q : surface_of(model.bodies[0]).quads)
    volume += dot(x[q[0]], cross(x[q[1]], x[q[2]]) + cross(x[q[2]], x[q[3]])) / 6.0;
  EXPECT_NEAR(volume, 10 * std::pow(0.25, 3), 1e-12);
}

}  // namespace
}  // namespace aspic

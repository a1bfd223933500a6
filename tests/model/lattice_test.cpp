#include "model/lattice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <tuple>

#include "model/incident_springs.h"
#include "support/lattice_bodies.h"

namespace aspic {
namespace {

using testing::ElementsAre;

/// Springs of each class.
std::vector<std::uint64_t> springs_by_class(const Lattice& lattice) {
  std::vector<std::uint64_t> count(lattice_class_types.size(), 0);
  for (const LatticeDirection& o : upper_directions()) count[o.spring_class] += springs_along(lattice, o);
  return count;
}

std::size_t particles_in(const Lattice& lattice) {
  const auto numbers = particle_numbers(lattice);
  return numbers.size() - static_cast<std::size_t>(std::ranges::count(numbers, no_particle));
}

TEST(Lattice, DirectionsAreTheNeighborsInCellsAndTwoStepsAlongAxes) {
  std::array<int, 4> of_class = {};
  std::size_t n = 0;
  for (const LatticeDirection& o : lattice_directions()) {
    ++of_class[o.spring_class];
    const LatticeDirection& opposite = lattice_directions()[lattice_directions().size() - 1 - n++];
    EXPECT_EQ(opposite, (LatticeDirection{-o.di, -o.dj, -o.dk, o.spring_class}));
  }
  // Neighbors along 3 axes, across 6 diagonals of faces, 4 through a cell, and 3 axes again: both ways.
  EXPECT_THAT(of_class, ElementsAre(6, 12, 8, 6));
  for (const LatticeDirection& o : upper_directions())
    EXPECT_GT(std::tie(o.di, o.dj, o.dk), std::make_tuple(0, 0, 0));
}

TEST(Lattice, PlacesAndNumbersAreInverse) {
  const Lattice lattice = {{3, 5, 2}, {}};
  std::uint32_t number = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 5; ++j)
      for (int k = 0; k < 2; ++k, ++number) {
        EXPECT_EQ(lattice.index({i, j, k}), number);
        EXPECT_EQ(lattice.place(number), (Lattice::Place{i, j, k}));
      }
  EXPECT_EQ(lattice.points(), number);
  EXPECT_FALSE(lattice.contains({3, 0, 0}) || lattice.contains({0, -1, 0}) || lattice.contains({0, 0, 2}));
}

TEST(Lattice, LWithThreeCellsHasWhatACountByHandFinds) {
  // Of two by two cells in x and y one is empty.
  const Lattice l = test::lattice_of("x,x;x,.");
  ASSERT_EQ(l.particles, (std::array{3, 3, 2}));
  EXPECT_EQ(particles_in(l), 2u * 8);
  // Along edges: 10 in each layer and 8 between them. Across faces: two in each of 3 + 3 cells' ends and of
  // the 10 sides. Through 3 cells. Over two steps: along the two rows of two full cells, each on both sides,
  // in either layer; at the empty cell the outer sides have none.
  EXPECT_THAT(springs_by_class(l), ElementsAre(28u, 12u + 20u, 12u, 8u));
  EXPECT_FALSE(l.has_particle({2, 2, 0}) || l.has_particle({2, 2, 1}));
  EXPECT_TRUE(l.has_particle({1, 1, 0}));
  EXPECT_TRUE(l.has_spring({0, 1, 0}, {2, 0, 0, 3})) << "along the full row below";
  EXPECT_FALSE(l.has_spring({0, 2, 0}, {2, 0, 0, 3}));
  EXPECT_FALSE(l.has_spring({1, 1, 0}, {1, 1, 0, 1})) << "through the empty cell";
  EXPECT_FALSE(l.has_spring({1, 2, 0}, {1, -1, 0, 1})) << "through the empty cell, from corner to corner";
  EXPECT_TRUE(l.has_spring({1, 1, 0}, {1, 0, 0, 0})) << "an edge of the empty cell and of a full one";
}

TEST(Lattice, HoleTakesNoParticlesAndTheSpringsAcrossIt) {
  const Lattice ring = test::lattice_of("x,x,x;x,.,x;x,x,x"), whole = {{4, 4, 2}, {}};
  ASSERT_EQ(ring.particles, whole.particles);
  EXPECT_EQ(particles_in(ring), 32u);
  EXPECT_THAT(springs_by_class(whole), ElementsAre(64u, 36u + 48u, 36u, 32u));
  // All but two diagonals at either end of the hole and four through it.
  EXPECT_THAT(springs_by_class(ring), ElementsAre(64u, 36u + 48u - 4u, 36u - 4u, 32u));
}

TEST(Lattice, CellsThatShareAnEdgeAloneAreHinged) {
  const Lattice hinge = test::lattice_of("x,.;.,x");
  EXPECT_EQ(particles_in(hinge), 8u + 6u);
  EXPECT_THAT(springs_by_class(hinge), ElementsAre(23u, 24u, 8u, 0u)) << "nothing bends over the shared edge";
}

TEST(Lattice, FullCellsThatAreListedMeanTheSame) {
  Lattice box = {{3, 5, 4}, {}}, listed = box;
  listed.full_cells.assign(2 * 4 * 3, true);
  EXPECT_EQ(springs_by_class(listed), springs_by_class(box));
  EXPECT_EQ(particle_numbers(listed), particle_numbers(box));
  ModelSettings settings = test::cube_on_plane(2);
  settings.cubes[0].particles = box.particles;
  const Model implied = test::build(settings), made = test::with_cells(settings, listed);
  EXPECT_TRUE(implied.bodies[0].box());
  EXPECT_FALSE(made.bodies[0].box()) << "its springs are listed";
  EXPECT_EQ(all_springs(made), all_springs(implied));
  EXPECT_EQ(made.initial_position.list(0, 60), implied.initial_position.list(0, 60));
  // The same sides, cell by cell in another order.
  const QuadMesh one = surface_of(implied.bodies[0]), other = surface_of(made.bodies[0]);
  ASSERT_EQ(one.groups.size(), 6u);
  ASSERT_EQ(other.groups.size(), 6u);
  std::size_t first = 0;
  for (std::size_t g = 0; g < 6; ++g) {
    ASSERT_EQ(one.groups[g].quads, other.groups[g].quads);
    const auto of = [&](const QuadMesh& mesh) {
      const auto from = mesh.quads.begin() + static_cast<std::ptrdiff_t>(first);
      return std::set<Quad>(from, from + one.groups[g].quads);
    };
    EXPECT_EQ(of(one), of(other)) << g;
    first += one.groups[g].quads;
  }
}

TEST(Lattice, ListedSpringsAreSortedAndCounted) {
  for (const char* const cells : {"x,x;x,.", "x,.;.,x", "x..,.x.,..x;xxx,xxx,xxx", "..,.x"}) {
    const Lattice lattice = test::lattice_of(cells);
    const std::vector<Spring> springs = springs_of(lattice, 100, 7);
    std::vector<std::uint64_t> by_class(4, 0);
    for (std::size_t s = 0; s < springs.size(); ++s) {
      ++by_class[springs[s].spring_class - 7];
      EXPECT_LT(springs[s].a, springs[s].b);
      EXPECT_LT(springs[s].b, 100 + particles_in(lattice));
      if (s > 0) {
        EXPECT_LT(std::tie(springs[s - 1].a, springs[s - 1].b), std::tie(springs[s].a, springs[s].b));
      }
    }
    EXPECT_EQ(by_class, springs_by_class(lattice)) << cells;
  }
}

// Volume by the divergence theorem, and every edge once in each direction.
TEST(Lattice, SurfaceIsClosedAndEnclosesTheFullCells) {
  const std::map<std::string_view, std::pair<std::size_t, double>> bodies = {
      {"x,x;x,.", {14, 3.0}},                                    // 8 sides around, 3 and 3 ends
      {"x,x,x;x,.,x;x,x,x", {32, 8.0}},                          // 12 around, 4 in the hole, 8 and 8 ends
      {"xxx,xxx,xxx;xxx,x.x,xxx;xxx,xxx,xxx", {54 + 6, 26.0}}};  // a bubble
  for (const auto& [cells, expected] : bodies) {
    ModelSettings settings = test::cube_on_plane(2);
    const Lattice lattice = test::lattice_of(cells);
    settings.cubes[0].edge_length = std::ranges::max(lattice.particles) - 1;
    const Model model = test::with_cells(settings, lattice);
    const QuadMesh surface = surface_of(model.bodies[0]);
    EXPECT_EQ(surface.quads.size(), expected.first) << cells;
    EXPECT_EQ(surface.groups.size(), 6u);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double volume = 0.0;
    const auto& x = model.initial_position;
    for (const Quad& q : surface.quads) {
      for (std::size_t c = 0; c < 4; ++c) ++edges[{q[c], q[(c + 1) % 4]}];
      volume += dot(x[q[0]], cross(x[q[1]], x[q[2]]) + cross(x[q[2]], x[q[3]])) / 6.0;
    }
    for (const auto& [edge, times] : edges) {
      EXPECT_EQ(times, 1) << cells;
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1u) << cells;
    }
    EXPECT_NEAR(volume, expected.second, 1e-9) << cells;
  }
}

TEST(Box, SpringsAreThosePairsAtTheirDistances) {
  for (const std::array<int, 3>& n : {std::array{2, 3, 5}, {5, 2, 3}, {2, 2, 7}, {4, 6, 2}, {3, 3, 4}}) {
    ModelSettings settings = test::cube_on_plane(2);
    settings.cubes[0].particles = n;
    const Model model = test::build(settings);
    const Lattice lattice = {n, {}};
    std::vector<Spring> expected;
    for (std::uint32_t a = 0; a < lattice.points(); ++a) {
      for (std::uint32_t b = a + 1; b < lattice.points(); ++b) {
        int squared = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const int steps = lattice.place(b)[axis] - lattice.place(a)[axis];
          squared += steps * steps;
        }
        // A diagonal of two faces is longer than two steps: it has 5.
        if (squared <= 4) expected.push_back({a, b, static_cast<std::uint32_t>(squared - 1)});
      }
    }
    EXPECT_EQ(all_springs(model), expected);
    for (const Spring& s : expected)
      EXPECT_NEAR(model.spring_classes[s.spring_class].rest_length,
                  length(model.initial_position[s.b] - model.initial_position[s.a]), 1e-13);
    const ModelCounts counted = count(model), closed_form = box_counts(n);
    EXPECT_EQ(counted.particles, closed_form.particles);
    EXPECT_EQ(counted.structural, closed_form.structural);
    EXPECT_EQ(counted.shear, closed_form.shear);
    EXPECT_EQ(counted.bending, closed_form.bending);
    EXPECT_EQ(spring_count(model), expected.size());
    Model listed = model;
    list_springs(listed);
    EXPECT_EQ(highest_degree(model), highest_degree(listed));
  }
}

TEST(Box, IsCenteredWithItsLongestEdgeAsGiven) {
  ModelSettings settings = test::cube_on_plane(2, 5.0);
  settings.cubes[0].particles = {3, 9, 5};
  settings.cubes[0].edge_length = 2.0;
  const Model model = test::build(settings);
  EXPECT_EQ(model.initial_position[0], (Vec3{-0.25, 4.0, -0.5}));
  EXPECT_EQ(model.initial_position[model.particle_count() - 1], (Vec3{0.25, 6.0, 0.5}));
  EXPECT_EQ(model.bodies[0].size, 2.0);
  EXPECT_EQ(spacing_of(settings.cubes[0]), 0.25);
}

TEST(Box, OfEqualEdgesIsTheCubeToTheBit) {
  ModelSettings settings = test::cube_on_plane(7);
  settings.cubes[0].edge_length = 1.7;
  settings.cubes[0].rotation = {{1.0, 0.3, 0.7}, 25.0};
  settings.cubes[0].material.emplace();
  const Model cube = test::build(settings);
  settings.cubes[0].particles = {7, 7, 7};
  const Model box = test::build(settings);
  EXPECT_EQ(box.initial_position.list(0, 343), cube.initial_position.list(0, 343));
  EXPECT_EQ(box.mass, cube.mass);
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_EQ(box.spring_classes[c].stiffness, cube.spring_classes[c].stiffness);
    EXPECT_EQ(box.spring_classes[c].damping, cube.spring_classes[c].damping);
    EXPECT_EQ(box.spring_classes[c].rest_length, cube.spring_classes[c].rest_length);
  }
  EXPECT_TRUE(check_same_topology(cube, box).ok());
}

TEST(Box, MaterialGivesItItsVolumesMass) {
  CubeSettings box;
  box.particles = {5, 9, 3};
  box.edge_length = 2.0;
  box.material.emplace();
  EXPECT_NEAR(material_particle_mass(box) * 5 * 9 * 3, 16.0 * 1.0 * 2.0 * 0.5, 1e-12);
  EXPECT_NEAR(material_springs(box).stiffness, 33000.0 * 0.25 / 7.3125, 1e-9);
}

TEST(Box, FacesAndCornersHaveTheParticlesOfTheirSides) {
  const auto pinned = [](const char* name) {
    ModelSettings settings = test::cube_on_plane(2);
    settings.cubes[0].particles = {3, 4, 5};
    settings.cubes[0].pinned.names = {name};
    return count(test::build(settings)).pinned;
  };
  EXPECT_EQ(pinned("left"), 20u);
  EXPECT_EQ(pinned("right"), 20u);
  EXPECT_EQ(pinned("top"), 15u);
  EXPECT_EQ(pinned("bottom"), 15u);
  EXPECT_EQ(pinned("front"), 12u);
  EXPECT_EQ(pinned("left-top-front"), 1u);
}

TEST(Box, KeepsItsShapeAtAnotherResolution) {
  CubeSettings box;
  box.particles = {9, 5, 3};
  EXPECT_EQ(with_longest_edge(box, 17), (std::array{17, 9, 5}));
  EXPECT_EQ(with_longest_edge(box, 5), (std::array{5, 3, 2}));
  EXPECT_EQ(with_longest_edge(box, 2), (std::array{2, 2, 2}));
  resize(box, 17);
  EXPECT_EQ(box.lattice(), (std::array{17, 9, 5}));
  CubeSettings cube;
  resize(cube, 6);
  EXPECT_FALSE(cube.particles);
  EXPECT_EQ(cube.lattice(), (std::array{6, 6, 6}));
}

}  // namespace
}  // namespace aspic

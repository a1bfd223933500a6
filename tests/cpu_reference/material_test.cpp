#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <vector>

#include "cpu_reference/terms.h"
#include "model/cube.h"
#include "support/model_building.h"

namespace aspic::reference {
namespace {

/// A free bar of `length` × width × width particles cut from the cube's lattice, with the cube's spring
/// classes.
Model bar(int length, int width, const SpringSettings& springs, double s) {
  ModelSettings settings;
  CubeSettings cube;
  cube.particles_per_edge = 3;
  cube.edge_length = 2 * s;
  cube.structural = cube.shear = cube.bending = springs;
  settings.cubes.push_back(cube);
  settings.simulation.gravity = {0, 0, 0};
  const Model pattern = test::build(settings);

  std::vector<Vec3> positions;
  for (int i = 0; i < length; ++i) {
    for (int j = 0; j < width; ++j) {
      for (int k = 0; k < width; ++k) positions.push_back({i * s, j * s, k * s});
    }
  }
  Model model = test::particles(positions, std::vector<Vec3>(positions.size()));
  model.simulation.gravity = {0, 0, 0};
  model.spring_classes = pattern.spring_classes;
  for (std::uint32_t a = 0; a < positions.size(); ++a) {
    for (std::uint32_t b = a + 1; b < positions.size(); ++b) {
      const Vec3 d = (positions[b] - positions[a]) / s;
      const double largest = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
      const double sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
      if (largest < 1.5)
        model.listed_springs.push_back({a, b, static_cast<std::uint32_t>(std::lround(sum)) - 1});
      if (largest > 1.5 && largest < 2.5 && sum < 2.5) model.listed_springs.push_back({a, b, 3});
    }
  }
  return model;
}

/// Tension [N] of the bar stretched by `strain` along x between its held ends, its sides free to shrink.
double tension(const Model& model, int length, int width, double strain) {
  const Dynamics<double> dynamics(model);
  const Terms<double> terms(dynamics);
  const auto count = static_cast<Eigen::Index>(model.particle_count());
  const Eigen::Index layer = static_cast<Eigen::Index>(width) * width;
  Field<double> x(3, count), v = Field<double>::Zero(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    x.col(i) = rounded<double>(model.initial_position[static_cast<std::size_t>(i)]);
    x(0, i) *= 1.0 + strain;
  }
  // Damped relaxation to equilibrium; the end layers keep their x but may shrink sideways.
  const double h = 0.2 / std::sqrt(model.spring_classes[0].stiffness);
  Field<double> f;
  for (int n = 0; n < 20000; ++n) {
    f = terms.force(x, Field<double>::Zero(3, count));
    const Field<double> free = f;
    for (Eigen::Index i = 0; i < layer; ++i) f(0, i) = f(0, count - 1 - i) = 0.0;
    if (n > 100 && f.cwiseAbs().maxCoeff() < 1e-9) {
      return -(free.row(0).tail(layer).sum());
    }
    v = 0.98 * (v + h * f);
    x += h * v;
  }
  ADD_FAILURE() << "the bar of " << length << " layers did not come to rest";
  return 0.0;
}

// The material law k = E·s/7.3125 speaks of the infinite lattice. A finite bar has a surface whose springs
// are missing, so its stiffness per area is extrapolated in 1/width, the ratio of surface to volume; the
// tension of an equilibrium is the same through every section, ends included, so the length hardly matters
// once the ends may shrink.
TEST(Material, StretchedLatticeShowsItsYoungsModulus) {
  const double E = 33000.0, s = 0.1, strain = 1e-4;
  SpringSettings springs;
  springs.stiffness = E * s / 7.3125;
  std::vector<double> inverse_width, modulus;
  for (const int width : {4, 6, 8}) {
    const int length = 3 * width;
    const double area = std::pow(width * s, 2);  // each particle stands for a cell of s³
    modulus.push_back(tension(bar(length, width, springs, s), length, width, strain) / (area * strain));
    inverse_width.push_back(1.0 / width);
  }
  // Quadratic through three points, evaluated at 1/width = 0 (surfaces and edges).
  double extrapolated = 0.0;
  for (int p = 0; p < 3; ++p) {
    double basis = 1.0;
    for (int q = 0; q < 3; ++q) {
      if (q != p)
        basis *= -inverse_width[static_cast<std::size_t>(q)] /
                 (inverse_width[static_cast<std::size_t>(p)] - inverse_width[static_cast<std::size_t>(q)]);
    }
    extrapolated += basis * modulus[static_cast<std::size_t>(p)];
  }
  EXPECT_NEAR(extrapolated / E, 1.0, 0.03);
}

}  // namespace
}  // namespace aspic::reference

#pragma once
// Runs of the reference, and what tests look at in the state they end with.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "cpu_reference/reference_solver.h"
#include "model/terrain.h"

namespace aspic::test {

inline std::unique_ptr<Solver> solver_for(const Model& model, Precision precision = Precision::double_) {
  auto solver = make_reference_solver(model, precision);
  EXPECT_TRUE(solver.ok());
  return std::move(solver).value();
}

/// The state after further steps, none of which diverges.
inline State advanced(Solver& solver, std::uint64_t steps) {
  const auto divergence = solver.advance(steps)->divergence;
  EXPECT_FALSE(divergence.has_value());
  return *solver.state();
}

inline State after(const Model& model, std::uint64_t steps, Precision precision = Precision::double_) {
  return advanced(*solver_for(model, precision), steps);
}

inline void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_LE(length(a - b), tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " and " << b.x << ' ' << b.y << ' ' << b.z;
}

/// Speed of the fastest particle [m/s].
inline double fastest(const State& state) {
  double most = 0.0;
  for (const Vec3& v : state.velocity) most = std::max(most, length(v));
  return most;
}

/// How far the nearest `count` particles are from the terrain, at most [m].
inline double layer(const Terrain& terrain, const State& state, std::size_t count) {
  std::vector<double> gaps;
  for (const Vec3& x : state.position) gaps.push_back(signed_distance(terrain, x));
  std::sort(gaps.begin(), gaps.end());
  return std::max(-gaps.front(), gaps[count - 1]);
}

/// Balls alone in space without gravity or spin, every contact fully elastic.
inline ModelSettings weightless() {
  ModelSettings settings;
  settings.simulation.gravity = {};
  settings.contact.spin = false;
  return settings;
}

}  // namespace aspic::test

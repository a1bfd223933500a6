// The ground inside implicit Euler's equation: P of one, two and three terrains, its derivative, and that the
// solve ends at a solution.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>
#include <span>
#include <utility>

#include "cpu_reference/all_forces.h"
#include "cpu_reference/implicit_euler.h"
#include "cpu_reference/phase.h"
#include "model/terrain.h"
#include "physics/terrain/implicit.h"
#include "support/epsilon.h"
#include "support/model_building.h"

namespace aspic::reference {
namespace {

using V = Vector<double>;
using test::eps;
constexpr double h = 1.0 / 60.0, mass = 2.0;

Terrain plane(const Vec3& point, const Vec3& normal, double mu, double e = 0.8) {
  TerrainSettings settings;
  settings.geometry["point"] = point;
  settings.geometry["normal"] = normal;
  settings.friction = mu;
  settings.restitution = e;
  return make_terrain(settings, ContactSettings{});
}

/// ε = 0.01 m.
ContactConstants<double> contact_constants() {
  Model model;
  model.simulation.timestep = h;
  return ContactConstants<double>(model);
}

/// A particle of 2 kg at `x` in front of these terrains.
class Ahead {
 public:
  Ahead(const std::vector<Terrain>& terrain, const V& x)
      : grounds_(terrain.begin(), terrain.end()), ahead_(grounds_, contact_constants(), true) {
    for (const Ground<double>& ground : grounds_) gaps.push_back(gap<double>(ground, x));
    ahead_.start(Field<double>(x));
  }
  Ahead(const Ahead&) = delete;
  Ahead& operator=(const Ahead&) = delete;

  GroundReaction<double> react(const V& v) const { return ahead_.react(0, mass, v); }
  double least_speed(std::size_t t) const { return -std::max(gaps[t].d, 0.0) / h; }

  std::vector<Gap<double>> gaps;

 private:
  std::vector<Ground<double>> grounds_;
  GroundAhead<double> ahead_;
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number() { return some_(engine_); }
  V vector() { return {number(), number(), number()}; }
  /// A terrain through a point a few millimeters below the origin, upwards more often than not.
  Terrain terrain(double mu) {
    const V n = (vector() + V(0, 1.2, 0)).normalized();
    const V p = -0.004 * std::abs(number()) * n;
    return plane({p.x(), p.y(), p.z()}, {n.x(), n.y(), n.z()}, mu);
  }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> some_;
};

TEST(GroundReaction, OfOneTerrainIsTheProjectionOfTheRule) {
  Random random(11);
  int held = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const double mu = std::abs(random.number());
    const Ahead ahead({random.terrain(mu)}, V::Zero());
    const V v = random.vector();
    const GroundReaction<double> reaction = ahead.react(v);
    EXPECT_EQ(reaction.v, projected<double>(mu, ahead.gaps[0].n, ahead.least_speed(0), v));
    EXPECT_EQ(reaction.count == 0, reaction.freedom == Freedom::all);
    held += reaction.holds(0);
  }
  EXPECT_GT(held, 300);
  EXPECT_LT(held, 900);
}

// Central differences of P against the derivative that the matrix takes: 1 along the slip, the turn across
// it. The derivative along the normal, friction's growth with the load, is left out by intent.
TEST(GroundReaction, KnowsItsDerivativeWhereItLeavesFreedom) {
  Random random(12);
  const double step = 1e-6;
  int planes = 0, lines = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const double mu = 0.3 * std::abs(random.number());
    const Ahead ahead({random.terrain(mu), random.terrain(mu)}, V::Zero());
    const V v = random.vector();
    const GroundReaction<double> at = ahead.react(v);
    const auto derivative = [&](const V& d) -> V {
      return (ahead.react(v + step * d).v - ahead.react(v - step * d).v) / (2 * step);
    };
    const auto same = [&](const V& d) {  // not next to a kink
      return ahead.react(v + 2 * step * d).freedom == at.freedom &&
             ahead.react(v - 2 * step * d).freedom == at.freedom;
    };
    if (at.freedom == Freedom::line && same(at.axis)) {
      EXPECT_LE((derivative(at.axis) - at.axis).norm(), 1e-8);
      ++lines;
    }
    const double turn = 1.0 / (1.0 + at.stiffness / mass);
    if (at.freedom != Freedom::plane || turn < 2 * least_turn || !same(at.across)) continue;
    // Third derivatives are of the order 1/slip³, which a turn above 2·least_turn bounds only by this.
    const double slip = at.free_part(v).norm();
    const double allowed = 1e-8 + step * step / (slip * slip);
    EXPECT_LE((derivative(at.across) - turn * at.across).norm(), allowed);
    const V along = at.across.cross(at.axis);
    EXPECT_LE((derivative(along) - along).norm(), allowed);
    EXPECT_NEAR(at.across.norm(), 1.0, 4 * eps);
    EXPECT_LE(std::abs(at.across.dot(at.free_part(v))), 8 * eps);
    ++planes;
  }
  EXPECT_GT(planes, 200);
  EXPECT_GT(lines, 50);
}

// Without friction P is the nearest velocity that crosses no surface: it crosses none, and what it adds to v
// is a sum of pushes, along the normals of those it holds, none of which pulls.
TEST(GroundReaction, WithoutFrictionIsTheNearestVelocityThatCrossesNothing) {
  Random random(13);
  std::array<int, 4> seen{};
  for (int trial = 0; trial < 4000; ++trial) {
    const Ahead ahead({random.terrain(0.0), random.terrain(0.0), random.terrain(0.0)}, V::Zero());
    const V v = random.vector() - V(0, 1, 0);
    const GroundReaction<double> at = ahead.react(v);
    ++seen[at.count];
    const double size = 100 * eps * (1.0 + v.norm()) / least_wedge;  // the worst wedge that is taken for one
    for (std::size_t t = 0; t < 3; ++t) EXPECT_GE(at.v.dot(ahead.gaps[t].n), ahead.least_speed(t) - size);
    if (at.count == 0) continue;
    for (std::size_t k = 0; k < at.count; ++k) {
      EXPECT_NEAR(at.v.dot(ahead.gaps[at.held[k]].n), ahead.least_speed(at.held[k]), size);
    }
    // The change of v by a basis of the normals and of what is perpendicular to them.
    const V change = at.v - v, a = ahead.gaps[at.held[0]].n;
    const V b = at.count > 1 ? V(ahead.gaps[at.held[1]].n) : a.unitOrthogonal();
    const V c = at.count > 2 ? V(ahead.gaps[at.held[2]].n) : a.cross(b).normalized();
    V rest = change;
    const std::array<std::pair<V, V>, 3> normals = {{{a, b.cross(c)}, {b, c.cross(a)}, {c, a.cross(b)}}};
    for (const auto& [n, across] : std::span(normals).first(at.count)) {
      const double push = change.dot(across) / n.dot(across);
      EXPECT_GE(push, -size) << "held by " << at.count;
      rest -= push * n;
    }
    EXPECT_LE(rest.norm(), size);
  }
  EXPECT_GT(seen[1], 500);
  EXPECT_GT(seen[2], 200);
  EXPECT_GT(seen[3], 20);
}

// A groove at any angle stops a particle that falls into it: the sequence of both planes' projections would
// not.
TEST(GroundReaction, AGrooveOfAnyAngleStopsAFall) {
  for (const double slope : {0.05, 0.3, 1.0, 3.0, 20.0}) {
    const Ahead ahead({plane({}, {slope, 1, 0}, 0.0), plane({}, {-slope, 1, 0}, 0.0)}, V::Zero());
    const GroundReaction<double> at = ahead.react(V(0.0, -3.0, 0.5));
    EXPECT_EQ(at.freedom, Freedom::line);
    EXPECT_LE((at.v - V(0, 0, 0.5)).norm(), 200 * eps * 3.0 * (1.0 + slope * slope) / slope) << slope;
  }
}

TEST(GroundReaction, TwiceTheSameTerrainIsOne) {
  const Terrain slope = plane({}, {0.3, 1, 0.1}, 0.2);
  const Ahead once({slope}, V(0, 0.01, 0)), twice({slope, slope}, V(0, 0.01, 0));
  const V v(1.0, -3.0, 0.5);
  EXPECT_EQ(once.react(v).v, twice.react(v).v);
  EXPECT_EQ(twice.react(v).freedom, Freedom::plane);
}

/// A squashed, sheared 4³ cube thrown into the corner of a slope and two walls.
Model cube_in_a_corner(double mu) {
  ModelSettings settings = test::cube_on_plane(4, 2.8);
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = h;
  settings.simulation.implicit.newton_iterations = 200;
  settings.contact.friction = mu;
  settings.contact.restitution = 0.2;
  settings.terrain.resize(3);
  settings.terrain[0].geometry["point"] = Vec3{0, 0, 0};
  settings.terrain[0].geometry["normal"] = Vec3{0.3, 1, 0.1};
  settings.terrain[1].geometry["point"] = Vec3{2.7, 0, 0};
  settings.terrain[1].geometry["normal"] = Vec3{-1, 0.35, 0};
  settings.terrain[2].geometry["point"] = Vec3{0, 0, 2.1};
  settings.terrain[2].geometry["normal"] = Vec3{0, 0, -1};
  Model model = test::build(settings);
  for (std::size_t i = 0; i < model.initial_position.size(); ++i) {
    const Vec3 x = model.initial_position[i];
    model.initial_position.set(i, {1.1 * x.x + 0.1 * (x.y - 2.8), 0.9 * x.y + 0.28, x.z});
  }
  model.initial_velocity.assign(model.particle_count(), {3.0, -6.0, 2.0});
  return model;
}

// v' = P(v + h·a(x + h·v', v')), with a of the explicit methods' code, for every particle, in steps that
// press it into three terrains; what is held is at the surface exactly.
TEST(ImplicitGround, SolvesTheEquationWithTheGroundInIt) {
  for (const double mu : {0.0, 0.15, 0.3}) {
    const Model model = cube_in_a_corner(mu);
    const Dynamics<double> dynamics(model);
    ImplicitEuler<double> method(dynamics, model);
    GroundAhead<double> ahead(dynamics.grounds(), dynamics.contact(), true);
    Phase<double> s = start_of(model);
    std::array<int, 4> seen{};
    for (int n = 0; n < 120; ++n) {
      SolveReport report;
      Phase<double> next = method.step(s, report);
      ASSERT_EQ(report.end, SolveEnd::converged) << "step " << n << ", μ = " << mu;
      ahead.start(s.x);
      const Field<double> a = test::AllForces(dynamics).acceleration(s.x + h * next.v, next.v);
      for (Eigen::Index i = 0; i < s.x.cols(); ++i) {
        const GroundReaction<double> wanted = ahead.react(i, dynamics.mass(i), s.v.col(i) + h * a.col(i));
        ++seen[wanted.count];
        // The tolerance, 1e-9 m/s, and what moving held particles by it exactly changes in others' forces:
        // each of up to 18 springs at both ends has along + across ≤ 2·(h²k + hc)/m = 3.2.
        EXPECT_LE((next.v.col(i) - wanted.v).cwiseAbs().maxCoeff(), 1e-9 * (1 + 18 * 2 * 3.2));
        for (std::size_t k = 0; k < wanted.count; ++k) {
          const Gap<double> at = gap<double>(dynamics.grounds()[wanted.held[k]], next.x.col(i));
          EXPECT_LE(std::abs(at.d), 1e-13) << "step " << n;
        }
      }
      method.respond(s, next);
      s = next;
    }
    EXPECT_GT(seen[1], 100) << mu;
    EXPECT_GT(seen[2], 10) << mu;
  }
}

// The solve stopped it; how fast it came is known from free fall alone.
TEST(ImplicitGround, OnlyAFastParticleThatIsHeldBounces) {
  Model model = test::particles({{0, 0, 0}, {1, 0.02, 0}, {2, 0.02, 0}, {3, 5, 0}},
                                {{0.2, -0.3, 0}, {0.2, -3, 0}, {0.2, -1, 0}, {0.2, -3, 0}});
  model.simulation.integrator = Integrator::implicit_euler;
  model.simulation.timestep = h;
  model.terrain = {plane({}, {0, 1, 0}, 0.0, 0.5)};
  const Dynamics<double> dynamics(model);
  ImplicitEuler<double> method(dynamics, model);
  const Phase<double> s = start_of(model);
  SolveReport report;
  Phase<double> end = method.step(s, report);
  method.respond(s, end);
  const double fall = 9.8 * h;  // v_rest = 2·fall = 0.327
  EXPECT_EQ(end.v(1, 0), 0.0) << "slow: it rests";
  EXPECT_EQ(end.x(1, 0), 0.0);
  // It meets the surface after s = d0/(h(3 + fall)) of the step at −3 − (s + ½)·fall in the mean velocity's
  // measure.
  const double share = 0.02 / (h * (3.0 + fall));
  EXPECT_NEAR(end.v(1, 1), 0.5 * (3.0 + fall + (share - 0.5) * fall) + 0.5 * fall, 16 * eps * 3);
  EXPECT_NEAR(end.x(1, 1), 0.0, eps);
  EXPECT_EQ(end.v(0, 1), 0.2) << "no friction";
  EXPECT_NEAR(end.v(1, 2), -1.0 - fall, 4 * eps) << "it does not reach the surface";
  EXPECT_NEAR(end.v(1, 3), -3.0 - fall, 4 * eps);
}

}  // namespace
}  // namespace aspic::reference

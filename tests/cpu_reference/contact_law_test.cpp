// Contact between bodies, formula by formula: the nearest place of a triangle, the faces in contact with a
// point, the normal force as the gradient of its energy, the sums. What it makes of bodies is in
// body_contact_test.cpp.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "cpu_reference/bodies_in_contact.h"
#include "support/epsilon.h"

namespace aspic::reference {
namespace {

using V = Vector<double>;
using Contact = BodyContact<double>;
using test::cube_of;
using test::eps;
using test::random_vector;
using test::spacing;
using test::view_of_fields;

// Against the definition: no place of the triangle is nearer, and e is along the normal in a face, across the
// edge on an edge.
TEST(NearestPlace, IsNearestOfAll) {
  std::mt19937 random(3);
  std::array<int, 2> seen = {};
  for (int trial = 0; trial < 2000; ++trial) {
    const V A = random_vector(random, 1.0), B = random_vector(random, 1.0), C = random_vector(random, 1.0),
            P = random_vector(random, 1.5);
    const NearestPlace<double> q = nearest_place<double>(P, A, B, C);
    EXPECT_GE(q.b, 0.0);
    EXPECT_GE(q.c, 0.0);
    EXPECT_LE(q.b + q.c, 1.0 + 4 * eps);
    const auto place = [&](double b, double c) { return V(A + b * (B - A) + c * (C - A)); };
    const double L = (P - place(q.b, q.c)).norm();
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; i + j <= 20; ++j) EXPECT_LE(L, (P - place(i / 20.0, j / 20.0)).norm() + 1e-12);
    const V g = area_normal<double>(A, B, C);
    if (q.face) {
      EXPECT_NEAR((P - place(q.b, q.c)).cross(g).norm() / g.norm(), 0.0, 1e-9);
    }
    ++seen[q.face];
  }
  EXPECT_GT(seen[0], 100);
  EXPECT_GT(seen[1], 100);
}

TEST(ClosedGap, ReachesOutsideAndFartherInside) {
  const V A(0, 0, 0), B(1, 0, 0), C(0, 0, -1);  // faces up
  const auto gap = [&](const V& P) {
    return closed_gap<double>(closest_point<double>(0, 0, face_of<double>(A, B, C), P), 0.1, 1.0);
  };
  EXPECT_EQ(gap({0.2, 0.05, -0.2})->d, 0.05);
  EXPECT_EQ(gap({0.2, 0.05, -0.2})->n, V(0, 1, 0));
  EXPECT_FALSE(gap({0.2, 0.1, -0.2}));
  EXPECT_EQ(gap({0.2, -1.0, -0.2})->d, -1.0);
  EXPECT_FALSE(gap({0.2, -1.001, -0.2}));
  // Off an edge the normal points from the edge to the point; inside, the other way.
  EXPECT_NEAR((gap({-0.03, 0.04, -0.2})->n - V(-0.6, 0.8, 0)).norm(), 0.0, 4 * eps);
  EXPECT_NEAR(gap({-0.03, -0.04, -0.2})->d, -0.05, eps);
  EXPECT_NEAR((gap({-0.03, -0.04, -0.2})->n - V(0.6, 0.8, 0)).norm(), 0.0, 4 * eps);
  EXPECT_FALSE(gap({-0.04, -0.03, -0.2})) << "beside the face rather than behind it";
}

TEST(OpenGap, RepelsToTheSideWhereThePointIs) {
  const V A(0, 0, 0), B(1, 0, 0), C(0, 0, -1);
  const auto gap = [&](const V& P) {
    return open_gap<double>(closest_point<double>(0, 0, face_of<double>(A, B, C), P), 0.25);
  };
  EXPECT_EQ(gap({0.2, -0.05, -0.2})->d, 0.05);
  EXPECT_EQ(gap({0.2, -0.05, -0.2})->n, V(0, -1, 0));
  EXPECT_EQ(gap({0.2, 0.05, -0.2})->n, V(0, 1, 0));
  EXPECT_FALSE(gap({0.2, -0.25, -0.2}));
}

// Of two triangles that share the nearest edge the one that faces the point counts, whatever their order.
TEST(NearestOf, TiesGoToTheOneStraightInFront) {
  const V A(0, 0, 0), B(1, 0, 0), C(1, 0, -1), D(1, -1, 0), P(0.5, 0.06, 0.02);
  const auto of = [&](std::uint32_t n, const V& a, const V& b, const V& c) {
    return closest_point<double>(n, n, face_of<double>(a, b, c), P);
  };
  const auto all = [](const ClosestPoint<double>&) { return true; };
  const std::vector<ClosestPoint<double>> closest = {of(0, A, D, B), of(1, A, B, C)};
  const std::vector<ClosestPoint<double>> other = {of(1, A, B, C), of(0, A, D, B)};
  EXPECT_NEAR(closest[0].L, closest[1].L, 1e-12);
  EXPECT_EQ(nearest_of<double>(closest, 1e-6, all)->triangle, 1u);
  EXPECT_EQ(nearest_of<double>(other, 1e-6, all)->triangle, 1u);
}

// In a crease both faces are straight in front; rounding of |z|/L must not decide.
TEST(NearestOf, FacesThatAreEquallyNearGoByDistance) {
  ClosestPoint<double> left, right;
  left = {0, 0, {0.2, 0.2, true}, V(0, 1, 0), 1.0, V(0, 1, 0), 1.0};
  right = {1, 1, {0.2, 0.2, true}, V(0, 1 - 1e-7, 0), 1.0 - 1e-7, V(0, 1, 0), 1.0 - 2e-7};
  const auto all = [](const ClosestPoint<double>&) { return true; };
  EXPECT_EQ(nearest_of<double>(std::vector{left, right}, 1e-6, all)->triangle, 1u);
  EXPECT_EQ(nearest_of<double>(std::vector{right, left}, 1e-6, all)->triangle, 1u);
}

/// Two 3³ cubes far apart, and the same in random poses that overlap.
class Poses : public testing::Test {
 protected:
  Poses() {
    settings_ = test::contact_scene({cube_of(3, {}), cube_of(3, {100, 0, 0})});
    settings_.contact.body_damping = 0.0;
    settings_.contact.body_friction = 0.0;
  }
  Field<double> pose(std::mt19937& random) const {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const V shift = 2.2 * spacing * V(uniform(random), uniform(random), uniform(random));
    const Eigen::AngleAxisd turn(3.0 * uniform(random), random_vector(random, 1.0).normalized());
    Field<double> x(3, 54);
    for (Eigen::Index i = 0; i < 54; ++i) {
      const Eigen::Index n = i % 27;
      const V place = spacing * V(double(n / 9) - 1, double(n / 3 % 3) - 1, double(n % 3) - 1);
      x.col(i) = (i < 27 ? place : V(shift + turn * place)) + random_vector(random, 0.03 * spacing);
    }
    return x;
  }
  ModelSettings settings_;
};

TEST_F(Poses, PushIsTheGradientOfItsEnergy) {
  const Model model = test::build(settings_);
  Contact contact(model);
  const double scale = 7.3125 * 2000.0 * 0.1 * spacing;  // k·ρ
  std::mt19937 random(1);
  const Field<double> v = Field<double>::Zero(3, 54);
  int poses = 0, compared = 0;
  while (poses < 1000) {
    Field<double> x = pose(random);
    contact.begin_step(0, view_of_fields(x, v));
    if (!contact.find(view_of_fields(x, v))) continue;
    ++poses;
    const auto contacts = [&] { return contact.contacts().size(); };
    const std::size_t count = contacts();
    const std::vector<std::uint32_t> particles(contact.particles().begin(), contact.particles().end());
    std::vector<V> f(particles.size(), V::Zero());
    contact.add_forces(
        view_of_fields(x, v), [](std::uint32_t) { return 1.0; }, f);
    V sum = V::Zero(), turn = V::Zero();
    for (std::size_t n = 0; n < f.size(); ++n) {
      sum += f[n];
      turn += V(x.col(particles[n])).cross(f[n]);
    }
    EXPECT_LE(sum.norm(), 1e-12 * scale * double(count));
    EXPECT_LE(turn.norm(), 1e-12 * scale * double(count));
    const std::size_t n = random() % particles.size();
    const double e = 1e-6 * spacing;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      std::array<double, 2> energy;
      bool same = true;
      for (const int way : {0, 1}) {
        Field<double> moved = x;
        moved(axis, particles[n]) += way ? e : -e;
        contact.find(view_of_fields(moved, v));
        same = same && contacts() == count;
        energy[static_cast<std::size_t>(way)] = contact.energy();
      }
      if (!same) continue;  // a contact began or ended between the two
      EXPECT_NEAR(-(energy[1] - energy[0]) / (2 * e), f[n][axis], 1e-7 * scale);
      ++compared;
    }
  }
  EXPECT_GT(compared, 2500);
}

// Friction divides masses so that no pass of it adds kinetic energy, and keeps within the cone.
TEST_F(Poses, FrictionTakesEnergyAndKeepsMomentum) {
  settings_.contact.body_friction = 0.4;
  const Model model = test::build(settings_);
  Contact contact(model);
  std::mt19937 random(2);
  int poses = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const Field<double> x = pose(random);
    Field<double> v(3, 54);
    for (Eigen::Index i = 0; i < 54; ++i) v.col(i) = random_vector(random, 0.3);
    contact.begin_step(0, view_of_fields(x, v));
    if (!contact.find(view_of_fields(x, v))) continue;
    ++poses;
    const double h = model.simulation.timestep;
    std::vector<V> f(contact.particles().size(), V::Zero());
    std::vector<V> before = f;
    contact.add_forces(
        view_of_fields(x, v), [](std::uint32_t) { return 1.0; }, f);
    spread<double>(contact.contacts(), before,
                   [](const ContactPoint<double>& t) { return V(t.normal_force * t.n); });
    double gained = 0.0, normal_forces = 0.0;
    V sum = V::Zero();
    for (std::size_t n = 0; n < f.size(); ++n) {
      const V v_0 = v.col(contact.particles()[n]);
      gained += (v_0 + h * f[n]).squaredNorm() - (v_0 + h * before[n]).squaredNorm();
      sum += f[n];
    }
    for (const ContactPoint<double>& point : contact.contacts()) {
      EXPECT_LE(point.friction.norm(), 0.4 * point.normal_force * (1.0 + 8 * eps));
      EXPECT_NEAR(point.friction.dot(point.n), 0.0, 1e-12 * (1.0 + point.normal_force));
      normal_forces += point.normal_force;
    }
    EXPECT_LE(gained, 1e-12);
    EXPECT_LE(sum.norm(), 64 * eps * normal_forces);
  }
  EXPECT_GT(poses, 40);
}

// What reads no order: every contact is evaluated by itself, and sums run by particle.
TEST(ContactSums, RunCarriersFirstThenCorners) {
  ContactPoint<float> first, second;
  for (ContactPoint<float>* point : {&first, &second}) {
    point->carriers = 1;
    point->weight = {1.0f, 0.0f, 0.5f, 0.25f, 0.25f};
    point->n = Vector<float>(0, 1, 0);
  }
  first.place = {1, 1, 0, 2, 3};   // particle 0 is a corner of the first contact
  second.place = {0, 0, 1, 2, 3};  // and carries the second
  first.normal_force = 1e8f;
  second.normal_force = 3.0f;
  const std::array contacts = {first, second};
  std::vector<Vector<float>> f(4, Vector<float>(0, 1, 0));
  spread<float>(contacts, f,
                [](const ContactPoint<float>& t) { return Vector<float>(t.normal_force * t.n); });
  EXPECT_EQ(f[0].y(), (1.0f + 3.0f) - 5e7f);
  EXPECT_EQ(f[1].y(), (1.0f + 1e8f) - 1.5f);
}

}  // namespace
}  // namespace aspic::reference

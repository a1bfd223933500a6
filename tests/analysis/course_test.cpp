#include "analysis/course.h"

#include <gtest/gtest.h>

namespace aspic {
namespace {

/// Two particles of a body above the plane y = 0.
Model two_particles() {
  Model model;
  model.initial_position = Places(std::vector<Vec3>{{0, 1, 0}, {0, 3, 0}});
  model.initial_velocity = std::vector<Vec3>(2);
  model.mass = std::vector<double>{3.0, 1.0};
  model.inverse_mass = std::vector<double>{1.0 / 3.0, 1.0};
  Body body;
  body.particle_count = 2;
  model.bodies.push_back(body);
  model.terrain.push_back({});
  model.simulation.timestep = 0.5;
  return model;
}

State at(std::uint64_t step, const Vec3& lower, const Vec3& upper, double speed = 0.0) {
  State state;
  state.step = step;
  state.position = {lower, upper};
  state.velocity = {{speed, 0, 0}, {}};
  return state;
}

TEST(Course, TellsSquashSlideContactAndRest) {
  const Model model = two_particles();
  Course course(model);
  course.take(at(0, {0, 1, 0}, {0, 3, 0}, 1.0));
  course.take(at(1, {4, 0.5, 0}, {4, 2.5, 0}, 0.0));   // slow by chance
  course.take(at(2, {5, 0.0, 0}, {5, 1.5, 0}, 2.0));   // touches
  course.take(at(3, {8, 0.0, 4}, {8, 2.0, 4}, 0.02));  // 3 and 4 m on
  course.take(at(4, {8, 0.0, 4}, {8, 2.0, 4}, 0.009));
  course.take(at(5, {8, 0.0, 4}, {8, 2.0, 4}, 0.0));
  const CourseSummary summary = course.summary();
  EXPECT_EQ(summary.end.time, 2.5);
  EXPECT_EQ(summary.end.height, 0.5);  // of 3 kg at 0 and 1 kg at 2 m
  EXPECT_EQ(summary.end.lowest, 0.0);
  EXPECT_EQ(summary.squash, 0.25);
  EXPECT_EQ(summary.squash_time, 1.0);
  EXPECT_EQ(summary.contact_time, 1.0);
  EXPECT_EQ(summary.end.slide, 5.0);
  EXPECT_EQ(summary.rest_time, 2.0);
}

TEST(Course, MotionAtTheEndIsNoRest) {
  const Model model = two_particles();
  Course course(model);
  course.take(at(0, {0, 1, 0}, {0, 3, 0}, 0.0));
  course.take(at(1, {0, 1, 0}, {0, 3, 0}, 1.0));
  EXPECT_EQ(course.summary().rest_time, std::nullopt);
  EXPECT_EQ(course.summary().contact_time, std::nullopt);
  EXPECT_EQ(course.summary().squash, 0.0);
}

TEST(Course, UpIsAgainstGravity) {
  Model model = two_particles();
  model.simulation.gravity = {-2.0, 0.0, 0.0};
  Course course(model);
  course.take(at(0, {1, 0, 0}, {5, 0, 0}));
  EXPECT_EQ(course.summary().end.height, 2.0);
  EXPECT_EQ(course.samples().front().extent, 4.0);
}

TEST(SampleStride, IsBoundedWithTinyTimeSteps) {
  EXPECT_EQ(sample_stride(0.01, 0.1), 10u);
  EXPECT_EQ(sample_stride(1.0, 0.1), 1u);
  for (const double h : {5e-21, 9e-22, 1e-300}) EXPECT_EQ(sample_stride(h, 0.1), std::uint64_t{1} << 62) << h;
}

}  // namespace
}  // namespace aspic

#include "report/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "aspic/scene.h"

namespace aspic::report {
namespace {

Study study(std::function<bool()> stop = {}) {
  return Study(load_scene("cube-plane").value(), "cube-plane", false, 3, std::move(stop));
}

TEST(Study, RunsEveryTaskOnce) {
  std::vector<std::atomic<int>> done(100);
  const Status status = study().each(done.size(), [&](std::size_t i) -> Status {
    ++done[i];
    return {};
  });
  EXPECT_TRUE(status.ok());
  for (const auto& count : done) EXPECT_EQ(count, 1);
}

TEST(Study, BoundsTheStepsOfARun) {
  Scene scene = load_scene("cube-plane").value();
  scene.model.simulation.timestep = 1e-9;
  const Model model = build_model(scene.model).value();
  const auto steps = [&](bool thorough) {
    return Study(scene, "cube-plane", thorough, 1, {}).longest_run(model) / 1e-9;
  };
  EXPECT_GT(steps(false), 4000.0);
  EXPECT_LT(steps(false), 1e6);
  EXPECT_GT(steps(true), 4e9);
}

TEST(Study, EndsWithTheErrorOfATask) {
  const Status status = study().each(1000, [](std::size_t i) -> Status {
    if (i == 3) return fail(ErrorCode::diverged, "task {}", i);
    return {};
  });
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message(), "task 3");
}

TEST(Study, StopsWhenToldTo) {
  std::atomic<int> tasks = 0;
  const Status status = study([&] { return tasks >= 5; }).each(1000, [&](std::size_t) -> Status {
    ++tasks;
    return {};
  });
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::interrupted);
  EXPECT_LE(tasks, 7);  // each of the other threads may have passed the question before
}

TEST(Study, TimesOfALandingAreWithinTheRun) {
  CourseSummary summary;
  summary.contact_time = 1.0;
  summary.squash_time = 1.1;
  const auto times = telling_times(summary, 1.5);
  EXPECT_THAT(times,
              testing::ElementsAre(1.0, testing::DoubleNear(1.1, 1e-12), testing::DoubleNear(1.2, 1e-12),
                                   testing::DoubleNear(1.35, 1e-12), 1.5));
  EXPECT_THAT(telling_times({}, 5.0), testing::ElementsAre(0.0, 1.0, 2.0, 3.0, 4.0, 5.0));
}

TEST(Study, FramedViewHoldsEveryParticle) {
  State state;
  state.position = {{-3, 0, 0}, {5, 2, 1}, {0, 7, -2}};
  const ViewSettings view = framed({}, std::span(&state, 1));
  const Vec3 axis = view.camera.target - view.camera.position;
  for (const Vec3& x : state.position) {
    const Vec3 d = x - view.camera.position;
    const double cosine = dot(d, axis) / (length(d) * length(axis));
    EXPECT_LE(std::acos(cosine) * 180.0 / 3.14159265358979, view.camera.fov / 2);
  }
}

TEST(Trial, KeepsImagesNearTheirTimesAndFiguresOfTheEnd) {
  const Study s = study();
  Model model = build_model(s.scene.model).value();
  const std::vector<double> times = {0.0, 0.01, 0.0237};
  const auto result = s.run(model, 0.05, times);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->outcome, Outcome::ok);
  EXPECT_EQ(result->steps, 50u);
  ASSERT_EQ(result->images.size(), 3u);
  EXPECT_EQ(result->images[0].step, 0u);
  EXPECT_EQ(result->images[1].step, 10u);
  EXPECT_EQ(result->images[2].step, 24u);
  EXPECT_EQ(result->samples.back().time, 0.05);
}

TEST(Trial, ADivergenceIsAnOutcome) {
  const Study s = study();
  Model model = build_model(s.scene.model).value();
  model.simulation.timestep = 0.01;
  const auto result = s.run(model, 2.0);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->outcome, Outcome::diverged);
  EXPECT_THAT(result->reason, testing::HasSubstr("became faster than 1000 m/s in step"));
  EXPECT_TRUE(result->summary.has_value());
}

}  // namespace
}  // namespace aspic::report

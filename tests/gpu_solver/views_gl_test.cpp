// States go in and out of every backend through views, with the same bits as by State.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <new>
#include <span>

#include "cpu_parallel/cpu_solver.h"
#include "cpu_reference/reference_solver.h"
#include "device/particles.h"
#include "gpu_solver/gpu_solver.h"
#include "model/reading.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace {
thread_local std::size_t largest_allocation = 0;  // [bytes]
}  // namespace

void* operator new(std::size_t bytes) {
  largest_allocation = std::max(largest_allocation, bytes);
  if (void* const made = std::malloc(bytes)) return made;
  throw std::bad_alloc();
}
void operator delete(void* made) noexcept {
  std::free(made);
}
void operator delete(void* made, std::size_t) noexcept {
  std::free(made);
}

namespace aspic {
namespace {

class Views : public aspic::testing::GlTest {
 protected:
  Views() {
    ModelSettings settings = test::low_cube(5, Integrator::midpoint, ContactModel::coulomb);
    settings.balls.resize(2);
    model_ = shared(test::build(settings));
    solvers_.push_back(std::move(make_reference_solver(model_, Precision::single)).value());
    solvers_.push_back(std::move(make_reference_solver(model_, Precision::double_)).value());
    solvers_.push_back(std::move(make_cpu_solver(model_)).value());
    auto gpu = test::value_of(make_gpu_solver(context(), model_));
    gpu->set_late(true);
    solvers_.push_back(std::move(gpu));
  }
  SharedModel model_;
  std::vector<std::unique_ptr<Solver>> solvers_;
};

TEST_F(Views, ReadWhatStateHas) {
  for (const auto& solver : solvers_) {
    SCOPED_TRACE(solver->description());
    ASSERT_TRUE(solver->advance(40).ok());
    const State state = *solver->state();
    const std::size_t count = state.position.size();
    // Positions of a struct of eight floats, velocities as three arrays of doubles; balls are left out.
    std::vector<float> x(8 * count, -1.0f);
    std::vector<double> v(3 * count);
    StateView view;
    view[field_number("position")] = Strided<float>{x.data() + 4, count, 8};
    view[field_number("velocity")] = Strided<double>{v.data(), count, 1, static_cast<std::ptrdiff_t>(count)};
    const auto step = solver->read_into(view);
    ASSERT_TRUE(step.ok());
    EXPECT_EQ(*step, state.step);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_EQ(x[8 * i + 4 + c], static_cast<float>(state.position[i][static_cast<int>(c)]));
        ASSERT_EQ(v[c * count + i], state.velocity[i][static_cast<int>(c)]);
      }
      EXPECT_EQ(x[8 * i + 7], -1.0f);
    }
    float spin[6];
    StateView balls;
    balls[field_number("ball_angular_velocity")] = Strided<float>{spin, 2};
    ASSERT_TRUE(solver->read_into(balls).ok());
    EXPECT_EQ(spin[3], static_cast<float>(state.ball_angular_velocity[1].x));
    balls[field_number("position")] = Strided<float>{spin, 2};
    EXPECT_EQ(solver->read_into(balls).error().code, ErrorCode::usage);
  }
}

// More particles than a part of a read has.
TEST_F(Views, ReadLargeStatesWithoutACopyInBetween) {
  const SharedModel model = shared(test::particles(std::vector<Vec3>(gl::read_part_bytes / 32 + 1000),
                                                   std::vector<Vec3>(gl::read_part_bytes / 32 + 1000)));
  const auto gpu = std::move(make_gpu_solver(context(), model)).value();
  State start = initial_state(*model, Precision::single), read = start;
  for (std::size_t i = 0; i < start.position.size(); ++i) {
    const auto number = static_cast<double>(i);
    start.position[i] = {number, number + 0.25, number + 0.5};
    start.velocity[i] = {-number, 2 * number, 0.0};
  }
  ASSERT_TRUE(gpu->load(start).ok());
  const void* const place = read.position.data();
  largest_allocation = 0;
  ASSERT_TRUE(read_state(*gpu, read).ok());
  EXPECT_LT(largest_allocation, std::size_t{65536});
  EXPECT_EQ(read.position.data(), place);
  EXPECT_EQ(read, start);
}

TEST_F(Views, ReadAsImagesHaveThem) {
  for (const auto& solver : solvers_) {
    SCOPED_TRACE(solver->description());
    ASSERT_TRUE(solver->advance(40).ok());
    const State state = *solver->state();
    std::vector<layout::Particle> particles(model_->particle_count());
    std::vector<layout::Ball> balls(model_->ball_count());
    ASSERT_EQ(*read_packed(*solver, particles, balls), 40u);
    const auto bytes = [](const auto& items) {
      const auto all = std::as_bytes(std::span(items));
      return std::vector<std::byte>(all.begin(), all.end());
    };
    EXPECT_EQ(bytes(particles), bytes(packed_particles(*model_, state)));
    EXPECT_EQ(bytes(balls), bytes(packed_balls(*model_, state)));
  }
}

TEST_F(Views, LoadWhatTheyHold) {
  ASSERT_TRUE(solvers_[0]->advance(40).ok());
  const State start = *solvers_[0]->state();
  const std::size_t count = start.position.size();
  std::vector<float> x(3 * count);
  copy_vectors(vectors_of(start.position),
               Strided<float>{x.data(), count, 1, static_cast<std::ptrdiff_t>(count)});
  ConstStateView view = view_of(start);
  view[field_number("position")] =
      Strided<const float>{x.data(), count, 1, static_cast<std::ptrdiff_t>(count)};
  for (const auto& solver : solvers_) {
    SCOPED_TRACE(solver->description());
    ASSERT_TRUE(solver->load(view, 40).ok());
    State loaded = *solver->state();
    loaded.precision = start.precision;
    EXPECT_EQ(loaded, start);
    ConstStateView part = view;
    part[field_number("velocity")] = std::monostate();
    EXPECT_EQ(solver->load(part, 40).error().code, ErrorCode::usage);
    EXPECT_EQ(solver->state()->step, 40u);
  }
}

TEST_F(Views, LieWhereTheStateIs) {
  for (const auto& solver : solvers_) {
    SCOPED_TRACE(solver->description());
    ASSERT_TRUE(solver->advance(30).ok());
    const auto view = solver->view();
    if (solver->backend() == "gpu") {
      EXPECT_FALSE(view);
      continue;
    }
    ASSERT_TRUE(view);
    const State state = *solver->state();
    State seen;
    resize(seen, state.position.size(), state.ball_position.size());
    const StateView to = view_of(seen);
    for (std::size_t n = 0; n < to.size(); ++n) copy_vectors((*view)[n], to[n]);
    seen.step = state.step;
    seen.precision = state.precision;
    EXPECT_EQ(seen, state);
    // The same numbers in the same place: no copy was made.
    const auto again = solver->view();
    const auto place = [](const ConstVectors& vectors) -> const void* {
      if (const auto* floats = std::get_if<Strided<const float>>(&vectors)) return floats->data;
      return std::get<Strided<const double>>(vectors).data;
    };
    EXPECT_EQ(place((*view)[0]), place((*again)[0]));
  }
}

}  // namespace
}  // namespace aspic

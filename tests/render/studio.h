#pragma once
// A test with a renderer.
#include "cpu_parallel/cpu_solver.h"
#include "render/read_back.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"
#include "support/value_of.h"

namespace aspic::test {

class Studio : public testing::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    renderer_ = test::value_of(Renderer::create(context()));
  }
  void TearDown() override {
    renderer_.reset();
    GlTest::TearDown();
  }

  Renderer& renderer() { return *renderer_; }

  /// Draws a state and reads it back.
  Image draw(const Model& model, const State& state, const ImageOptions& options, int width = 640,
             int height = 360) {
    const Status taken = renderer_->set_model(model);
    EXPECT_TRUE(taken.ok());
    return test::draw(context(), *renderer_, state, options, width, height);
  }

  /// The image last drawn.
  std::vector<std::byte> read() { return read(*renderer_); }
  std::vector<std::byte> read(const Renderer& by) { return test::read(context(), by); }

 private:
  std::unique_ptr<Renderer> renderer_;
};

/// The state after some steps, the reference's by the backend that takes least time.
inline State after(const Model& model, std::uint64_t steps) {
  auto solver = make_cpu_solver(model, {.threads = 1});
  EXPECT_TRUE(solver.ok());
  EXPECT_TRUE((*solver)->advance(steps).ok());
  auto state = (*solver)->state();
  EXPECT_TRUE(state.ok());
  return std::move(*state);
}

}  // namespace aspic::test

#pragma once
// A test with a renderer.
#include "cpu_reference/reference_solver.h"
#include "gpu/pixel_ring.h"
#include "render/image_comparison.h"
#include "render/renderer.h"
#include "support/gl_fixture.h"
#include "support/model_building.h"

namespace aspic::test {

class Studio : public testing::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    auto renderer = Renderer::create(context());
    ASSERT_TRUE(renderer.ok()) << renderer.error().message;
    renderer_ = std::move(*renderer);
  }
  void TearDown() override {
    renderer_.reset();
    GlTest::TearDown();
  }

  Renderer& renderer() { return *renderer_; }

  /// Draws a state and reads it back.
  Image draw(const Model& model, const State& state, const PictureOptions& options, int width = 640,
             int height = 360) {
    Image image{width, height, {}};
    const Status taken = renderer_->set_model(model);
    EXPECT_TRUE(taken.ok());
    const auto uploaded = renderer_->upload(state);
    EXPECT_TRUE(uploaded.ok());
    const Status drawn = renderer_->draw(width, height, *uploaded, options);
    EXPECT_TRUE(drawn.ok()) << (drawn.ok() ? "" : drawn.error().message);
    image.rgb = read();
    return image;
  }

  /// The picture last drawn.
  std::vector<std::byte> read() { return read(*renderer_); }
  std::vector<std::byte> read(const Renderer& by) {
    const gl::Framebuffer& picture = by.picture();
    auto ring = gl::PixelRing::create(context(), picture.width(), picture.height());
    EXPECT_TRUE(ring.ok());
    ring->submit(picture);
    std::vector<std::byte> rgb;
    EXPECT_TRUE(ring->take(rgb).ok());
    return rgb;
  }

 private:
  std::unique_ptr<Renderer> renderer_;
};

/// The state after some steps of the reference.
inline State after(const Model& model, std::uint64_t steps) {
  auto solver = make_reference_solver(model, Precision::single);
  EXPECT_TRUE(solver.ok());
  EXPECT_TRUE((*solver)->advance(steps).ok());
  auto state = (*solver)->state();
  EXPECT_TRUE(state.ok());
  return std::move(*state);
}

}  // namespace aspic::test

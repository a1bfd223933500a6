#pragma once
// Images of a renderer, read back.
#include <gtest/gtest.h>

#include "gpu/pixel_ring.h"
#include "render/renderer.h"
#include "support/image_comparison.h"

namespace aspic::test {

/// The image that a renderer drew last.
inline std::vector<std::byte> read(gl::Context& context, const Renderer& by) {
  const gl::Framebuffer& image = by.image();
  auto ring = gl::PixelRing::create(context, image.width(), image.height());
  EXPECT_TRUE(ring.ok());
  ring->submit(image);
  std::vector<std::byte> rgb;
  EXPECT_TRUE(ring->take(rgb).ok());
  return rgb;
}

/// A state of the renderer's model, drawn and read back.
inline Image draw(gl::Context& context, Renderer& renderer, const State& state, const ImageOptions& options,
                  int width, int height) {
  const auto uploaded = renderer.upload(state);
  EXPECT_TRUE(uploaded.ok());
  const Status drawn = renderer.draw(width, height, *uploaded, options);
  EXPECT_TRUE(drawn.ok()) << (drawn.ok() ? "" : drawn.error().message());
  return {width, height, read(context, renderer)};
}

}  // namespace aspic::test

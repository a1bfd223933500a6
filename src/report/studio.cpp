#include "report/studio.h"

#include <vector>

#include "gpu/current.h"
#include "gpu/pixel_ring.h"
#include "gpu/shader_source.h"

namespace aspic::report {

Result<std::unique_ptr<Studio>> Studio::open() {
  std::unique_ptr<Studio> studio(new Studio());
  ASPIC_TRY(studio->context_, gl::Context::create_headless());
  RendererOptions options;
  ASPIC_TRY(const auto directory, gl::shader_directory());
  options.shaders = gl::ShaderLibrary(directory);
  ASPIC_TRY(studio->renderer_, Renderer::create(*studio->context_, options));
  return studio;
}

Result<std::string> Studio::jpeg(const State& state, const ViewSettings& view, const ImageSize& size) {
  const gl::Current here(*context_);
  ASPIC_CHECK(here.status());
  ASPIC_TRY(const auto uploaded, renderer_->upload(state));
  ImageOptions options;
  options.view = view;
  options.legend = false;
  ASPIC_CHECK(renderer_->draw(size.width, size.height, uploaded, options));
  ASPIC_TRY(auto ring, gl::PixelRing::create(*context_, size.width, size.height));
  ring.submit(renderer_->image());
  std::vector<std::byte> rgb;
  ASPIC_CHECK(ring.take(rgb));
  return encode_jpeg(size, rgb);
}

}  // namespace aspic::report

#pragma once
// Still images of states, as JPEG.
#include <memory>
#include <string>

#include "aspic/scene.h"
#include "base/result.h"
#include "gpu/context.h"
#include "io/video_format.h"
#include "render/renderer.h"

namespace aspic::report {

class Studio {
 public:
  /// Draws in its own headless context. Errors: no_device, and those of Renderer::create.
  static Result<std::unique_ptr<Studio>> open();

  /// The next images show this model, which outlives them.
  Status set_model(const Model& model) { return renderer_->set_model(model); }
  /// A state of the model as the content of a JPEG file.
  Result<std::string> jpeg(const State& state, const ViewSettings& view, const ImageSize& size);
  /// GL_RENDERER.
  const gl::DeviceInfo& device() const { return context_->info(); }

 private:
  Studio() = default;
  std::shared_ptr<gl::Context> context_;  // goes last
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace aspic::report

#include <utility>

#include "base/result.h"
#include "gpu/pixel_ring.h"
#include "model/reading.h"
#include "render/run_view.h"
#include "run/window_host.h"

namespace aspic {

struct StillPainter::Parts {
  const Backend& backend;
  Scene scene;  // with the view of the latest image
  std::shared_ptr<gl::Context> own_context = nullptr;
  gl::Context* context = nullptr;
  std::unique_ptr<FramePainter> painter = nullptr;
  ImageSize size = {};
  std::vector<std::byte> scratch = {};
};

StillPainter::StillPainter(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
StillPainter::~StillPainter() = default;

Result<std::unique_ptr<StillPainter>> StillPainter::create(const Scene& scene, const Backend& backend) {
  auto parts = std::make_unique<Parts>(Parts{backend, scene});
  ASPIC_TRY(const FrameContext made, frame_context(backend));
  parts->own_context = made.own;
  parts->context = made.context;
  return std::unique_ptr<StillPainter>(new StillPainter(std::move(parts)));
}

Result<std::vector<std::byte>> StillPainter::draw(const ViewSettings& view, const ImageSize& size,
                                                  bool text) {
  Parts& p = *parts_;
  Solver& solver = *p.backend.solver;
  p.scene.view = view;
  if (!p.painter || p.size != size) {
    p.painter.reset();
    ASPIC_TRY(p.painter, FramePainter::create(*p.context, size, {{&p.scene, &solver.model()}}));
    p.size = size;
  }
  const Following following(p.scene, solver.model(), solver.precision());
  const GpuSolver* const gpu = gpu_of(p.backend);
  State copy;
  if (needs_copy(p.scene, following)) ASPIC_CHECK(read_state(solver, copy));
  DeviceState there;
  if (gpu) {
    there = gpu->device_state();
  } else {
    ASPIC_TRY(there, upload(p.painter->renderer(0), solver));
  }
  RunView shown = run_view(p.scene, following, solver, there.step, copy, {size, text});
  shown.ball_turns.assign(solver.model().ball_count(), BallTurn{0.0f, 0.0f, 0.0f, 1.0f});
  ASPIC_CHECK(p.painter->draw({there}, {std::move(shown)}));
  std::vector<std::byte> rgb(std::size_t{3} * static_cast<std::size_t>(size.width) *
                             static_cast<std::size_t>(size.height));
  ASPIC_CHECK(gl::read_rgb(*p.context, p.painter->frame(), p.scratch, rgb));
  ASPIC_CHECK(p.context->check());
  return rgb;
}

}  // namespace aspic

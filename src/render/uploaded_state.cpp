// States that are brought to the device to be drawn.
#include <cassert>
#include <cstring>
#include <utility>

#include "device/particles.h"
#include "gpu/current.h"
#include "render/renderer_parts.h"

namespace aspic {
namespace {

/// Particles that are kept in memory too, so that an image's moving part can be told.
constexpr std::size_t most_followed = 100000;

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), sizeof(T) * a.size()) == 0);
}

/// Uploads into a buffer that is made, or made larger, as needed.
template <class T>
Status refill(gl::Context& context, gl::Buffer& buffer, const char* name, const std::vector<T>& items) {
  const std::uint64_t bytes = sizeof(T) * items.size();
  if (buffer.id() == 0 || buffer.bytes() < bytes) {
    ASPIC_TRY(buffer, gl::Buffer::create(context, name, bytes));
  }
  buffer.upload_items(items);
  return {};
}

}  // namespace

Result<DeviceState> Renderer::upload(const State& state) {
  assert(parts_->model);
  return upload(packed_particles(*parts_->model, state), packed_balls(*parts_->model, state), state.step);
}

Result<DeviceState> Renderer::upload(std::vector<layout::Particle> particles, std::vector<layout::Ball> balls,
                                     std::uint64_t step) {
  Parts& p = *parts_;
  const gl::Current here(*p.context);
  ASPIC_CHECK(here.status());
  assert(p.model && particles.size() == p.model->particle_count() && balls.size() == p.model->ball_count());
  const DeviceState there = {&p.uploaded, &p.uploaded_balls, 0, step, nullptr};
  if (p.upload_is_whole && same_bytes(particles, p.uploaded_particles) &&
      same_bytes(balls, p.uploaded_ball_items))
    return there;
  p.upload_is_whole = false;
  ++p.uploads;
  p.uploaded_particles = std::move(particles);
  p.uploaded_ball_items = std::move(balls);
  ASPIC_CHECK(refill(*p.context, p.uploaded, "particles to draw", p.uploaded_particles));
  ASPIC_CHECK(refill(*p.context, p.uploaded_balls, "balls to draw", p.uploaded_ball_items));
  // To look at all of very many would take longer than it saves.
  if (p.uploaded_particles.size() > most_followed) p.uploaded_particles = {};
  p.upload_is_whole = true;
  return there;
}

}  // namespace aspic

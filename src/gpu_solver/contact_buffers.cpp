#include "gpu_solver/contact_buffers.h"

#include <algorithm>
#include <cmath>

#include "model/contact_surface.h"

namespace aspic {

using gl::Buffer;

Status ContactBuffers::build(gl::Context& context, const Model& model) {
  context_ = &context;
  model_ = &model;
  if (!has_body_contact(model)) return {};
  lists_ = std::make_unique<ContactLists>(model);
  ASPIC_TRY(triangles_, Buffer::of(context, "triangles of bodies", lists_->triangles()));
  return {};
}

void ContactBuffers::set_model(const Model& model) {
  model_ = &model;
  if (!any()) return;
  lists_ = std::make_unique<ContactLists>(model);
  fresh_ = false;
}

/// A buffer of this size or more; its contents are lost.
Status ContactBuffers::fit(Buffer& buffer, const char* name, std::uint64_t bytes) {
  if (buffer.bytes() >= bytes) return {};
  ASPIC_TRY(buffer, Buffer::create(*context_, name, bytes + bytes / 2));
  return {};
}

Status ContactBuffers::refresh(const Buffer& state) {
  const auto particles = state.download_items<layout::Particle>(model_->particle_count());
  ASPIC_CHECK(lists_->make(particles));
  group_count_ = static_cast<std::uint32_t>(lists_->candidate_groups().size());
  listed_count_ = static_cast<std::uint32_t>(lists_->listed().size());
  place_count_ = static_cast<std::uint32_t>(lists_->places().size());
  ASPIC_CHECK(fit(candidate_groups_, "points near bodies", lists_->candidate_groups().size_bytes()));
  ASPIC_CHECK(fit(words_, "contact candidates", lists_->words().size_bytes()));
  ASPIC_CHECK(fit(listed_, "particles near bodies", lists_->listed().size_bytes()));
  ASPIC_CHECK(fit(places_, "places of surfaces", lists_->places().size_bytes()));
  ASPIC_CHECK(fit(records_, "contacts of bodies",
                  std::uint64_t{group_count_} * CONTACT_RECORDS * sizeof(layout::ContactRecord)));
  places_.upload_items(lists_->places());
  if (acts()) {
    candidate_groups_.upload_items(lists_->candidate_groups());
    words_.upload_items(lists_->words());
    listed_.upload_items(lists_->listed());
  }
  float fastest = 0.0f;
  for (const layout::Particle& p : particles)
    fastest = std::max(fastest, std::hypot(p.velocity.x, p.velocity.y, p.velocity.z));
  const double steps =
      lists_->displacement_limit() / (model_->simulation.timestep * std::max(double{fastest}, 1e-6));
  patience_ = static_cast<std::uint64_t>(std::clamp(steps, 1.0, 1e6));
  fresh_ = true;
  return context_->check();
}

void ContactBuffers::held(std::uint64_t steps) {
  patience_ = std::max<std::uint64_t>(patience_ > steps ? patience_ - steps : 0, 8);
}

float ContactBuffers::most() const {
  // A little less than the host allows, since the device looks in single precision.
  return static_cast<float>(0.99 * lists_->displacement_limit() * lists_->displacement_limit());
}

std::uint64_t ContactBuffers::grown_bytes() const {
  std::uint64_t sum = 0;
  for (const Buffer* buffer : {&candidate_groups_, &words_, &records_, &listed_, &places_})
    sum += buffer->bytes();
  return sum;
}

}  // namespace aspic

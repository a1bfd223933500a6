#include "gpu_solver/touch_passes.h"

#include <algorithm>
#include <cmath>

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::ReadBy;

/// By TouchPasses::Kernel.
constexpr const char* kernels_of_touch[] = {"compute/touch_moved.comp", "compute/touch_find.comp",
                                            "compute/touch_push.comp",  "compute/touch_rub.comp",
                                            "compute/touch_drag.comp",  "compute/touch_finish.comp"};

}  // namespace

Status TouchPasses::build(gl::Context& context, const Model& model, const KernelOptions& kernels,
                          const KernelOptions& stage_kernels, const Surroundings& surroundings,
                          std::vector<Binding> finish_bindings) {
  context_ = &context;
  model_ = &model;
  if (!bodies_touch(model)) return {};
  lists_ = std::make_unique<TouchLists>(model);
  particle_count_ = model.particle_count();
  ASPIC_TRY(triangles_, Buffer::of(context, "triangles of bodies", lists_->triangles()));
  ASPIC_TRY(values_, Buffer::create(context, "contact of bodies", particle_count_ * sizeof(layout::vec4)));
  const std::vector<Binding> own[kernel_count] = {{{BINDING_TOUCH_PLACES, &places_}},
                                                  {{BINDING_TOUCH_TRIANGLES, &triangles_},
                                                   {BINDING_TOUCH_ENCOUNTERS, &encounters_},
                                                   {BINDING_TOUCH_WORDS, &words_},
                                                   {BINDING_TOUCH_RECORDS, &records_}},
                                                  {{BINDING_TOUCH_LISTED, &listed_},
                                                   {BINDING_TOUCH_VALUES, &values_},
                                                   {BINDING_TOUCH_ENCOUNTERS, &encounters_},
                                                   {BINDING_TOUCH_WORDS, &words_},
                                                   {BINDING_TOUCH_RECORDS, &records_}},
                                                  {{BINDING_TOUCH_VALUES, &values_},
                                                   {BINDING_TOUCH_ENCOUNTERS, &encounters_},
                                                   {BINDING_TOUCH_RECORDS, &records_}},
                                                  {{BINDING_TOUCH_LISTED, &listed_},
                                                   {BINDING_TOUCH_ENCOUNTERS, &encounters_},
                                                   {BINDING_TOUCH_WORDS, &words_},
                                                   {BINDING_TOUCH_RECORDS, &records_}},
                                                  std::move(finish_bindings)};
  for (std::size_t k = 0; k < kernel_count; ++k) {
    const KernelOptions& options = k == finish ? stage_kernels : kernels;
    ASPIC_TRY(programs_[k],
              context.programs().compute(options.library, kernels_of_touch[k], options.defines));
    std::vector<Binding> bindings = own[k];
    bindings.push_back(surroundings.constants);
    bindings.push_back(surroundings.control);
    passes_[k].emplace(*programs_[k], std::move(bindings), ReadBy::compute_pass);
  }
  return {};
}

void TouchPasses::set_model(const Model& model) {
  model_ = &model;
  if (!any()) return;
  lists_ = std::make_unique<TouchLists>(model);
  fresh_ = false;
}

/// A buffer of this size or more; its contents are lost.
Status TouchPasses::fit(Buffer& buffer, const char* name, std::uint64_t bytes) {
  if (buffer.bytes() >= bytes) return {};
  ASPIC_TRY(buffer, Buffer::create(*context_, name, bytes + bytes / 2));
  return {};
}

Status TouchPasses::refresh(const Buffer& state) {
  const auto particles = state.download_items<layout::Particle>(particle_count_);
  ASPIC_CHECK(lists_->make(particles));
  encounter_count_ = static_cast<std::uint32_t>(lists_->encounters().size());
  listed_count_ = static_cast<std::uint32_t>(lists_->listed().size());
  place_count_ = static_cast<std::uint32_t>(lists_->places().size());
  ASPIC_CHECK(fit(encounters_, "points near bodies", lists_->encounters().size_bytes()));
  ASPIC_CHECK(fit(words_, "lists of what is near", lists_->words().size_bytes()));
  ASPIC_CHECK(fit(listed_, "particles near bodies", lists_->listed().size_bytes()));
  ASPIC_CHECK(fit(places_, "places of surfaces", lists_->places().size_bytes()));
  ASPIC_CHECK(fit(records_, "contacts of bodies",
                  std::uint64_t{encounter_count_} * TOUCH_RECORDS * sizeof(layout::TouchRecord)));
  places_.upload_items(lists_->places());
  if (acts()) {
    encounters_.upload_items(lists_->encounters());
    words_.upload_items(lists_->words());
    listed_.upload_items(lists_->listed());
  }
  float fastest = 0.0f;
  for (const layout::Particle& p : particles)
    fastest = std::max(fastest, std::hypot(p.velocity.x, p.velocity.y, p.velocity.z));
  const double steps = lists_->leeway() / (model_->simulation.timestep * std::max(double{fastest}, 1e-6));
  patience_ = static_cast<std::uint64_t>(std::clamp(steps, 1.0, 1e6));
  fresh_ = true;
  return context_->check();
}

void TouchPasses::held(std::uint64_t steps) {
  patience_ = std::max<std::uint64_t>(patience_ > steps ? patience_ - steps : 0, 8);
}

void TouchPasses::run(Kernel kernel, std::uint32_t items, std::uint32_t step, std::span<const Binding> states,
                      ReadBy readers) const {
  const gl::Program& program = *programs_[kernel];
  program.set(LOCATION_STEP, step);
  if (kernel != finish) program.set(LOCATION_TOUCH_COUNT, items);
  passes_[kernel]->dispatch_for(items, states, readers);
}

void TouchPasses::queue_start(const Buffer& start, std::uint32_t step) const {
  // A little less than the host allows, since this is in single precision.
  programs_[moved]->set(LOCATION_TOUCH_NUMBER,
                        static_cast<float>(0.99 * lists_->leeway() * lists_->leeway()));
  run(moved, place_count_, step, std::array<Binding, 1>{{{BINDING_START_STATE, &start}}});
}

void TouchPasses::queue_find(const States& states, std::uint32_t step, float time) const {
  programs_[find]->set(LOCATION_TOUCH_NUMBER, time);
  run(find, encounter_count_, step,
      std::array<Binding, 2>{{{BINDING_START_STATE, states.start}, {BINDING_STAGE_STATE, states.stage}}});
}

void TouchPasses::queue_act(const States& states, std::uint32_t step, std::uint32_t stage,
                            ReadBy last) const {
  const std::array<Binding, 2> ends = {
      {{BINDING_START_STATE, states.start}, {BINDING_OUT_STATE, states.out}}};
  run(push, listed_count_, step, ends);
  const auto friction = static_cast<float>(model_->contact.body_friction);
  if (friction > 0.0f) {
    programs_[rub]->set(LOCATION_TOUCH_NUMBER, friction);
    run(rub, encounter_count_, step, std::span(ends).first(1));
    run(drag, listed_count_, step, std::span(ends).last(1));
  }
  programs_[finish]->set(LOCATION_STAGE, stage);
  run(finish, particle_count_, step,
      std::array<Binding, 4>{{{BINDING_START_STATE, states.start},
                              {BINDING_STAGE_STATE, states.stage},
                              {BINDING_OUT_STATE, states.out},
                              {BINDING_STAGE_SUMS, states.sums}}},
      last);
}

std::uint64_t TouchPasses::grown_bytes() const {
  std::uint64_t sum = 0;
  for (const Buffer* buffer : {&encounters_, &words_, &records_, &listed_, &places_}) sum += buffer->bytes();
  return sum;
}

}  // namespace aspic

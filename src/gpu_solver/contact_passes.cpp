#include "gpu_solver/contact_passes.h"

#include <utility>

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::ReadBy;

/// By ContactPasses::Kernel.
constexpr const char* kernels_of_contact[] = {
    "compute/contact_moved.comp", "compute/contact_find.comp", "compute/contact_normal_forces.comp",
    "compute/contact_friction_impulse.comp", "compute/contact_friction_gather.comp"};

}  // namespace

Status ContactPasses::build(gl::Context& context, const KernelOptions& kernels,
                            const Surroundings& surroundings) {
  if (!bodies_.any()) return {};
  ASPIC_TRY(values_, Buffer::create(context, "contact of bodies",
                                    bodies_.model().particle_count() * sizeof(layout::vec4)));
  const Binding values = {BINDING_CONTACT_VALUES, &values_};
  const ContactBuffers& b = bodies_;
  const std::vector<Binding> own[kernel_count] = {
      {b.places()},
      {b.triangles(), b.candidate_groups(), b.words(), b.records()},
      {b.listed(), values, b.candidate_groups(), b.words(), b.records()},
      {values, b.candidate_groups(), b.records()},
      {b.listed(), b.candidate_groups(), b.words(), b.records()}};
  for (std::size_t k = 0; k < kernel_count; ++k) {
    ASPIC_TRY(programs_[k], kernels.start(kernels_of_contact[k]));
    std::vector<Binding> bindings = own[k];
    bindings.push_back(surroundings.constants);
    bindings.push_back(surroundings.control);
    passes_[k].emplace(*programs_[k], std::move(bindings), ReadBy::compute_pass);
  }
  return {};
}

void ContactPasses::run(Kernel kernel, std::uint32_t items, std::uint32_t step,
                        std::span<const Binding> states) const {
  const gl::Program& program = *programs_[kernel];
  program.set(LOCATION_STEP, step);
  program.set(LOCATION_CONTACT_COUNT, items);
  passes_[kernel]->dispatch_for(items, states, ReadBy::compute_pass);
}

void ContactPasses::queue_start(const Buffer& start, std::uint32_t step) const {
  programs_[moved]->set(LOCATION_CONTACT_NUMBER, bodies_.most());
  run(moved, bodies_.place_count(), step, std::array<Binding, 1>{{{BINDING_START_STATE, &start}}});
}

void ContactPasses::queue_find(const States& states, std::uint32_t step, float time) const {
  programs_[find]->set(LOCATION_CONTACT_NUMBER, time);
  run(find, bodies_.group_count(), step,
      std::array<Binding, 2>{{{BINDING_START_STATE, states.start}, {BINDING_STAGE_STATE, states.stage}}});
}

void ContactPasses::queue_act(const States& states, std::uint32_t step) const {
  const std::array<Binding, 2> ends = {
      {{BINDING_START_STATE, states.start}, {BINDING_OUT_STATE, states.out}}};
  run(normal_forces, bodies_.listed_count(), step, ends);
  if (bodies_.has_friction()) {
    run(friction, bodies_.group_count(), step, std::span(ends).first(1));
    run(friction_sums, bodies_.listed_count(), step, std::span(ends).last(1));
  }
}

}  // namespace aspic

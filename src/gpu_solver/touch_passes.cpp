#include "gpu_solver/touch_passes.h"

#include <utility>

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::ReadBy;

/// By TouchPasses::Kernel.
constexpr const char* kernels_of_touch[] = {"compute/touch_moved.comp", "compute/touch_find.comp",
                                            "compute/touch_push.comp", "compute/touch_rub.comp",
                                            "compute/touch_drag.comp"};

}  // namespace

Status TouchPasses::build(gl::Context& context, const KernelOptions& kernels,
                          const Surroundings& surroundings) {
  if (!bodies_.any()) return {};
  ASPIC_TRY(values_, Buffer::create(context, "contact of bodies",
                                    bodies_.model().particle_count() * sizeof(layout::vec4)));
  const Binding values = {BINDING_TOUCH_VALUES, &values_};
  const TouchBuffers& b = bodies_;
  const std::vector<Binding> own[kernel_count] = {
      {b.places()},
      {b.triangles(), b.encounters(), b.words(), b.records()},
      {b.listed(), values, b.encounters(), b.words(), b.records()},
      {values, b.encounters(), b.records()},
      {b.listed(), b.encounters(), b.words(), b.records()}};
  for (std::size_t k = 0; k < kernel_count; ++k) {
    ASPIC_TRY(programs_[k], kernels.start(kernels_of_touch[k]));
    std::vector<Binding> bindings = own[k];
    bindings.push_back(surroundings.constants);
    bindings.push_back(surroundings.control);
    passes_[k].emplace(*programs_[k], std::move(bindings), ReadBy::compute_pass);
  }
  return {};
}

void TouchPasses::run(Kernel kernel, std::uint32_t items, std::uint32_t step,
                      std::span<const Binding> states) const {
  const gl::Program& program = *programs_[kernel];
  program.set(LOCATION_STEP, step);
  program.set(LOCATION_TOUCH_COUNT, items);
  passes_[kernel]->dispatch_for(items, states, ReadBy::compute_pass);
}

void TouchPasses::queue_start(const Buffer& start, std::uint32_t step) const {
  programs_[moved]->set(LOCATION_TOUCH_NUMBER, bodies_.most());
  run(moved, bodies_.place_count(), step, std::array<Binding, 1>{{{BINDING_START_STATE, &start}}});
}

void TouchPasses::queue_find(const States& states, std::uint32_t step, float time) const {
  programs_[find]->set(LOCATION_TOUCH_NUMBER, time);
  run(find, bodies_.encounter_count(), step,
      std::array<Binding, 2>{{{BINDING_START_STATE, states.start}, {BINDING_STAGE_STATE, states.stage}}});
}

void TouchPasses::queue_act(const States& states, std::uint32_t step) const {
  const std::array<Binding, 2> ends = {
      {{BINDING_START_STATE, states.start}, {BINDING_OUT_STATE, states.out}}};
  run(push, bodies_.listed_count(), step, ends);
  if (bodies_.rubs()) {
    run(rub, bodies_.encounter_count(), step, std::span(ends).first(1));
    run(drag, bodies_.listed_count(), step, std::span(ends).last(1));
  }
}

}  // namespace aspic

#include "gpu_solver/implicit_contact_passes.h"

#include <string>
#include <vector>

namespace aspic {
namespace {

using gl::Binding;

/// By ImplicitContactPasses::Kernel; which of them have a number, LOCATION_CONTACT_NUMBER.
constexpr const char* names[] = {"moved", "find",   "normal_forces", "friction",
                                 "react", "gather", "multiply",      "product"};
constexpr bool has_number[] = {true, true, false, false, false, false, false, false};

}  // namespace

Status ImplicitContactPasses::build(const KernelOptions& kernels, const Surroundings& surroundings) {
  if (!bodies_.any()) return {};
  const auto& [constants, solve, a, b, trial, search] = surroundings;
  const ContactBuffers& t = bodies_;
  const std::vector<Binding> own[kernel_count] = {
      {a, b, t.places()},
      {a, b, trial, t.triangles(), t.candidate_groups(), t.words(), t.records()},
      {search, t.listed(), t.candidate_groups(), t.words(), t.records()},
      {search, t.candidate_groups(), t.records()},
      {trial, t.candidate_groups(), t.records()},
      {search, t.listed(), t.candidate_groups(), t.words(), t.records()},
      {search, t.candidate_groups(), t.records()},
      {search, t.listed(), t.candidate_groups(), t.words(), t.records()}};
  for (std::size_t k = 0; k < kernel_count; ++k) {
    const std::string path = std::string("compute/implicit_contact_") + names[k] + ".comp";
    ASPIC_TRY(programs_[k], kernels.start(path));
    std::vector<Binding> bindings = own[k];
    bindings.push_back(constants);
    bindings.push_back(solve);
    passes_[k].emplace(*programs_[k], std::move(bindings), gl::ReadBy::compute_pass);
  }
  return {};
}

void ImplicitContactPasses::run(Kernel kernel, std::uint32_t items, float number) const {
  programs_[kernel]->set(LOCATION_CONTACT_COUNT, items);
  if (has_number[kernel]) programs_[kernel]->set(LOCATION_CONTACT_NUMBER, number);
  passes_[kernel]->dispatch_for(items);
}

void ImplicitContactPasses::queue_forces(float time) const {
  run(find, bodies_.group_count(), time);
  if (bodies_.has_friction()) {
    run(normal_forces, bodies_.listed_count());
    run(friction, bodies_.group_count());
  }
  run(react, bodies_.group_count());
  run(gather, bodies_.listed_count());
}

void ImplicitContactPasses::queue_product() const {
  run(multiply, bodies_.group_count());
  run(product, bodies_.listed_count());
}

}  // namespace aspic

#include "cpu_parallel/implicit_contact.h"

#include <algorithm>

#include "cpu_parallel/contact_kernels.h"
#include "cpu_parallel/springs.h"

namespace aspic::parallel {
namespace {

using physics::ParticleView;

std::array<const float*, 3> of(const VectorArray& a) {
  return {a[0].data(), a[1].data(), a[2].data()};
}
ImplicitBodyContact::Vector at(const VectorArray& a, std::uint32_t i) {
  return {a[0][i], a[1][i], a[2][i]};
}
void put(VectorArray& a, std::uint32_t i, const ImplicitBodyContact::Vector& v) {
  for (std::size_t c = 0; c < 3; ++c) a[c][i] = v[static_cast<Eigen::Index>(c)];
}

}  // namespace

ImplicitBodyContact::ImplicitBodyContact(const Model& model, const FloatArray& inverse_mass, Workers& workers)
    : contact_(model),
      inverse_mass_(inverse_mass),
      workers_(workers),
      count_(model.particle_count()),
      force_(vector_array(count_, slice)),
      product_(vector_array(count_, slice)),
      end_(vector_array(count_, slice)) {
  for (FloatArray& each : blocks_) each = FloatArray(count_, slice);
  contact_.search().set_kernels(closest_points_in_lanes, contacts_in_lanes);
}

/// Nothing that the last contacts added is left.
void ImplicitBodyContact::clear() {
  for (const std::uint32_t i : filled_) {
    put(force_, i, Vector::Zero());
    put(product_, i, Vector::Zero());
    for (FloatArray& each : blocks_) each[i] = 0.0f;
  }
  filled_.clear();
}

template <class Search>
bool ImplicitBodyContact::begin(const Search& search) {
  clear();
  const bool near = search([&](std::uint32_t p) { return inverse_mass_[p]; },
                           [&](std::size_t count, const auto& task) { workers_.run(count, task); });
  if (near) filled_.assign(contact_.particles().begin(), contact_.particles().end());
  return near;
}

bool ImplicitBodyContact::start(std::uint64_t step, const Particles& start, const Force& force) {
  return begin([&](const auto& inverse_mass, const auto& run) {
    return contact_.start(step, {of(start.x), of(start.v), 1}, force, inverse_mass, run);
  });
}

bool ImplicitBodyContact::search_again(const Particles& start, const VectorArray& v, float h,
                                       const Force& force) {
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < count_; ++i) end_[c][i] = start.x[c][i] + h * v[c][i];
  return begin([&](const auto& inverse_mass, const auto& run) {
    return contact_.search_again({of(start.x), of(start.v), 1}, {of(end_), of(v), 1}, force, inverse_mass,
                                 run);
  });
}

bool ImplicitBodyContact::react(const VectorArray& trial, const VectorArray* held) {
  const bool acts = contact_.react([&](std::uint32_t p) { return at(trial, p); });
  if (held != nullptr)
    for (std::size_t c = 0; c < 3; ++c) std::copy_n((*held)[c].data(), count_, force_[c].data());
  for (std::size_t n = 0; n < filled_.size(); ++n) {
    const std::uint32_t i = filled_[n];
    const Vector before = held != nullptr ? at(*held, i) : Vector(Vector::Zero());
    put(force_, i, before + contact_.force(n));
    const physics::DiagonalBlock<float>& b = contact_.block(n);
    const float numbers[6] = {b.xx, b.yy, b.zz, b.xy, b.xz, b.yz};
    for (std::size_t c = 0; c < 6; ++c) blocks_[c][i] = numbers[c];
  }
  return acts;
}

void ImplicitBodyContact::multiply(const VectorArray& p) {
  contact_.multiply([&](std::uint32_t i) { return at(p, i); });
  for (std::size_t n = 0; n < filled_.size(); ++n) put(product_, filled_[n], contact_.product(n));
}

std::uint64_t ImplicitBodyContact::bytes() const {
  return sizeof(*this) + contact_.bytes() + bytes_of(force_) + bytes_of(product_) + bytes_of(end_) +
         bytes_of(blocks_) + bytes_of(filled_);
}

}  // namespace aspic::parallel

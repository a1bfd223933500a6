#include "cpu_parallel/springs.h"

#include <algorithm>

#include "model/springs.h"

namespace aspic::parallel {

Constants::Constants(const SpringClass& spring)
    : stiffness(static_cast<float>(spring.stiffness)),
      damping(static_cast<float>(spring.damping)),
      rest_length(static_cast<float>(spring.rest_length)),
      slack(spring.cord ? static_cast<float>(spring.rest_length) : -1.0f) {}

LatticeStencil::LatticeStencil(const Model& model, const Body& body)
    : first_(body.first_particle),
      planes_(body.box()->plane_count()),
      rows_(body.box()->row_count()),
      row_size_(body.box()->row_size()) {
  const aspic::Lattice& box = *body.box();
  std::vector<std::array<int, 3>> offsets;
  for (const LatticeDirection& o : lattice_directions()) {
    const std::array<int, 3> offset = {o.di, o.dj, o.dk};
    if (springs_along(box, o) == 0) continue;
    offsets.push_back(offset);
    const std::ptrdiff_t step = static_cast<std::int32_t>(box.index(offset));
    const std::uint32_t spring_class = body.first_class + o.spring_class;
    directions_.push_back({step, offset[0], Constants(model.spring_classes[spring_class]), spring_class,
                           step > 0 ? -0.0f : 0.0f});
  }
  const std::size_t slices = (plane_size() + slice - 1) / slice;
  bits_.assign(slices * offsets.size(), 0);
  for (std::size_t m = 0; m < plane_size(); ++m) {
    const aspic::Lattice::Place place = box.place(m);
    for (std::size_t d = 0; d < offsets.size(); ++d) {
      if (!box.contains({0, place[1] + offsets[d][1], place[2] + offsets[d][2]})) continue;
      std::uint16_t& word = bits_[m / slice * offsets.size() + d];
      word = static_cast<std::uint16_t>(word | 1u << m % slice);
    }
  }
}

void LatticeStencil::set_constants(const Model& model) {
  for (Direction& direction : directions_)
    direction.constants = Constants(model.spring_classes[direction.spring_class]);
}

void SpringLists::set_constants(const Model& model) {
  for (auto* const each : {&stiffness_, &damping_, &rest_length_, &slack_}) each->clear();
  for (const SpringClass& spring : model.spring_classes) {
    const Constants constants(spring);
    stiffness_.push_back(constants.stiffness);
    damping_.push_back(constants.damping);
    rest_length_.push_back(constants.rest_length);
    slack_.push_back(constants.slack);
  }
}

SpringLists::SpringLists(const Model& model, const Body& body)
    : first_(body.first_particle), count_(body.particle_count) {
  set_constants(model);
  const std::size_t slices = (count_ + slice - 1) / slice;
  std::vector<std::uint32_t> degree(count_, 0);
  SpringRange of_body = springs_of(model, body.first_particle, body.particle_count);
  for (const Spring& s : of_body) {
    ++degree[s.a - first_];
    ++degree[s.b - first_];
  }
  start_.push_back(0);
  for (std::size_t n = 0; n < slices; ++n) {
    const auto from = degree.begin() + static_cast<std::ptrdiff_t>(n * slice);
    const auto to = degree.begin() + static_cast<std::ptrdiff_t>(std::min(count_, (n + 1) * slice));
    start_.push_back(start_.back() + *std::max_element(from, to));
  }
  Slot empty{};
  slots_.assign(start_.back(), empty);
  std::ranges::fill(degree, 0u);
  // Springs are sorted by (a, b): taken in that order, each particle's lower neighbors come first, in order.
  const auto append = [&](std::uint32_t own, std::uint32_t other, const Spring& s) {
    const std::size_t local = own - first_, lane = local % slice;
    Slot& slot = slots_[start_[local / slice] + degree[local]++];
    slot.neighbor[lane] = static_cast<std::int32_t>(other);
    slot.spring_class[lane] = static_cast<std::int32_t>(s.spring_class);
    slot.nothing[lane] = own < other ? -0.0f : 0.0f;
    slot.present = static_cast<std::uint16_t>(slot.present | 1u << lane);
  };
  for (const Spring& s : of_body) {
    append(s.a, s.b, s);
    append(s.b, s.a, s);
  }
}

}  // namespace aspic::parallel

#include "model/springs.h"

#include <algorithm>

namespace aspic {
namespace {

/// For searches by the lower end.
bool before(const Spring& spring, std::uint32_t particle) {
  return spring.a < particle;
}

}  // namespace

SpringRange::SpringRange(const Model& model, std::uint32_t first_particle, std::uint32_t end_particle)
    : model_(model), first_(first_particle), end_(end_particle) {}

SpringRange::Iterator SpringRange::begin() {
  const auto& listed = model_.listed_springs;
  listed_ = std::lower_bound(listed.begin(), listed.end(), first_, before);
  body_ = model_.bodies.begin();
  box_ = nullptr;
  return Iterator(*this);
}

SpringRange::Block SpringRange::next_block() {
  for (;;) {
    if (box_) {
      const Block block = springs_of_next_particle();
      if (!block.empty()) return block;
      if (box_) continue;
    }
    // Up to the next lattice, springs are listed.
    while (body_ != model_.bodies.end() && (!body_->box() || body_->first_particle < first_)) ++body_;
    const bool lattice = body_ != model_.bodies.end() && body_->first_particle < end_;
    const auto from = listed_;
    listed_ =
        std::lower_bound(from, model_.listed_springs.end(), lattice ? body_->first_particle : end_, before);
    if (lattice) enter(*body_++);
    if (from != listed_ || !lattice) return {from, listed_};
  }
}

void SpringRange::enter(const Body& body) {
  box_ = body.box();
  i_ = j_ = k_ = 0;
  particle_ = body.first_particle;
  for (std::size_t d = 0; d < most_directions; ++d) {
    const LatticeDirection& o = upper_directions()[d];
    ups_[d] = {0, box_->index({o.di, o.dj, o.dk}), body.first_class + o.spring_class};
  }
}

/// Steps to the next particle, and out of the lattice after the last.
SpringRange::Block SpringRange::springs_of_next_particle() {
  const std::uint32_t a = particle_++;
  const auto [ni, nj, nk] = box_->particles;
  std::size_t count = 0;
  const auto add = [&](const Spring& up) { buffer_[count++] = {a, a + up.b, up.spring_class}; };
  if (i_ + 2 < ni && j_ >= 1 && j_ + 2 < nj && k_ >= 1 && k_ + 2 < nk) {
    for (const Spring& up : ups_) add(up);
  } else {
    for (std::size_t d = 0; d < most_directions; ++d) {
      const LatticeDirection& o = upper_directions()[d];
      if (box_->contains({i_ + o.di, j_ + o.dj, k_ + o.dk})) add(ups_[d]);
    }
  }
  if (++k_ == nk) k_ = 0, ++j_;
  if (j_ == nj) j_ = 0, ++i_;
  if (i_ == ni) box_ = nullptr;
  return Block(buffer_).first(count);
}

SpringRange springs_of(const Model& model) {
  return {model, 0, 0xffffffffu};
}

SpringRange springs_of(const Model& model, std::uint32_t first, std::uint32_t count) {
  return {model, first, first + count};
}

std::vector<Spring> all_springs(const Model& model) {
  std::vector<Spring> all;
  all.reserve(spring_count(model));
  for (const Spring& spring : springs_of(model)) all.push_back(spring);
  return all;
}

std::vector<std::uint64_t> springs_by_class(const Model& model) {
  std::vector<std::uint64_t> count(model.spring_classes.size(), 0);
  for (const Spring& spring : model.listed_springs) ++count[spring.spring_class];
  for (const Body& body : model.bodies) {
    if (!body.box()) continue;
    for (const LatticeDirection& o : upper_directions())
      count[body.first_class + o.spring_class] += springs_along(*body.box(), o);
  }
  return count;
}

std::uint64_t spring_count(const Model& model) {
  std::uint64_t count = model.listed_springs.size();
  for (const Body& body : model.bodies)
    for (const LatticeDirection& o : upper_directions())
      if (body.box()) count += springs_along(*body.box(), o);
  return count;
}

std::vector<Spring> springs_of(const Lattice& lattice, std::uint32_t first, std::uint32_t first_class) {
  const std::vector<std::uint32_t> numbers = particle_numbers(lattice);
  std::vector<Spring> springs;
  for (std::size_t point = 0; point < numbers.size(); ++point) {
    const auto [i, j, k] = lattice.place(point);
    for (const LatticeDirection& o : upper_directions()) {
      if (!lattice.has_spring({i, j, k}, o)) continue;
      const std::uint32_t other = lattice.index({i + o.di, j + o.dj, k + o.dk});
      springs.push_back({first + numbers[point], first + numbers[other], first_class + o.spring_class});
    }
  }
  return springs;
}

void list_springs(Model& model) {
  model.listed_springs = all_springs(model);
  for (Body& body : model.bodies) {
    body.listed_surface = surface_of(body);
    body.lattice.reset();
  }
}

}  // namespace aspic

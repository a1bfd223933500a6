#include "model/springs.h"

#include <algorithm>
#include <cstdlib>

namespace aspic {
namespace {

constexpr auto all_directions = [] {
  std::array<LatticeDirection, 32> all = {};
  std::size_t n = 0;
  for (int di = -2; di <= 2; ++di) {
    for (int dj = -2; dj <= 2; ++dj) {
      for (int dk = -2; dk <= 2; ++dk) {
        const int squared = di * di + dj * dj + dk * dk;
        // Structural, shear across a face, shear across a cell, bending: add_cube makes its classes so.
        if (squared > 0 && squared <= 4) all[n++] = {di, dj, dk, static_cast<std::uint32_t>(squared - 1)};
      }
    }
  }
  return all;
}();
static_assert(all_directions.back().di == 2, "the table is full");

/// Those to upper ends.
constexpr auto directions = std::span(all_directions).subspan<16>();

/// Lower ends in a lattice whose neighbour in this direction exists.
std::uint64_t springs_along(const LatticeDirection& o, std::uint32_t edge) {
  std::uint64_t ends = 1;
  for (const int steps : {o.di, o.dj, o.dk})
    ends *= edge - std::min(edge, static_cast<std::uint32_t>(std::abs(steps)));
  return ends;
}

/// For searches by the lower end.
bool before(const Spring& spring, std::uint32_t particle) {
  return spring.a < particle;
}

}  // namespace

std::span<const LatticeDirection> lattice_directions() {
  return all_directions;
}

SpringRange::SpringRange(const Model& model, std::uint32_t first_particle, std::uint32_t end_particle)
    : model_(model), first_(first_particle), end_(end_particle) {}

SpringRange::Iterator SpringRange::begin() {
  const auto& listed = model_.listed_springs;
  listed_ = std::lower_bound(listed.begin(), listed.end(), first_, before);
  body_ = model_.bodies.begin();
  edge_ = 0;
  return Iterator(*this);
}

SpringRange::Block SpringRange::next_block() {
  for (;;) {
    if (edge_ > 0) {
      const Block block = springs_of_next_particle();
      if (!block.empty()) return block;
      if (edge_ > 0) continue;
    }
    // Up to the next lattice, springs are listed.
    while (body_ != model_.bodies.end() && (body_->lattice_edge == 0 || body_->first_particle < first_))
      ++body_;
    const bool lattice = body_ != model_.bodies.end() && body_->first_particle < end_;
    const auto from = listed_;
    listed_ =
        std::lower_bound(from, model_.listed_springs.end(), lattice ? body_->first_particle : end_, before);
    if (lattice) enter(*body_++);
    if (from != listed_ || !lattice) return {from, listed_};
  }
}

void SpringRange::enter(const Body& body) {
  edge_ = static_cast<int>(body.lattice_edge);
  i_ = j_ = k_ = 0;
  particle_ = body.first_particle;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    const LatticeDirection& o = directions[d];
    ups_[d] = {0, static_cast<std::uint32_t>((o.di * edge_ + o.dj) * edge_ + o.dk),
               body.first_class + o.spring_class};
  }
}

/// Steps to the next particle, and out of the lattice after the last.
SpringRange::Block SpringRange::springs_of_next_particle() {
  const std::uint32_t a = particle_++;
  const auto inside = [&](int x) { return x >= 0 && x < edge_; };
  std::size_t count = 0;
  const auto add = [&](const Spring& up) { buffer_[count++] = {a, a + up.b, up.spring_class}; };
  if (i_ + 2 < edge_ && j_ >= 1 && j_ + 2 < edge_ && k_ >= 1 && k_ + 2 < edge_) {
    for (const Spring& up : ups_) add(up);
  } else {
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const LatticeDirection& o = directions[d];
      if (inside(i_ + o.di) && inside(j_ + o.dj) && inside(k_ + o.dk)) add(ups_[d]);
    }
  }
  if (++k_ == edge_) k_ = 0, ++j_;
  if (j_ == edge_) j_ = 0, ++i_;
  if (i_ == edge_) edge_ = 0;
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
    if (body.lattice_edge == 0) continue;
    for (const LatticeDirection& o : directions)
      count[body.first_class + o.spring_class] += springs_along(o, body.lattice_edge);
  }
  return count;
}

std::uint64_t spring_count(const Model& model) {
  std::uint64_t count = model.listed_springs.size();
  for (const Body& body : model.bodies)
    for (const LatticeDirection& o : directions) count += springs_along(o, body.lattice_edge);
  return count;
}

void list_springs(Model& model) {
  model.listed_springs = all_springs(model);
  for (Body& body : model.bodies) body.lattice_edge = 0;
}

}  // namespace aspic

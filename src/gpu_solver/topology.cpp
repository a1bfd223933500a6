#include "gpu_solver/topology.h"

#include <fmt/format.h>

#include "gpu_solver/simulation_block.h"

namespace aspic {
namespace {

/// Springs are sorted by (a, b): a pass in that order meets each particle's springs in ascending neighbour
/// index, first those in which it is b, then those in which it is a.
template <class Word>
IncidentSprings incident(const Model& model, Word word) {
  IncidentSprings rows;
  rows.start.assign(model.particle_count() + 1, 0);
  for (const Spring& spring : model.springs) {
    ++rows.start[spring.a + 1];
    ++rows.start[spring.b + 1];
  }
  for (std::size_t i = 1; i < rows.start.size(); ++i) rows.start[i] += rows.start[i - 1];
  rows.words.resize(2 * model.springs.size());
  std::vector<std::uint32_t> next(rows.start.begin(), rows.start.end() - 1);
  for (std::size_t s = 0; s < model.springs.size(); ++s) {
    const Spring& spring = model.springs[s];
    rows.words[next[spring.a]++] = word(static_cast<std::uint32_t>(s), spring, spring.b, 0u);
    rows.words[next[spring.b]++] = word(static_cast<std::uint32_t>(s), spring, spring.a, 1u);
  }
  return rows;
}

Status fits(const Model& model) {
  const std::uint32_t bits = class_bits(model);
  const std::uint64_t limit = std::uint64_t{1} << (32 - bits);
  if (model.particle_count() > limit) {
    return Error{
        ErrorCode::scene_rejected,
        fmt::format("{} particles with {} kinds of springs are more than one 32-bit word a spring can name "
                    "({} particles at most): use fewer particles-per-edge or --backend reference",
                    model.particle_count(), model.spring_classes.size(), limit)};
  }
  return {};
}

}  // namespace

Result<IncidentSprings> neighbours_of(const Model& model) {
  if (const Status ok = fits(model); !ok) return ok.error();
  const std::uint32_t bits = class_bits(model);
  return incident(model, [bits](std::uint32_t, const Spring& spring, std::uint32_t neighbour, std::uint32_t) {
    return (neighbour << bits) | spring.spring_class;
  });
}

IncidentSprings springs_of(const Model& model) {
  return incident(model, [](std::uint32_t index, const Spring&, std::uint32_t, std::uint32_t side) {
    return (index << 1) | side;
  });
}

Result<std::vector<layout::uvec2>> packed_springs(const Model& model) {
  if (const Status ok = fits(model); !ok) return ok.error();
  const std::uint32_t bits = class_bits(model);
  std::vector<layout::uvec2> packed;
  packed.reserve(model.springs.size());
  for (const Spring& spring : model.springs)
    packed.push_back({spring.a, (spring.b << bits) | spring.spring_class});
  return packed;
}

}  // namespace aspic

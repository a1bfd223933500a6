#include "model/incident_springs.h"

#include <algorithm>
#include <bit>

#include "model/springs.h"

namespace aspic {
namespace {

Status check_words(const Model& model) {
  ASPIC_CHECK(check_spring_words(model));
  const std::uint64_t limit = std::uint64_t{1} << (32 - class_bits(model));
  if (model.particle_count() <= limit) return {};
  return fail(ErrorCode::scene_rejected,
              "{} particles with {} kinds of springs are more than one 32-bit word a spring can name "
              "({} particles at most): use fewer particles-per-edge or --backend reference",
              model.particle_count(), model.spring_classes.size(), limit);
}

/// Springs at each particle i, at i + 1.
std::vector<std::uint32_t> degrees(const Model& model) {
  std::vector<std::uint32_t> count(std::size_t{model.particle_count()} + 1, 0);
  for (const Spring& spring : springs_of(model)) {
    ++count[spring.a + 1];
    ++count[spring.b + 1];
  }
  return count;
}

}  // namespace

Status check_spring_words(const Model& model) {
  if (2 * spring_count(model) <= 0xffffffffu) return {};
  return fail(ErrorCode::scene_rejected,
              "{} springs have more ends than a list with 32-bit indices can name: use fewer "
              "particles-per-edge or --backend cpu",
              spring_count(model));
}

std::uint32_t class_bits(const Model& model) {
  const auto classes = static_cast<std::uint32_t>(model.spring_classes.size());
  return classes < 2 ? 0u : static_cast<std::uint32_t>(std::bit_width(classes - 1));
}

Result<IncidentSprings> incident_springs(const Model& model, IncidentWords words) {
  const bool neighbours = words == IncidentWords::neighbours;
  ASPIC_CHECK(neighbours ? check_words(model) : check_spring_words(model));
  const std::uint32_t bits = class_bits(model);
  IncidentSprings rows;
  rows.start = degrees(model);
  for (std::size_t i = 1; i < rows.start.size(); ++i) rows.start[i] += rows.start[i - 1];
  rows.words.resize(rows.start.back());
  std::vector<std::uint32_t> next(rows.start.begin(), rows.start.end() - 1);
  // Springs are sorted by (a, b): this meets each particle's springs in ascending neighbour index, first
  // those in which it is b, then those in which it is a.
  std::uint32_t index = 0;
  for (const Spring& spring : springs_of(model)) {
    rows.words[next[spring.a]++] = neighbours ? (spring.b << bits) | spring.spring_class : index << 1;
    rows.words[next[spring.b]++] = neighbours ? (spring.a << bits) | spring.spring_class : (index << 1) | 1u;
    ++index;
  }
  return rows;
}

Result<std::vector<std::array<std::uint32_t, 2>>> packed_springs(const Model& model) {
  ASPIC_CHECK(check_words(model));
  const std::uint32_t bits = class_bits(model);
  std::vector<std::array<std::uint32_t, 2>> packed;
  packed.reserve(spring_count(model));
  for (const Spring& spring : springs_of(model))
    packed.push_back({spring.a, (spring.b << bits) | spring.spring_class});
  return packed;
}

std::uint32_t highest_degree(const Model& model) {
  return std::ranges::max(degrees(model));
}

}  // namespace aspic

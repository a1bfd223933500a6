#include "model/cell_blocks.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>

namespace aspic {
namespace {

constexpr std::size_t direction_count = lattice_direction_table.size();
constexpr std::size_t most_patterns = 0x10000;

/// Where a particle has no spring.
constexpr std::uint16_t no_class = 0xffff;
/// Classes of a particle's springs by direction.
using Classes = std::array<std::uint16_t, direction_count>;
constexpr Classes no_classes = [] {
  Classes none = {};
  none.fill(no_class);
  return none;
}();

/// Rows of words, each kept once.
class Palette {
 public:
  Palette(std::vector<std::uint32_t>& words, std::size_t length) : words_(words), length_(length) {}

  std::uint32_t number_of(std::span<const std::uint32_t> row) {
    std::string key(reinterpret_cast<const char*>(row.data()), row.size_bytes());
    const auto [at, fresh] = numbers_.try_emplace(std::move(key), static_cast<std::uint32_t>(size()));
    if (fresh) words_.insert(words_.end(), row.begin(), row.end());
    return at->second;
  }
  std::size_t size() const { return words_.size() / length_; }
  /// Forgets all but the first.
  void cut(std::size_t size) {
    words_.resize(size * length_);
    std::erase_if(numbers_, [&](const auto& each) { return each.second >= size; });
  }

 private:
  std::vector<std::uint32_t>& words_;
  std::size_t length_;
  std::unordered_map<std::string, std::uint32_t> numbers_;
};

/// By steps from −2 to 2 along x, y and z.
std::uint32_t direction_of(const std::array<int, 3>& steps) {
  static const auto numbers = [] {
    std::array<std::uint8_t, 125> table = {};
    table.fill(direction_count);
    for (std::size_t d = 0; d < direction_count; ++d) {
      const LatticeDirection& o = lattice_direction_table[d];
      table[static_cast<std::size_t>(((o.di + 2) * 5 + o.dj + 2) * 5 + o.dk + 2)] =
          static_cast<std::uint8_t>(d);
    }
    return table;
  }();
  for (const int step : steps)
    if (step < -2 || step > 2) return direction_count;
  return numbers[static_cast<std::size_t>(((steps[0] + 2) * 5 + steps[1] + 2) * 5 + steps[2] + 2)];
}

std::span<const Spring> springs_at(const Model& model, const Body& body) {
  const auto first = std::ranges::lower_bound(model.listed_springs, body.first_particle, {}, &Spring::a);
  const auto end = std::ranges::lower_bound(
      model.listed_springs, std::uint64_t{body.first_particle} + body.particle_count, {}, &Spring::a);
  return {first, end};
}

/// By particle of the body; none if a spring is not one of its lattice.
std::optional<std::vector<Classes>> classes_of(const Body& body, std::span<const Spring> springs,
                                               const std::vector<std::uint32_t>& numbers) {
  std::vector<Lattice::Place> places;
  places.reserve(body.particle_count);
  for (std::size_t point = 0; point < numbers.size(); ++point)
    if (numbers[point] != no_particle) places.push_back(body.lattice->place(point));
  if (places.size() != body.particle_count) return std::nullopt;
  std::vector<Classes> classes(body.particle_count, no_classes);
  for (const Spring& spring : springs) {
    const std::uint32_t a = spring.a - body.first_particle, b = spring.b - body.first_particle;
    if (b >= body.particle_count) return std::nullopt;
    const auto [i, j, k] = places[a];
    const std::uint32_t d = direction_of({places[b][0] - i, places[b][1] - j, places[b][2] - k});
    const std::uint32_t c = spring.spring_class - body.first_class;
    if (d >= direction_count || c >= std::min<std::uint32_t>(body.class_count, no_class)) return std::nullopt;
    // Directions are in order, so that the opposite ones are in the reverse order.
    classes[a][d] = classes[b][direction_count - 1 - d] = static_cast<std::uint16_t>(c);
  }
  return classes;
}

/// The class from which those of all springs of these particles count on; none if there is no such class.
std::optional<std::uint32_t> base_of(std::span<const Classes> particles) {
  std::optional<std::uint32_t> base;
  for (const Classes& classes : particles) {
    for (std::size_t d = 0; d < direction_count; ++d) {
      if (classes[d] == no_class) continue;
      const std::uint32_t longer = lattice_direction_table[d].spring_class;
      if (classes[d] < longer || (base && *base != classes[d] - longer)) return std::nullopt;
      base = classes[d] - longer;
    }
  }
  return base;
}

/// Patterns of all bodies, and the bodies so far.
class Builder {
 public:
  explicit Builder(std::uint32_t class_width) : halves_(made_.halves, half_words(class_width)) {
    made_.class_width = class_width;
  }

  /// Adds a body, unless it has too many patterns or lists of its springs take less.
  void add(const Model& model, std::uint32_t number) {
    const Body& body = model.bodies[number];
    // A record numbers so many blocks, which are at least two points each.
    if (body.lattice->points() > std::size_t{2} << block_bits) return;
    const std::vector<std::uint32_t> numbers = particle_numbers(*body.lattice);
    const std::span<const Spring> springs = springs_at(model, body);
    const auto classes = classes_of(body, springs, numbers);
    if (!classes) return;
    const std::size_t patterns = patterns_.size(), halves = halves_.size();
    const std::uint64_t words_before = made_.words();
    CellBlocks added;
    add_blocks(added, *body.lattice, numbers, *classes, body.first_particle);
    const std::uint64_t bytes = sizeof(std::uint32_t) * (made_.words() - words_before + added.words()),
                        in_lists = 2 * sizeof(std::uint32_t) * springs.size();
    if (std::max(patterns_.size(), halves_.size()) > most_patterns || bytes >= in_lists) {
      patterns_.cut(patterns);
      halves_.cut(halves);
      return;
    }
    const auto place = static_cast<std::uint32_t>(made_.bodies.size()) << block_bits;
    for (std::size_t word = 0; word < added.plain.size(); word += plain_words) added.plain[word] |= place;
    for (std::size_t word = 0; word < added.mixed.size(); word += mixed_words) added.mixed[word] |= place;
    CellBody taken;
    taken.body = number;
    taken.first_block = static_cast<std::uint32_t>(made_.map.size());
    taken.block_count = static_cast<std::uint32_t>(added.map.size());
    taken.row_blocks = blocks_of(body.lattice->row_size());
    taken.plane_blocks = taken.row_blocks * static_cast<std::uint32_t>(body.lattice->row_count());
    made_.bodies.push_back(taken);
    made_.particles += body.particle_count;
    const auto append = [](std::vector<std::uint32_t>& to, const std::vector<std::uint32_t>& words) {
      to.insert(to.end(), words.begin(), words.end());
    };
    append(made_.map, added.map);
    append(made_.plain, added.plain);
    append(made_.mixed, added.mixed);
  }
  CellBlocks& made() { return made_; }

 private:
  static std::uint32_t blocks_of(std::size_t row) {
    return static_cast<std::uint32_t>((row + block_places - 1) / block_places);
  }

  void add_blocks(CellBlocks& to, const Lattice& lattice, const std::vector<std::uint32_t>& numbers,
                  std::span<const Classes> classes, std::uint32_t first_particle) {
    const std::size_t row = lattice.row_size();
    std::size_t next = 0;
    for (std::size_t first = 0; first < numbers.size(); first += row) {
      for (std::size_t at = 0; at < row; at += block_places) {
        std::uint32_t places = 0;
        for (std::size_t p = 0; p < block_places && at + p < row; ++p)
          if (numbers[first + at + p] != no_particle) places |= 1u << p;
        const auto count = static_cast<std::size_t>(std::popcount(places));
        if (places != 0) add_record(to, places, classes.subspan(next, count));
        to.map.push_back((first_particle + static_cast<std::uint32_t>(next)) << block_places | places);
        next += count;
      }
    }
  }

  /// Of the next block of the map, with these particles.
  void add_record(CellBlocks& to, std::uint32_t places, std::span<const Classes> particles) {
    const auto block = static_cast<std::uint32_t>(to.map.size());
    const std::optional<std::uint32_t> base = base_of(particles);
    std::array<std::uint32_t, block_places> of_place = {};
    std::size_t next = 0;
    for (std::size_t p = 0; p < block_places; ++p) {
      const Classes& classes = (places >> p & 1u) != 0 ? particles[next++] : no_classes;
      of_place[p] = base ? plain_pattern(classes, *base) : half(classes, 0) | half(classes, 1) << 16;
    }
    if (base)
      to.plain.insert(to.plain.end(),
                      {block, of_place[0] | of_place[1] << 16, of_place[2] | of_place[3] << 16});
    else
      to.mixed.insert(to.mixed.end(), {block, of_place[0], of_place[1], of_place[2], of_place[3]});
  }

  std::uint32_t plain_pattern(const Classes& classes, std::uint32_t base) {
    std::uint32_t there = 0;
    for (std::size_t d = 0; d < direction_count; ++d)
      if (classes[d] != no_class) there |= 1u << d;
    return patterns_.number_of(std::array{there, base});
  }

  std::uint32_t half(const Classes& classes, std::size_t which) {
    const std::uint32_t width = made_.class_width, in_word = 32 / width;
    std::array<std::uint32_t, half_words(16)> words = {};
    for (std::uint32_t n = 0; n < half_size; ++n) {
      const std::uint32_t c = classes[half_directions[which][n]] & ((1u << width) - 1);
      words[n / in_word] |= c << width * (n % in_word);
    }
    return halves_.number_of(std::span(words).first(half_words(width)));
  }

  CellBlocks made_;
  Palette patterns_{made_.patterns, 2}, halves_;
};

}  // namespace

std::vector<bool> CellBlocks::taken(const Model& model) const {
  std::vector<bool> are(model.bodies.size(), false);
  for (const CellBody& each : bodies) are[each.body] = true;
  return are;
}

CellBlocks cell_blocks(const Model& model, std::size_t most_bodies) {
  const auto many_classes = [](const Body& body) { return has_cells(body) && body.class_count > 0xff; };
  Builder builder(std::ranges::any_of(model.bodies, many_classes) ? 16 : 8);
  CellBlocks& made = builder.made();
  // A word of the map names a particle in 28 bits.
  if (model.particle_count() >= 1u << (32 - block_places)) return {};
  for (std::uint32_t b = 0; b < model.bodies.size() && made.bodies.size() < most_bodies; ++b)
    if (has_cells(model.bodies[b])) builder.add(model, b);
  return std::move(made);
}

}  // namespace aspic

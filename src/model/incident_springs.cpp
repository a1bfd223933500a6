#include "model/incident_springs.h"

#include <algorithm>
#include <bit>

#include "model/springs.h"

namespace aspic {
namespace {

/// Words that name neighbors, and no_spring as well.
Status check_words(const Model& model) {
  const std::uint64_t limit = (std::uint64_t{1} << (32 - class_bits(model))) - 1;
  if (model.particle_count() <= limit) return {};
  return advised(fail(ErrorCode::scene_rejected,
                      "{} particles with {} kinds of springs exceed the 32-bit word that names a spring ({} "
                      "particles at most).",
                      model.particle_count(), model.spring_classes.size(), limit),
                 {use_backend("cpu"), advice("use fewer particles-per-edge")});
}

/// Adds to the counts of the particles of a lattice whose cells are all full, of which `degree` is the
/// first's.
void count_lattice(const Lattice& lattice, std::uint32_t* degree) {
  const auto [ni, nj, nk] = lattice.particles;
  for (const LatticeDirection& o : lattice_directions()) {
    for (int i = std::max(0, -o.di); i < ni - std::max(0, o.di); ++i) {
      for (int j = std::max(0, -o.dj); j < nj - std::max(0, o.dj); ++j) {
        std::uint32_t* const row = degree + lattice.index({i, j, 0});
        for (int k = std::max(0, -o.dk); k < nk - std::max(0, o.dk); ++k) ++row[k];
      }
    }
  }
}

bool is_beside(IncidentWords words) {
  return words == IncidentWords::beside_lattices || words == IncidentWords::beside_cells;
}

/// Springs at each particle, those of lattices only if they are to be walked by words.
std::vector<std::uint32_t> degrees(const Model& model, IncidentWords words) {
  std::vector<std::uint32_t> count(model.particle_count(), 0);
  for (const Spring& spring : model.listed_springs) {
    ++count[spring.a];
    ++count[spring.b];
  }
  if (is_beside(words)) return count;
  for (const Body& body : model.bodies)
    if (body.box()) count_lattice(*body.box(), count.data() + body.first_particle);
  return count;
}

/// Where the words of each slice begin, and one past the last.
std::vector<std::uint64_t> slice_starts(const Model& model, IncidentWords words,
                                        const std::vector<WalkedRun>& runs) {
  const std::vector<std::uint32_t> degree = degrees(model, words);
  const std::uint32_t walked = runs.back().place + runs.back().end - runs.back().first;
  std::vector<std::uint64_t> start(std::size_t{walked} / spring_slice + (walked % spring_slice > 0) + 1, 0);
  for (const WalkedRun& run : runs) {
    for (std::uint32_t i = run.first; i < run.end; ++i) {
      std::uint64_t& most = start[(run.place + i - run.first) / spring_slice + 1];
      most = std::max<std::uint64_t>(most, degree[i]);
    }
  }
  for (std::size_t s = 1; s < start.size(); ++s) start[s] = start[s - 1] + spring_slice * start[s];
  return start;
}

Status check_count(const Model& model, std::uint64_t words) {
  if (words <= 0xffffffffu) return {};
  return advised(fail(ErrorCode::scene_rejected,
                      "{} springs have too many ends for a list with 32-bit indices.", spring_count(model)),
                 {use_backend("cpu"), advice("use fewer particles-per-edge")});
}

}  // namespace

std::uint32_t lattice_particles(const Model& model) {
  std::uint32_t count = 0;
  for (const Body& body : model.bodies)
    if (body.box()) count += body.particle_count;
  return count;
}

std::vector<WalkedRun> walked_runs(const Model& model, IncidentWords words, const std::vector<bool>& cells) {
  std::vector<WalkedRun> runs = {{}};
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const bool by_blocks = words == IncidentWords::beside_cells && !cells.empty() && cells[b];
    if (!by_blocks && !(body.box() && is_beside(words))) continue;
    runs.back().end = body.first_particle;
    const std::uint32_t place = runs.back().place + runs.back().end - runs.back().first;
    runs.push_back({body.first_particle + body.particle_count, 0, place});
  }
  runs.back().end = model.particle_count();
  return runs;
}

IncidentCounts incident_counts(const Model& model, IncidentWords words, const std::vector<bool>& cells) {
  const std::vector<std::uint64_t> start = slice_starts(model, words, walked_runs(model, words, cells));
  return {start.size(), start.back()};
}

Status check_spring_words(const Model& model) {
  return check_count(model, 2 * spring_count(model));
}

std::uint32_t class_bits(const Model& model) {
  const auto classes = static_cast<std::uint32_t>(model.spring_classes.size());
  return classes < 2 ? 0u : static_cast<std::uint32_t>(std::bit_width(classes - 1));
}

Result<IncidentSprings> incident_springs(const Model& model, IncidentWords words,
                                         const std::vector<bool>& cells) {
  const bool neighbors = words != IncidentWords::springs, beside = is_beside(words);
  const std::vector<WalkedRun> runs = walked_runs(model, words, cells);
  const std::vector<std::uint64_t> start = slice_starts(model, words, runs);
  if (!neighbors) ASPIC_CHECK(check_spring_words(model));
  if (neighbors && !(beside && start.back() == 0)) ASPIC_CHECK(check_words(model));
  ASPIC_CHECK(check_count(model, start.back()));
  const std::uint32_t bits = class_bits(model);
  IncidentSprings rows;
  for (const std::uint64_t first : start) rows.start.push_back(static_cast<std::uint32_t>(first));
  rows.words.assign(start.back(), no_spring);
  // By particle: where its next word goes; none goes to those that are left out.
  std::vector<std::uint32_t> next(model.particle_count(), no_spring);
  for (const WalkedRun& run : runs) {
    for (std::uint32_t i = run.first; i < run.end; ++i) {
      const std::uint32_t place = run.place + i - run.first;
      next[i] = rows.start[place / spring_slice] + place % spring_slice;
    }
  }
  const auto add = [&](std::uint32_t particle, std::uint32_t word) {
    if (next[particle] == no_spring) return;
    rows.words[next[particle]] = word;
    next[particle] += spring_slice;
  };
  // Springs are sorted by (a, b): this meets each particle's springs in ascending neighbor index, first
  // those in which it is b, then those in which it is a.
  std::uint32_t index = 0;
  const auto add_spring = [&](const Spring& spring) {
    add(spring.a, neighbors ? (spring.b << bits) | spring.spring_class : index << 1);
    add(spring.b, neighbors ? (spring.a << bits) | spring.spring_class : (index << 1) | 1u);
    ++index;
  };
  if (beside) {
    for (const Spring& spring : model.listed_springs) add_spring(spring);
  } else {
    for (const Spring& spring : springs_of(model)) add_spring(spring);
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
  return std::ranges::max(degrees(model, IncidentWords::neighbors));
}

}  // namespace aspic

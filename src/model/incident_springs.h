#pragma once
// The springs of a model as kernels walk them: per particle, in ascending neighbor index, one word a spring.
// Particles are grouped in slices of spring_slice, whose words are interleaved: the first spring of each
// particle, then the second, and so on, so that neighboring invocations read neighboring words.
#include <array>
#include <cstdint>
#include <vector>

#include "base/result.h"
#include "model/model.h"

namespace aspic {

/// What a word says of a spring at one of its ends.
enum class IncidentWords {
  neighbors,        ///< neighbor << class_bits | class
  beside_lattices,  ///< the same, of the particles outside lattices alone, which count as if there were no
                    ///< others
  beside_cells,     ///< the same, without bodies of cells that kernels take by blocks (cell_blocks.h)
  springs           ///< index of the spring << 1 | (1 at its end b)
};

/// Particles of a slice.
inline constexpr std::uint32_t spring_slice = 32;
/// A word where a particle has fewer springs than others of its slice.
inline constexpr std::uint32_t no_spring = 0xffffffffu;

/// Word n of particle i is words[start[s] + n·spring_slice + i % spring_slice], s = i / spring_slice, for n
/// below (start[s + 1] − start[s]) / spring_slice.
struct IncidentSprings {
  std::vector<std::uint32_t> start;  ///< slices + 1
  std::vector<std::uint32_t> words;
};

/// What incident_springs() would hold.
struct IncidentCounts {
  std::uint64_t starts = 0, words = 0;
  std::uint64_t bytes() const { return sizeof(std::uint32_t) * (starts + words); }
};
/// `cells`: of words beside cells, whether each body is left out as well.
IncidentCounts incident_counts(const Model& model, IncidentWords words, const std::vector<bool>& cells = {});

/// Consecutive particles that have words, and the place of the first of them among all that have.
struct WalkedRun {
  std::uint32_t first = 0, end = 0, place = 0;
};
/// All of them. `cells` as above.
std::vector<WalkedRun> walked_runs(const Model& model, IncidentWords words,
                                   const std::vector<bool>& cells = {});

/// Particles of the model's lattices.
std::uint32_t lattice_particles(const Model& model);

/// Low bits of a word that hold the spring class: enough for all classes of the model.
std::uint32_t class_bits(const Model& model);

/// Error (scene_rejected): a word a spring end is more than 32 bits can count.
Status check_spring_words(const Model& model);

/// Errors (scene_rejected): more words than 32 bits can count; words that name neighbors, and more particles
/// than the bits left by the class can. `cells` as above.
Result<IncidentSprings> incident_springs(const Model& model, IncidentWords words,
                                         const std::vector<bool>& cells = {});

/// Each spring in two words: end a; end b << class_bits | class. Errors as incident_springs of neighbors.
Result<std::vector<std::array<std::uint32_t, 2>>> packed_springs(const Model& model);

/// The most springs at one particle.
std::uint32_t highest_degree(const Model& model);

}  // namespace aspic

#pragma once
// The springs of a model as kernels walk them: per particle, in ascending neighbour index, one word a spring.
#include <array>
#include <cstdint>
#include <vector>

#include "base/result.h"
#include "model/model.h"

namespace aspic {

/// What a word says of a spring at one of its ends.
enum class IncidentWords {
  neighbours,  ///< neighbour << class_bits | class
  springs      ///< index of the spring << 1 | (1 at its end b)
};

/// Compressed rows: particle i owns words[start[i]] … words[start[i + 1] − 1].
struct IncidentSprings {
  std::vector<std::uint32_t> start;  ///< particles + 1
  std::vector<std::uint32_t> words;  ///< 2 · springs
};

/// Low bits of a word that hold the spring class: enough for all classes of the model.
std::uint32_t class_bits(const Model& model);

/// Error (scene_rejected): a word a spring end is more than 32 bits can count.
Status check_spring_words(const Model& model);

/// Errors (scene_rejected): as check_spring_words; neighbours, and more particles than the bits left by the
/// class can name.
Result<IncidentSprings> incident_springs(const Model& model, IncidentWords words);

/// Each spring in two words: end a; end b << class_bits | class. Errors as incident_springs of neighbours.
Result<std::vector<std::array<std::uint32_t, 2>>> packed_springs(const Model& model);

/// The most springs at one particle.
std::uint32_t highest_degree(const Model& model);

}  // namespace aspic

#pragma once
// Bodies of cells as kernels of their lattices take them. A block is four places in a row of the lattice, of
// which some may be empty. A map of all blocks says where the particle at a place is, so that neighbors are
// found as in a box; which springs a particle has is a pattern, which all particles that have the same share.
#include <array>
#include <cstdint>
#include <vector>

#include "model/model.h"

namespace aspic {

/// Places of a block.
inline constexpr std::uint32_t block_places = 4;
/// Bits of a record that number the block in its body; those above number the body.
inline constexpr std::uint32_t block_bits = 26;
/// Directions of half a pattern: to lower ends, to upper ones. First those over two steps and the next
/// particle in the own row, then row by row the three directions there, of which the first has a fourth place
/// too.
inline constexpr std::uint32_t half_size = 20;
inline constexpr std::array<std::array<std::uint8_t, half_size>, 2> half_directions = {
    {{0, 10, 14, 15, 1, 2, 3, 1, 4, 5, 6, 4, 7, 8, 9, 7, 11, 12, 13, 11},
     {17, 21, 31, 16, 18, 19, 20, 18, 22, 23, 24, 22, 25, 26, 27, 25, 28, 29, 30, 28}}};
constexpr std::uint32_t half_words(std::uint32_t class_width) {
  return half_size * class_width / 32;
}
/// Words of a record.
inline constexpr std::uint32_t plain_words = 3, mixed_words = 5;

/// A body that is taken. Its blocks lie row by row in the map.
struct CellBody {
  std::uint32_t body = 0;  ///< of Model::bodies
  std::uint32_t first_block = 0, block_count = 0;
  std::uint32_t row_blocks = 0, plane_blocks = 0;  ///< blocks from one row, and plane, to the next
};

struct CellBlocks {
  std::vector<CellBody> bodies;  ///< in the model's order
  std::uint32_t particles = 0;   ///< of these bodies
  /// By block: its first particle or, if it has none, the next one, << 4 | which places have one.
  std::vector<std::uint32_t> map;
  /// Records of blocks all of whose springs are of one set of classes: as if the body were of one material.
  /// Three words: body << block_bits | block, then by place the number of a pattern in 16 bits.
  std::vector<std::uint32_t> plain;
  /// All other blocks that have particles, five words each: the same, then by place the number of the half
  /// with the springs to lower ends | that to upper ends << 16.
  std::vector<std::uint32_t> mixed;
  /// Patterns of plain blocks: which directions have a spring, by bit; the class of the shortest, from
  /// which those of longer ones count on as in lattice_class_types.
  std::vector<std::uint32_t> patterns;
  /// Halves of other patterns, by half_directions: classes in class_width bits, counted from the body's
  /// first, or all bits set where there is no spring.
  std::vector<std::uint32_t> halves;
  std::uint32_t class_width = 8;  ///< or 16, where a body has more than 255 classes

  bool any() const { return !bodies.empty(); }
  std::uint32_t plain_blocks() const { return static_cast<std::uint32_t>(plain.size() / plain_words); }
  std::uint32_t mixed_blocks() const { return static_cast<std::uint32_t>(mixed.size() / mixed_words); }
  /// Whether each of the model's bodies is taken.
  std::vector<bool> taken(const Model& model) const;
  std::uint64_t words() const {
    return map.size() + plain.size() + mixed.size() + patterns.size() + halves.size();
  }
};

/// Bodies of a lattice that do not follow from it alone, unless they would take more memory so than lists of
/// their springs or have more than 65,536 patterns; the first `most_bodies` of them.
CellBlocks cell_blocks(const Model& model, std::size_t most_bodies);

/// Whether cell_blocks() may take this body.
inline bool has_cells(const Body& body) {
  return body.lattice && !body.box();
}

}  // namespace aspic

#pragma once
// shaders/shared/layout.glsl as C++: what solvers leave in buffers and images read there.
#include <cstddef>
#include <cstdint>

#include "gpu/loop_bound.h"
#include "model/cell_blocks.h"
#include "model/incident_springs.h"
#include "model/lattice.h"

namespace aspic::layout {

using uint = std::uint32_t;
struct vec4 {
  float x = 0, y = 0, z = 0, w = 0;
};
struct uvec2 {
  uint x = 0, y = 0;
};
struct uvec4 {
  uint x = 0, y = 0, z = 0, w = 0;
};

#include "shared/layout.glsl"

static_assert(SPRING_SLICE == spring_slice && NO_SPRING == no_spring);
static_assert(sizeof(Direction) == 16 && sizeof(GpuLattice) == 32 && offsetof(Lattices, directions) == 16);
static_assert(offsetof(Lattices, lattices) == 16 + sizeof(Direction) * LATTICE_DIRECTIONS);
static_assert(offsetof(Lattices, unlisted) ==
              offsetof(Lattices, lattices) + sizeof(GpuLattice) * MAX_LATTICES);
static_assert(sizeof(Unlisted) == 16 && sizeof(CellBody) == 32 && offsetof(Cells, cell_bodies) == 32);
static_assert(BLOCK_PLACES == block_places && BLOCK_BITS == block_bits);
static_assert(PLAIN_WORDS == plain_words && MIXED_WORDS == mixed_words);
static_assert(HALF_WORDS(8) == half_words(8) && HALF_WORDS(16) == half_words(16));
static_assert(MAX_LATTICES <= 1u << (32 - block_bits));
static_assert(LATTICE_DIRECTIONS == lattice_direction_table.size());
static_assert(LATTICE_CLASSES == lattice_class_types.size());
static_assert(MAX_ROUNDS == gl::max_rounds);
static_assert(sizeof(Particle) == 32 && offsetof(Particle, velocity) == 16);
static_assert(sizeof(Ball) == 64 && offsetof(Ball, velocity) == 16 && offsetof(Ball, spin) == 32);
static_assert(sizeof(SpringClass) == 16 && offsetof(SpringClass, cord) == 12);

}  // namespace aspic::layout

#pragma once
// Scenes whose arrays are larger than the device's storage blocks: a pass is dispatched over windows of its
// items, one after the other, each with the parts of the arrays that it needs. Neither bits nor the order of
// any sum change.
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "base/result.h"
#include "device/device_state.h"
#include "gpu/pass.h"
#include "gpu_solver/layout.h"
#include "model/model.h"

namespace aspic {

/// Items of a pass, and the parts of the arrays over each kind that they read and write.
struct Window {
  IndexRange items = {}, particles = {}, words = {}, springs = {};
};

/// What an array has an element for.
enum class Over { items, particles, words, springs };

/// A storage block of a pass, and the bytes of an element of it.
struct SlicedArray {
  std::uint32_t binding = 0;
  const gl::Buffer* buffer = nullptr;  ///< null or an empty handle: the kernel reads none
  Over over = Over::particles;
  std::uint64_t element_bytes = 0;
};

/// Of the largest arrays over each.
struct ElementBytes {
  std::uint64_t item = 0, particle = 0, word = 0, spring = 0;
};

/// Windows begin at multiples of this many items, a block of reductions, and so do their parts of arrays:
/// every offset is then a multiple of any alignment that a device may ask for.
inline constexpr std::uint64_t window_unit = 256;
static_assert(window_unit == spring_unit);

/// What a range of items touches.
using Seen = std::function<Window(IndexRange items)>;

/// As few windows as cover all items with no part of an array over `block_bytes`. `unit_items`: items that
/// stay together, other than window_unit where there is no array over items. Error (scene_rejected): springs
/// join particles so far apart in the list that a few of them need more than a block.
Result<std::vector<Window>> windows_over(std::uint64_t items, std::uint64_t block_bytes,
                                         const ElementBytes& bytes, const Seen& seen,
                                         std::uint64_t unit_items = window_unit);

/// Items are runs of particles of lattices, `run` each; with run 1 particles.
Seen seen_by_lattice_runs(const Model& model, std::uint32_t run);
/// Particles of a tile (TILE_I and the like in shaders/compute/layout.glsl), and a group of its kernel.
inline constexpr std::uint32_t tile_particles = TILE_I * TILE_J * TILE_K;
static_assert(tile_particles == window_unit);
/// Tiles of a lattice along i, j and k.
struct TileCounts {
  std::uint32_t i, j, k;
  std::uint32_t all() const { return i * j * k; }
};
TileCounts tiles_in(const Body& lattice);
/// Items are places in tiles of lattices.
Seen seen_by_lattice_tiles(const Model& model);
/// Items are runs of `run` places, 1 or 4, of blocks of bodies of cells, plain ones (0) or mixed ones (1).
Seen seen_by_blocks(const SpringBuffers& springs, std::size_t kind, std::uint32_t run);
/// Items are the particles whose springs have words, in their order.
Seen seen_by_listed(const SpringBuffers& springs);
/// Items are particles, in lattices or not.
Seen seen_by_particles(const Model& model, const SpringBuffers& springs);
/// Items are springs.
Seen seen_by_springs(const SpringBuffers& springs);

/// A pass that is dispatched window by window, or at once where there are none.
class SlicedPass {
 public:
  /// `windows`: empty, or of a program compiled with ASPIC_WINDOWS.
  SlicedPass(gl::Pass pass, std::uint32_t items, std::vector<Window> windows)
      : pass_(std::move(pass)), items_(items), windows_(std::move(windows)) {}

  /// `arrays`: at most 8.
  void dispatch(std::span<const SlicedArray> arrays, gl::ReadBy readers) const;
  const gl::Program& program() const { return pass_.program(); }

 private:
  gl::Pass pass_;
  std::uint32_t items_ = 0;
  std::vector<Window> windows_;
};

}  // namespace aspic

#pragma once
// One dispatch: a program, its bindings, and the readers of its output.
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/program.h"

namespace aspic::gl {

/// Who reads a pass's output next: this picks the memory barrier. Combine with `|` where several may.
enum class ReadBy : std::uint32_t {
  nobody = 0,             ///< a pass queued right behind sets the barrier for both
  compute_pass = 1 << 0,  ///< storage blocks of a following pass or shader
  uniform = 1 << 1,       ///< a uniform block
  vertex_draw = 1 << 2,   ///< vertex attributes or indices of a draw
  indirect = 1 << 3,      ///< arguments of an indirect dispatch or draw
  read_back = 1 << 4,     ///< Buffer::download, or mapping
  copy = 1 << 5           ///< Buffer::upload or clear
};
constexpr ReadBy operator|(ReadBy a, ReadBy b) {
  return static_cast<ReadBy>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

/// The bits glMemoryBarrier takes for these readers.
std::uint32_t barrier_bits(ReadBy readers);

/// Makes the output of earlier passes visible to these readers: for callers that did not dispatch them.
void barrier(ReadBy readers);

/// A buffer at a binding number of a program.
struct Binding {
  std::uint32_t binding = 0;       ///< `layout(binding = …)`
  const Buffer* buffer = nullptr;  ///< not null at dispatch; must outlive it
  BufferKind kind = BufferKind::storage;
  std::uint64_t offset = 0;  ///< [bytes], a multiple of the device's offset alignment
  std::uint64_t bytes = 0;   ///< 0: the complete buffer (then offset must be 0)
};

/// Groups along x and y for `count` items.
struct GroupCount {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  bool operator==(const GroupCount&) const = default;
};

/// Most groups along x that every OpenGL 4.3 device takes.
inline constexpr std::uint32_t max_groups_x = 65535;

/// One row up to max_groups_x groups; else the fewest rows that do, all of one length, with fewer than `y`
/// groups beyond those needed. (0, 0) for no items. `group_size` ≥ 1, `count` at most 65,535² groups.
GroupCount groups_for(std::uint32_t count, std::uint32_t group_size);

/// A program with its bindings. Kernels have one invocation per item along a one-dimensional local size,
/// compute their index with item_index() of compute/dispatch.glsl, and return where it is not below the
/// count. Dispatching allocates nothing and costs one GL call for each binding that is not
/// in place already and three more.
class Pass {
 public:
  /// `program` and the bindings' buffers must outlive the pass. `readers`: the usual next use of its output.
  Pass(const Program& program, std::vector<Binding> bindings, ReadBy readers)
      : program_(&program), bindings_(std::move(bindings)), readers_(readers) {}

  /// Runs the kernel for items 0 … count − 1, then sets the barrier. 0 items: nothing at all happens.
  void dispatch_for(std::uint32_t count) const { dispatch_for(count, {}, readers_); }
  /// The same, with `extra` bound after (and so going before) the pass's own bindings.
  void dispatch_for(std::uint32_t count, std::span<const Binding> extra) const {
    dispatch_for(count, extra, readers_);
  }
  void dispatch_for(std::uint32_t count, std::span<const Binding> extra, ReadBy readers) const;

  /// Runs with group counts read from `arguments` (three 32-bit words at byte `offset`, a multiple of 4),
  /// which the pass that wrote them handed to ReadBy::indirect.
  void dispatch_indirect(const Buffer& arguments, std::uint64_t offset = 0,
                         std::span<const Binding> extra = {}) const;

  const Program& program() const { return *program_; }

 private:
  void prepare(std::span<const Binding> extra) const;
  const Program* program_;
  std::vector<Binding> bindings_;
  ReadBy readers_;
};

}  // namespace aspic::gl

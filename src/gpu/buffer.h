#pragma once
// A block of device memory for shader storage or uniform blocks.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/result.h"
#include "gpu/context.h"

namespace aspic::gl {

/// What a buffer is bound as, which decides the limit on its size.
enum class BufferKind {
  storage,  ///< shader storage block; also vertices, indirect arguments, copies
  uniform   ///< uniform block
};

/// Owns one GL buffer object. Movable, not copyable; its context must outlive it and be current in every
/// call, but need not be at its end.
class Buffer {
 public:
  /// An empty handle: id 0, no bytes.
  Buffer() = default;

  /// Allocates `bytes` of undefined content; 0 is legal (a token allocation is made, so that it can be
  /// bound). `name` appears in errors and, on debug contexts, in the driver's messages. Error
  /// (scene_rejected): more than the device's block size, or the device has no memory left; the sentence
  /// gives the figures. Error (no_device): the context is lost. No GL error is left behind.
  static Result<Buffer> create(Context& context, std::string name, std::uint64_t bytes,
                               BufferKind kind = BufferKind::storage);

  /// The error of create() for a size beyond the device's limit.
  static Status check_size(const Context& context, std::string_view name, std::uint64_t bytes,
                           BufferKind kind = BufferKind::storage);

  /// Allocates and fills: the bytes of `items`.
  template <std::ranges::contiguous_range Items>
  static Result<Buffer> of(Context& context, std::string name, const Items& items,
                           BufferKind kind = BufferKind::storage) {
    const std::span<const std::byte> bytes = bytes_of(items);
    Result<Buffer> made = create(context, std::move(name), bytes.size(), kind);
    if (made) made->upload(bytes);
    return made;
  }

  /// Writes `data` from byte `offset` on; must lie within bytes().
  void upload(std::span<const std::byte> data, std::uint64_t offset = 0);
  /// Reads from byte `offset` on, waiting for the device. A pass's output is visible only if that pass, or
  /// one after it, named ReadBy::read_back.
  void download(std::span<std::byte> data, std::uint64_t offset = 0) const;
  /// Calls `read` with the first `bytes` part by part, in their order and where they lie, and with the offset
  /// of each: what is read is copied once. Parts are multiples of 64 bytes but for the last. Parts that a
  /// lost device does not give are left out, and Context::check() says so.
  using ReadPart = std::function<void(std::span<const std::byte> part, std::uint64_t offset)>;
  void read_parts(std::uint64_t bytes, const ReadPart& read) const;
  /// Sets every byte to zero, on the device.
  void clear();

  /// upload() of items, from item `first` on.
  template <std::ranges::contiguous_range Items>
  void upload_items(const Items& items, std::uint64_t first = 0) {
    upload(bytes_of(items), first * sizeof(std::ranges::range_value_t<Items>));
  }
  /// download() of `count` items, from item `first` on.
  template <class T>
  std::vector<T> download_items(std::uint64_t count, std::uint64_t first = 0) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> items(count);
    download(std::as_writable_bytes(std::span(items)), first * sizeof(T));
    return items;
  }

  /// Where it lies; null for an empty handle.
  Context* context() const { return held_.get(); }
  /// The size asked for [bytes].
  std::uint64_t bytes() const { return held_ ? held_.get_deleter().bytes : 0; }
  /// The GL name; 0 for an empty handle.
  std::uint32_t id() const { return held_ ? held_.get_deleter().id : 0; }
  /// Binds it to an indexed binding point, where it stays for later passes and draws; nothing happens if it
  /// is there. `bytes` of it from byte `offset` on, a multiple of the device's offset alignment; 0: all of it
  /// (then offset must be 0). An empty handle leaves the point as it is. Nobody else may bind to these points
  /// with separate GL calls.
  void bind(BufferKind kind, std::uint32_t binding, std::uint64_t offset = 0, std::uint64_t bytes = 0) const;

 private:
  template <class Items>
  static std::span<const std::byte> bytes_of(const Items& items) {
    static_assert(std::is_trivially_copyable_v<std::ranges::range_value_t<Items>>);
    return std::as_bytes(std::span(items));
  }
  struct Release {
    std::uint32_t id;
    std::uint64_t bytes;
    void operator()(Context* context) const;
  };
  std::unique_ptr<Context, Release> held_;  // of its context; empty: no buffer
};

}  // namespace aspic::gl

#pragma once
// What a run and the processes that draw its pictures (run/drawers.h) tell each other.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "device/layout.h"
#include "run/picture_painter.h"

namespace aspic {

/// How a drawer is told what it will draw: the first message.
struct DrawerGreeting {
  PictureSize size;
  std::uint64_t slots = 1;          ///< in the shared memory
  std::string device;               ///< GL_RENDERER that it must have
  std::vector<std::string> scenes;  ///< of each run, as TOML
};

/// A picture to draw: each later message. The states are in the slot.
struct DrawerRequest {
  std::uint64_t slot = 0;
  std::vector<std::uint64_t> steps;  ///< of each run
  std::vector<ShownRun> shown;
};

/// Messages are a length of eight bytes and so many more, in this machine's order.
std::string message_of(const DrawerGreeting& greeting);
std::string message_of(const DrawerRequest& request);
/// From the bytes behind the length. Error (io): they are no such message.
Result<DrawerGreeting> read_greeting(std::string_view bytes);
Result<DrawerRequest> read_request(std::string_view bytes);

// A drawer answers in lines: "ready" to the greeting; to each request "done SLOT DRAW READ", with the seconds
// spent, or ends with an error.

/// The shared memory of a drawer: as many slots, each with the pixels of a picture (FrameSink::write) and the
/// states that it shows.
class SlotLayout {
 public:
  SlotLayout(const PictureSize& size, const std::vector<PaintedRun>& runs);

  /// Of a slot, a multiple of 64.
  std::uint64_t bytes() const { return bytes_; }
  std::span<std::byte> pixels(std::span<std::byte> memory, std::uint64_t slot) const;
  std::span<layout::Particle> particles(std::span<std::byte> memory, std::uint64_t slot,
                                        std::size_t run) const;
  std::span<layout::Ball> balls(std::span<std::byte> memory, std::uint64_t slot, std::size_t run) const;

 private:
  struct Place {
    std::uint64_t particles_at = 0, particles = 0, balls_at = 0, balls = 0;
  };
  std::byte* at(std::span<std::byte> memory, std::uint64_t slot, std::uint64_t offset,
                std::uint64_t size) const;

  std::uint64_t pixels_ = 0, bytes_ = 0;
  std::vector<Place> runs_;
};

}  // namespace aspic

#include "run/drawer_messages.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <type_traits>

namespace aspic {
namespace {

/// Items in a row: numbers and structs of numbers as they are, texts and lists behind their length.
class Writer {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const T& item) { append(&item, sizeof item); }
  void operator()(const std::string& text) {
    (*this)(std::uint64_t{text.size()});
    append(text.data(), text.size());
  }
  template <class T>
  void operator()(const std::vector<T>& items) {
    (*this)(std::uint64_t{items.size()});
    append(items.data(), sizeof(T) * items.size());
  }
  template <class T, class Each>
  void list(const std::vector<T>& things, Each each) {
    (*this)(std::uint64_t{things.size()});
    for (const T& thing : things) each(thing);
  }

  /// With its length.
  std::string message() const {
    const std::uint64_t length = bytes_.size();
    return std::string(reinterpret_cast<const char*>(&length), sizeof length) + bytes_;
  }

 private:
  void append(const void* from, std::size_t size) { bytes_.append(static_cast<const char*>(from), size); }

  std::string bytes_;
};

/// The same the other way. Once something is missing, all that follows is empty.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(T& item) { take(&item, sizeof item); }
  void operator()(std::string& text) {
    text.resize(count(1));
    take(text.data(), text.size());
  }
  template <class T>
  void operator()(std::vector<T>& items) {
    items.resize(count(sizeof(T)));
    take(items.data(), sizeof(T) * items.size());
  }
  template <class T, class Each>
  void list(std::vector<T>& things, Each each) {
    things.resize(count(1));
    for (T& thing : things) each(thing);
  }

  Status end() const {
    if (whole_ && bytes_.empty()) return {};
    return Error{ErrorCode::io, "a message to a process that draws pictures is damaged."};
  }

 private:
  /// Of things that follow, each of at least `size` bytes.
  std::size_t count(std::size_t size) {
    std::uint64_t number = 0;
    (*this)(number);
    whole_ = whole_ && number <= bytes_.size() / size;
    return whole_ ? static_cast<std::size_t>(number) : 0;
  }
  void take(void* to, std::size_t size) {
    whole_ = whole_ && size <= bytes_.size();
    if (!whole_ || size == 0) return;
    std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }

  std::string_view bytes_;
  bool whole_ = true;
};

// What a message holds, in its order, for a Writer and for a Reader.

template <class Items, class Greeting>
void greeting_items(Items& items, Greeting& greeting) {
  items(greeting.size);
  items(greeting.slots);
  items(greeting.device);
  items.list(greeting.scenes, [&](auto& scene) { items(scene); });
}

template <class Items, class Request>
void request_items(Items& items, Request& request) {
  items(request.slot);
  items(request.steps);
  items.list(request.shown, [&](auto& shown) {
    items(shown.camera);
    items.list(shown.text, [&](auto& line) {
      items(line.label);
      items(line.value);
      items(line.alarm);
      items(line.tint);
    });
    items(shown.text_height);
    items(shown.legend);
    items(shown.tint);
    items(shown.framed);
    items(shown.arrows.arrows);
    items(shown.arrows.room);
    items(shown.arrows.noise);
    items(shown.ball_turns);
    items(shown.channels);
  });
}

constexpr std::uint64_t rounded_up(std::uint64_t bytes) {
  return (bytes + 63) / 64 * 64;
}

}  // namespace

std::string message_of(const DrawerGreeting& greeting) {
  Writer to;
  greeting_items(to, greeting);
  return to.message();
}

Result<DrawerGreeting> read_greeting(std::string_view bytes) {
  Reader from(bytes);
  DrawerGreeting greeting;
  greeting_items(from, greeting);
  ASPIC_CHECK(from.end());
  return greeting;
}

std::string message_of(const DrawerRequest& request) {
  Writer to;
  request_items(to, request);
  return to.message();
}

Result<DrawerRequest> read_request(std::string_view bytes) {
  Reader from(bytes);
  DrawerRequest request;
  request_items(from, request);
  ASPIC_CHECK(from.end());
  return request;
}

SlotLayout::SlotLayout(const PictureSize& size, const std::vector<PaintedRun>& runs)
    : pixels_(std::uint64_t{3} * static_cast<std::uint64_t>(size.width) *
              static_cast<std::uint64_t>(size.height)) {
  bytes_ = rounded_up(pixels_);
  for (const PaintedRun& run : runs) {
    Place place;
    place.particles = run.model->particle_count();
    place.particles_at = bytes_;
    bytes_ = rounded_up(bytes_ + sizeof(layout::Particle) * place.particles);
    place.balls = run.model->ball_count();
    place.balls_at = bytes_;
    bytes_ = rounded_up(bytes_ + sizeof(layout::Ball) * place.balls);
    runs_.push_back(place);
  }
}

std::byte* SlotLayout::at(std::span<std::byte> memory, std::uint64_t slot, std::uint64_t offset,
                          std::uint64_t size) const {
  assert(memory.size() / bytes_ > slot && offset + size <= bytes_);
  return memory.data() + slot * bytes_ + offset;
}

std::span<std::byte> SlotLayout::pixels(std::span<std::byte> memory, std::uint64_t slot) const {
  return {at(memory, slot, 0, pixels_), pixels_};
}

std::span<layout::Particle> SlotLayout::particles(std::span<std::byte> memory, std::uint64_t slot,
                                                  std::size_t run) const {
  const Place& place = runs_[run];
  const std::uint64_t size = sizeof(layout::Particle) * place.particles;
  return {reinterpret_cast<layout::Particle*>(at(memory, slot, place.particles_at, size)), place.particles};
}

std::span<layout::Ball> SlotLayout::balls(std::span<std::byte> memory, std::uint64_t slot,
                                          std::size_t run) const {
  const Place& place = runs_[run];
  const std::uint64_t size = sizeof(layout::Ball) * place.balls;
  return {reinterpret_cast<layout::Ball*>(at(memory, slot, place.balls_at, size)), place.balls};
}

}  // namespace aspic

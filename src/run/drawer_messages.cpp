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
  void put(const T& item) { bytes_.append(reinterpret_cast<const char*>(&item), sizeof item); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put_items(std::span<const T> items) {
    put(std::uint64_t{items.size()});
    bytes_.append(reinterpret_cast<const char*>(items.data()), items.size_bytes());
  }
  void put(const std::string& text) { put_items(std::span<const char>(text)); }

  /// With its length.
  std::string message() const {
    const std::uint64_t length = bytes_.size();
    return std::string(reinterpret_cast<const char*>(&length), sizeof length) + bytes_;
  }

 private:
  std::string bytes_;
};

/// The same the other way. Once something is missing, all that follows is empty.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  void get(T& item) {
    static_assert(std::is_trivially_copyable_v<T>);
    take(&item, sizeof item);
  }
  template <class T>
  void get_items(std::vector<T>& items) {
    items.resize(count(sizeof(T)));
    take(items.data(), sizeof(T) * items.size());
  }
  void get(std::string& text) {
    text.resize(count(1));
    take(text.data(), text.size());
  }
  /// Of things that follow, each of at least `size` bytes.
  std::size_t count(std::size_t size) {
    std::uint64_t number = 0;
    get(number);
    whole_ = whole_ && number <= bytes_.size() / size;
    return whole_ ? static_cast<std::size_t>(number) : 0;
  }
  Status end() const {
    if (whole_ && bytes_.empty()) return {};
    return Error{ErrorCode::io, "a message to a process that draws pictures is damaged."};
  }

 private:
  void take(void* to, std::size_t size) {
    whole_ = whole_ && size <= bytes_.size();
    if (!whole_ || size == 0) return;
    std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }

  std::string_view bytes_;
  bool whole_ = true;
};

void put(Writer& to, const std::optional<Colour>& colour) {
  to.put(colour.has_value());
  to.put(colour.value_or(Colour{}));
}

void get(Reader& from, std::optional<Colour>& colour) {
  bool there = false;
  Colour given;
  from.get(there);
  from.get(given);
  if (there) colour = given;
}

void put(Writer& to, const ShownRun& shown) {
  to.put(shown.camera);
  to.put(std::uint64_t{shown.text.size()});
  for (const OverlayLine& line : shown.text) {
    to.put(line.label);
    to.put(line.value);
    to.put(line.alarm);
    put(to, line.tint);
  }
  to.put(shown.text_height);
  to.put(shown.legend);
  put(to, shown.tint);
  to.put(shown.framed);
  to.put_items(std::span(shown.arrows.arrows));
  to.put(shown.arrows.room);
  to.put(shown.arrows.noise);
  to.put_items(std::span(shown.ball_turns));
}

void get(Reader& from, ShownRun& shown) {
  from.get(shown.camera);
  shown.text.resize(from.count(1));
  for (OverlayLine& line : shown.text) {
    from.get(line.label);
    from.get(line.value);
    from.get(line.alarm);
    get(from, line.tint);
  }
  from.get(shown.text_height);
  from.get(shown.legend);
  get(from, shown.tint);
  from.get(shown.framed);
  from.get_items(shown.arrows.arrows);
  from.get(shown.arrows.room);
  from.get(shown.arrows.noise);
  from.get_items(shown.ball_turns);
}

constexpr std::uint64_t rounded_up(std::uint64_t bytes) {
  return (bytes + 63) / 64 * 64;
}

}  // namespace

std::string message_of(const DrawerGreeting& greeting) {
  Writer to;
  to.put(greeting.size);
  to.put(greeting.slots);
  to.put(greeting.device);
  to.put(std::uint64_t{greeting.scenes.size()});
  for (const std::string& scene : greeting.scenes) to.put(scene);
  return to.message();
}

Result<DrawerGreeting> read_greeting(std::string_view bytes) {
  Reader from(bytes);
  DrawerGreeting greeting;
  from.get(greeting.size);
  from.get(greeting.slots);
  from.get(greeting.device);
  greeting.scenes.resize(from.count(1));
  for (std::string& scene : greeting.scenes) from.get(scene);
  ASPIC_CHECK(from.end());
  return greeting;
}

std::string message_of(const DrawerRequest& request) {
  Writer to;
  to.put(request.slot);
  to.put_items(std::span(request.steps));
  to.put(std::uint64_t{request.shown.size()});
  for (const ShownRun& shown : request.shown) put(to, shown);
  return to.message();
}

Result<DrawerRequest> read_request(std::string_view bytes) {
  Reader from(bytes);
  DrawerRequest request;
  from.get(request.slot);
  from.get_items(request.steps);
  request.shown.resize(from.count(1));
  for (ShownRun& shown : request.shown) get(from, shown);
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

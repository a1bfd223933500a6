#include "run/drawer.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <optional>

#include "aspic/scene.h"
#include "base/stopwatch.h"
#include "gpu/pixel_ring.h"
#include "io/child_process.h"
#include "io/console.h"
#include "io/shared_memory.h"
#include "run/drawer_messages.h"

namespace aspic {
namespace {

using Clock = std::chrono::steady_clock;

/// False: the stream ended early.
bool read_all(char* to, std::size_t size) {
  while (size > 0) {
    const ssize_t got = ::read(STDIN_FILENO, to, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    to += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

/// Nothing: whoever sent them has ended.
std::optional<std::string> next_message() {
  std::uint64_t length = 0;
  if (!read_all(reinterpret_cast<char*>(&length), sizeof length)) return std::nullopt;
  std::string bytes(length, '\0');
  if (!read_all(bytes.data(), bytes.size())) return std::nullopt;
  return bytes;
}

/// All that this process has for its pictures.
class Drawer {
 public:
  static Result<std::unique_ptr<Drawer>> create(const DrawerGreeting& greeting) {
    auto d = std::make_unique<Drawer>();
    for (const std::string& text : greeting.scenes) {
      ASPIC_TRY(auto scene, parse_scene(text, "the scene"));
      d->scenes_.push_back(std::make_unique<Scene>(std::move(scene)));
      ASPIC_TRY(auto model, build_model(d->scenes_.back()->model));
      d->models_.push_back(std::make_unique<Model>(std::move(model)));
      d->runs_.push_back({d->scenes_.back().get(), d->models_.back().get()});
    }
    d->layout_.emplace(greeting.size, d->runs_);
    d->slots_ = greeting.slots;
    ASPIC_TRY(d->memory_, SharedMemory::open(ChildProcess::shared_descriptor));
    if (d->memory_.bytes().size() < d->slots_ * d->layout_->bytes())
      return Error{ErrorCode::io, "the shared memory is too small."};
    ASPIC_TRY(d->context_, gl::Context::create_headless());
    if (d->context_->info().renderer != greeting.device)
      return fail(ErrorCode::no_device, "this process draws on {}, and not on {}.",
                  d->context_->info().renderer, greeting.device);
    ASPIC_TRY(d->painter_, PicturePainter::create(*d->context_, greeting.size, d->runs_));
    return d;
  }

  /// Draws a picture into its slot; the answer.
  Result<std::string> draw(const DrawerRequest& request) {
    if (request.slot >= slots_ || request.steps.size() != runs_.size() ||
        request.shown.size() != runs_.size())
      return Error{ErrorCode::io, "a picture was asked for that is none of this run."};
    const std::span<std::byte> memory = memory_.bytes();
    const auto start = Clock::now();
    std::vector<DeviceState> states;
    for (std::size_t i = 0; i < runs_.size(); ++i) {
      const auto particles = layout_->particles(memory, request.slot, i);
      const auto balls = layout_->balls(memory, request.slot, i);
      ASPIC_TRY(auto state, painter_->renderer(i).upload({particles.begin(), particles.end()},
                                                         {balls.begin(), balls.end()}, request.steps[i]));
      states.push_back(state);
    }
    ASPIC_CHECK(painter_->draw(states, request.shown));
    const double draw = seconds_since(start);
    const auto before = Clock::now();
    ASPIC_CHECK(
        gl::read_rgb(*context_, painter_->picture(), scratch_, layout_->pixels(memory, request.slot)));
    ASPIC_CHECK(context_->check());
    return fmt::format("done {} {} {}\n", request.slot, draw, seconds_since(before));
  }

 private:
  std::vector<std::unique_ptr<Scene>> scenes_;
  std::vector<std::unique_ptr<Model>> models_;
  std::vector<PaintedRun> runs_;
  std::optional<SlotLayout> layout_;
  std::uint64_t slots_ = 0;
  SharedMemory memory_;
  std::shared_ptr<gl::Context> context_;
  std::unique_ptr<PicturePainter> painter_;
  std::vector<std::byte> scratch_;
};

}  // namespace

Status serve_pictures() {
  const auto greeting_bytes = next_message();
  if (!greeting_bytes) return {};
  ASPIC_TRY(const auto greeting, read_greeting(*greeting_bytes));
  ASPIC_TRY(const auto drawer, Drawer::create(greeting));
  ASPIC_CHECK(print_data("ready\n"));
  while (const auto bytes = next_message()) {
    ASPIC_TRY(const auto request, read_request(*bytes));
    ASPIC_TRY(const auto answer, drawer->draw(request));
    ASPIC_CHECK(print_data(answer));
  }
  return {};
}

}  // namespace aspic

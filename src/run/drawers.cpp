#include "run/drawers.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <sstream>

#include "aspic/scene.h"
#include "base/memory.h"
#include "base/printable.h"
#include "cpu_parallel/workers.h"
#include "io/child_process.h"
#include "io/console.h"
#include "io/shared_memory.h"

namespace aspic {
namespace {

/// Pictures under way at once in each process: one that is drawn, one that waits, one that is encoded, and as
/// many more as small ones have room for, so that nobody waits for hiccups of the others.
std::uint64_t slots_of(const SlotLayout& layout) {
  constexpr std::uint64_t room = std::uint64_t{32} << 20;
  return std::clamp<std::uint64_t>(room / layout.bytes(), 3, 16);
}

constexpr unsigned most_drawers = 64;
/// A picture's threads and the encoder keep two processors busy by themselves (docs/performance.md).
constexpr unsigned least_processors = 3;

/// Pixels for which it pays to start a process: half a second of a processor.
constexpr std::uint64_t least_pixels = std::uint64_t{20} * 1280 * 720;

/// What a process takes besides its slots [bytes]: program and driver, images by pixel (two sets of four
/// samples with depth, and more), a model's buffers by particle.
constexpr std::uint64_t process_bytes = std::uint64_t{160} << 20, pixel_bytes = 128, particle_bytes = 512;

std::uint64_t memory_of(const DrawingWork& work) {
  const SlotLayout layout(work.size, work.runs);
  std::uint64_t bytes = process_bytes + slots_of(layout) * layout.bytes() +
                        pixel_bytes * static_cast<std::uint64_t>(work.size.width) *
                            static_cast<std::uint64_t>(work.size.height);
  for (const PaintedRun& run : work.runs) bytes += particle_bytes * run.model->particle_count();
  return bytes;
}

}  // namespace

Result<unsigned> drawers_for(const DrawingWork& work) {
  if (const char* const text = std::getenv("ASPIC_DRAWERS")) {
    const std::string_view word = text;
    unsigned asked = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), asked);
    if (error == std::errc{} && end == word.data() + word.size() && asked <= most_drawers)
      return work.command.empty() ? 0 : asked;
    return fail(
        ErrorCode::usage,
        "ASPIC_DRAWERS is \"{}\", which is not a number of processes: set a whole number from 0 to {}, "
        "or unset it.",
        printable_line(word), most_drawers);
  }
  if (work.command.empty()) return 0;
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(work.size.width) * static_cast<std::uint64_t>(work.size.height);
  const unsigned processors = parallel::own_processors();
  if (processors < least_processors) return 0;
  std::uint64_t count = std::min(most_drawers, processors);
  count = std::min(count, work.pictures / std::max<std::uint64_t>(least_pixels / pixels, 1));
  // Half of what is free: the run itself may want more later.
  if (const auto free = available_memory()) count = std::min(count, *free / 2 / memory_of(work));
  return count < 2 ? 0 : static_cast<unsigned>(count);
}

struct Drawers::Drawer {
  Drawer(ChildProcess started, SharedMemory shared, std::uint64_t slots)
      : child(std::move(started)), memory(std::move(shared)), taken(slots) {}

  std::optional<ChildProcess> child;  // none: it is lost
  SharedMemory memory;
  std::vector<std::atomic<bool>> taken;  // slots
  unsigned asked = 0;                    // pictures that have not come yet
  bool ready = false;                    // it has answered the greeting
  bool drew = false;                     // a picture of its own has come
};

Drawers::Drawers(SlotLayout layout) : layout_(std::move(layout)) {}
Drawers::~Drawers() = default;

Result<std::unique_ptr<Drawers::Drawer>> Drawers::start_one(const DrawingWork& work,
                                                            const std::string& greeting,
                                                            const SlotLayout& layout) {
  const std::uint64_t slots = slots_of(layout);
  ASPIC_TRY(auto memory, SharedMemory::create(slots * layout.bytes()));
  // Its own thread alone rasterises: there are as many processes as processors.
  ChildExtras extras = {{{"LP_NUM_THREADS", "0"}}, memory.descriptor()};
  if (!std::getenv("ASPIC_EGL_DEVICE")) extras.environment.emplace_back("ASPIC_EGL_DEVICE", "software");
  ASPIC_TRY(auto child, ChildProcess::start(work.command, ChildProcess::Output::answers, extras));
  (void)child.write(std::as_bytes(std::span(greeting)));  // a dead process is noticed when it fails to answer
  return std::make_unique<Drawer>(std::move(child), std::move(memory), slots);
}

std::unique_ptr<Drawers> Drawers::start(const DrawingWork& work, const std::string& device, unsigned count) {
  std::unique_ptr<Drawers> d(new Drawers(SlotLayout(work.size, work.runs)));
  DrawerGreeting greeting = {work.size, slots_of(d->layout_), device, {}};
  for (const PaintedRun& run : work.runs) greeting.scenes.push_back(to_toml(*run.scene));
  const std::string message = message_of(greeting);
  for (unsigned i = 0; i < count; ++i) {
    auto drawer = start_one(work, message, d->layout_);
    if (!drawer) {
      print_warning(fmt::format("{} of {} processes draw pictures: {}", i, count, drawer.error().what));
      break;
    }
    d->drawers_.push_back(std::move(*drawer));
  }
  if (d->drawers_.empty()) return nullptr;
  return d;
}

unsigned Drawers::count() const {
  return static_cast<unsigned>(
      std::ranges::count_if(drawers_, [](const auto& drawer) { return drawer->child.has_value(); }));
}

unsigned Drawers::useful() const {
  return static_cast<unsigned>(
      std::ranges::count_if(drawers_, [](const auto& drawer) { return drawer->drew; }));
}

std::optional<Drawers::Place> Drawers::free_place() const {
  std::optional<Place> best;
  for (std::size_t i = 0; i < drawers_.size(); ++i) {
    const Drawer& drawer = *drawers_[i];
    if (!drawer.child || (best && drawer.asked >= drawers_[best->drawer]->asked)) continue;
    const auto free = std::ranges::find_if(drawer.taken, [](const auto& taken) { return !taken; });
    if (free != drawer.taken.end()) best = Place{i, static_cast<std::uint64_t>(free - drawer.taken.begin())};
  }
  return best;
}

std::span<layout::Particle> Drawers::particles(const Place& place, std::size_t run) const {
  return layout_.particles(drawers_[place.drawer]->memory.bytes(), place.slot, run);
}

std::span<layout::Ball> Drawers::balls(const Place& place, std::size_t run) const {
  return layout_.balls(drawers_[place.drawer]->memory.bytes(), place.slot, run);
}

void Drawers::ask(const Place& place, const DrawerRequest& request) {
  Drawer& drawer = *drawers_[place.drawer];
  drawer.taken[place.slot] = true;
  ++drawer.asked;
  const std::string message = message_of(request);
  if (!drawer.child->write(std::as_bytes(std::span(message)))) lose(drawer);
}

bool Drawers::answered(const Place& place) {
  Drawer& drawer = *drawers_[place.drawer];
  if (!drawer.child) return true;
  if (!drawer.ready && drawer.child->answered()) {
    drawer.ready = drawer.child->line() == "ready";
    if (!drawer.ready) lose(drawer);
  }
  return !drawer.child || (drawer.ready && drawer.child->answered());
}

std::optional<Drawers::Drawn> Drawers::take(const Place& place) {
  Drawer& drawer = *drawers_[place.drawer];
  --drawer.asked;
  if (drawer.child && !drawer.ready) {
    drawer.ready = drawer.child->line() == "ready";
    if (!drawer.ready) lose(drawer);
  }
  if (!drawer.child) return std::nullopt;
  std::istringstream words(drawer.child->line().value_or(""));
  std::string word;
  std::uint64_t slot = 0;
  Drawn drawn;
  const bool answered = static_cast<bool>(words >> word >> slot >> drawn.draw >> drawn.read);
  if (answered && word == "done" && slot == place.slot) {
    drawer.drew = true;
    drawn.rgb = layout_.pixels(drawer.memory.bytes(), place.slot);
    return drawn;
  }
  if (answered) drawer.child->kill();  // it does not do what it was asked for
  lose(drawer);
  return std::nullopt;
}

std::shared_ptr<const void> Drawers::owner(const Place& place) const {
  std::atomic<bool>& taken = drawers_[place.drawer]->taken[place.slot];
  return {&taken, [&taken](const void*) { taken = false; }};
}

void Drawers::lose(Drawer& drawer) {
  const ChildProcess::End end = drawer.child->finish(std::chrono::seconds(2));
  std::string how = drawer.child->last_lines(3);
  if (how.empty())
    how = end.signal != 0 ? fmt::format("ended by signal {}\n", end.signal)
                          : fmt::format("ended with exit code {}\n", end.exit_code);
  drawer.child.reset();
  how.pop_back();
  // Whatever ends one may end all: it is said once.
  if (!told_.insert(how).second) return;
  print_warning(
      fmt::format("A process that draws pictures was lost ({}). What it was to draw is drawn by this one{}.",
                  how, count() > 0 ? ", the rest by the others" : ""));
}

void Drawers::end() {
  for (const auto& drawer : drawers_) drawer->child.reset();
}

}  // namespace aspic

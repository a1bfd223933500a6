#pragma once
// Processes that draw the pictures of a run. A software rasteriser's threads share one picture badly, while
// processes, each with one thread and a picture to itself, share a film well.
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "device/layout.h"
#include "run/drawer_messages.h"
#include "run/picture_painter.h"

namespace aspic {

/// What would be drawn by processes.
struct DrawingWork {
  std::vector<std::string> command;  ///< a program that calls serve_pictures(); empty: no processes
  PictureSize size;
  std::vector<PaintedRun> runs;
  std::uint64_t pictures = 1;  ///< in all, ≥ 1
};

/// How many processes should draw it on a software rasteriser: what the environment variable ASPIC_DRAWERS
/// says, else as many as there are processors, if more than two, work and memory for; 0: none. Error (usage):
/// ASPIC_DRAWERS is no number from 0 to 64.
Result<unsigned> drawers_for(const DrawingWork& work);

/// Some processes, each with slots of shared memory for the pictures that it is asked for. For one thread; a
/// picture's owner may go on any. They end with it.
class Drawers {
 public:
  /// `device`: GL_RENDERER of the context that pictures are drawn with otherwise. Null: none could be
  /// started.
  static std::unique_ptr<Drawers> start(const DrawingWork& work, const std::string& device, unsigned count);
  ~Drawers();
  Drawers(const Drawers&) = delete;
  Drawers& operator=(const Drawers&) = delete;

  /// How many work at present.
  unsigned count() const;
  /// How many have drawn a picture so far.
  unsigned useful() const;

  /// A slot of a process.
  struct Place {
    std::size_t drawer = 0;
    std::uint64_t slot = 0;
  };
  /// A free slot of the process that has the least to do; nothing while all are taken.
  std::optional<Place> free_place() const;
  /// Where a run's state is to be put, or was.
  std::span<layout::Particle> particles(const Place& place, std::size_t run) const;
  std::span<layout::Ball> balls(const Place& place, std::size_t run) const;

  /// Asks for the picture of the states in a free slot, which is taken from then on. A process that has died
  /// does not answer.
  void ask(const Place& place, const DrawerRequest& request);

  /// A picture that was drawn, with the seconds spent.
  struct Drawn {
    std::span<const std::byte> rgb;
    double draw = 0.0, read = 0.0;
  };
  /// Whether take() would return at once.
  bool answered(const Place& place);
  /// Waits for a picture; of one process they come in the order in which they were asked for. Nothing: the
  /// process has ended without it, which is said once; the states are still in the slot.
  std::optional<Drawn> take(const Place& place);
  /// The slot is free again when what this returns is gone. Legal after take().
  std::shared_ptr<const void> owner(const Place& place) const;

  /// Ends all processes.
  void end();

 private:
  struct Drawer;
  explicit Drawers(SlotLayout layout);
  static Result<std::unique_ptr<Drawer>> start_one(const DrawingWork& work, const std::string& greeting,
                                                   const SlotLayout& layout);
  void lose(Drawer& drawer);

  SlotLayout layout_;
  std::vector<std::unique_ptr<Drawer>> drawers_;
  std::set<std::string> told_;  // what has ended some of them
};

}  // namespace aspic

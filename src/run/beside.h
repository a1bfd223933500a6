#pragma once
// Several runs of one scene, each with a difference, on one clock and in one picture.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "io/film_format.h"
#include "io/frame_schedule.h"
#include "model/solver.h"
#include "render/overlay.h"
#include "run/variation.h"

namespace aspic {

/// Most runs in a picture.
inline constexpr std::size_t most_beside = 4;

/// KEY=VALUE as a variation. Error (usage): a part is missing.
Result<Variation> parse_variation(const std::string& text);

/// The run of the scene itself, and one for each KEY=VALUE, each with that difference alone. Errors: usage,
/// more than most_beside runs, or no KEY=VALUE; those of varied(), which then say which one it is.
Result<std::vector<Variant>> runs_beside(const Scene& scene, const BackendChoice& backend,
                                         const std::vector<Variation>& differences);

/// How a run differs from the others: a line for each key that differs in one of them, once.
/// `backend`: what computes this one.
std::vector<OverlayLine> label_of(const std::vector<Variation>& differences, const Scene& scene,
                                  const std::string& backend);

/// The text on the picture of a run: its label, its time [s], and that it diverged, if it did.
std::vector<OverlayLine> beside_text(std::vector<OverlayLine> label, double time, double timestep,
                                     const std::optional<Divergence>& divergence);

/// Height of the text on the parts of a picture of that height, which so many runs share [pixels].
int beside_text_height(int picture_height, std::size_t runs);

/// How far a run with its own time step goes.
struct Span {
  double timestep = 0.0;        ///< [s], > 0
  std::uint64_t last_step = 0;  ///< where it ends
};

/// The step of a run that lasts as long as `steps` steps of `first`, to its nearest step. Error (usage): more
/// steps than can be counted.
Result<std::uint64_t> as_long_as(const SimulationSettings& first, std::uint64_t steps,
                                 const SimulationSettings& run);

/// Which state of each run a picture shows: that of its own step nearest to the picture's time, at most half
/// of its time step away; in the last picture its last. The first run says when that is.
class CommonClock {
 public:
  /// At least one run, each from step 0. fps and speed as of FrameSchedule.
  CommonClock(std::vector<Span> runs, double fps, double speed);
  /// Pictures in all, ≥ 1.
  std::uint64_t count() const { return count_; }
  /// The step of run `run` in picture `frame` < count(); never decreases.
  std::uint64_t step_of(std::size_t run, std::uint64_t frame) const;

 private:
  std::vector<Span> runs_;
  std::vector<FrameSchedule> schedules_;
  std::uint64_t count_;
};

/// A run's part of a picture [pixels from left and top].
struct Tile {
  int left = 0, top = 0, width = 1, height = 1;
  friend bool operator==(const Tile&, const Tile&) = default;
};

/// The parts of 1 to most_beside runs, all of one size, with two or three pixels between them: two side by
/// side, in a picture that is higher than wide one above the other; three and four in two rows.
std::vector<Tile> tiles_of(const PictureSize& picture, std::size_t runs);

/// FILE with a run's number before its ending: `energy-2.csv`.
std::string numbered_path(const std::string& path, std::size_t number);

}  // namespace aspic

#pragma once
// A run as one HTML file: what it was, every image's particles, and the program that shows them in a
// browser.
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "aspic/analysis.h"
#include "aspic/scene.h"
#include "aspic/solver.h"
#include "base/result.h"
#include "io/atomic_file.h"
#include "io/state_sink.h"
#include "page/packing.h"

namespace aspic::page {

/// What a page is made with.
struct PageSettings {
  double fps = 60.0;         ///< images per second shown at the speed below, > 0
  double speed = 1.0;        ///< simulated seconds per second shown when it opens, > 0
  std::string command = {};  ///< that writes it again; empty: none does
  /// It holds no images but the keys of its one scene, and computes them in the browser (live_facts.h). The
  /// first state that is added is where it starts; of the others it holds the hashes, to compare with.
  bool live = false;
  std::optional<std::uint64_t> last_step = {};  ///< of a live run, as planned; absent: its last state's
};

/// A run of a page; scene and model must live until begin() has returned.
struct PageRun {
  const Scene* scene = nullptr;
  const Model* model = nullptr;
  std::string name = {};  ///< what distinguishes it from those next to it; empty where it is alone
};

/// Positions that a page may hold at most: a browser keeps them as 12 bytes each.
inline constexpr std::uint64_t most_positions = 50000000;
/// Characters of a page at most.
inline constexpr std::uint64_t most_characters = 256u << 20;

/// Whether so many images of so many particles and balls fit into a page; one that is live keeps velocities
/// too. Error (usage) with both figures and the `fps` that would.
Status check_page(std::uint64_t images, std::uint64_t positions_each, double fps, bool live = false);

/// Whether a file's name can be a page's: it ends in .html or .htm, or in nothing. Error (usage).
Status check_page_name(const std::string& path);

class PageWriter {
 public:
  /// Opens the file, which proves that its place can be written. Errors: AtomicFile::create; no memory.
  static Result<PageWriter> create(const std::string& path, Overwrite overwrite);
  const std::string& path() const { return file_.path(); }

  /// Writes everything that is known before the first image; at least one run, of a live page one. Error
  /// (io); live_module().
  Status begin(const PageSettings& settings, std::span<const PageRun> runs);
  bool begun() const { return !models_.empty(); }
  /// Adds an image: a state of each run, whose models must still live. One in which no run went on since the
  /// last one is left out. `inputs`: those that hold, by run; of runs beyond them none. Errors: io, also
  /// where the page becomes longer than most_characters or holds more than most_positions; diverged if a
  /// number is not finite.
  Status add(std::span<const State* const> states, std::span<const Inputs> inputs = {});
  /// Completes the file with what became of each run: its last state, which must have been added, and its
  /// divergence, if it diverged in the step after it.
  Status finish(std::span<const State* const> states, std::span<const std::optional<Divergence>> divergences);
  /// Characters so far.
  std::uint64_t characters() const { return characters_; }

 private:
  struct Tracks {
    Track particles, balls, spins, changes;
    std::vector<double> kinetic, elastic, gravitational, work;  // [J], by image; of actuators where it has
    std::vector<std::uint64_t> steps;
    std::vector<std::string> hashes = {};  // of a live page
    ActuatorWork actuators;
    Meter meter;
  };
  Status add_live(const State& state);
  PageWriter(AtomicFile file, Deflater deflater) : file_(std::move(file)), deflater_(std::move(deflater)) {}
  Status write(std::string_view text);
  Status pack(const Result<std::string>& bytes, bool last);

  AtomicFile file_;
  Deflater deflater_;
  std::vector<const Model*> models_;
  std::vector<Tracks> tracks_;
  std::string_view module_ = {};  // of a live page
  bool starts_ = false;           // elsewhere than the scene does
  std::string rest_;              // bytes that do not fill a group of base64 yet
  std::uint64_t characters_ = 0, positions_ = 0;
};

/// A page of one run, which takes its states as the other files of a run do. `first_step` ≤ `last_step`: of
/// the run, as planned.
Result<std::unique_ptr<StateSink>> open_page(const std::string& path, Overwrite overwrite, const Scene& scene,
                                             const PageSettings& settings, std::uint64_t first_step,
                                             std::uint64_t last_step);

}  // namespace aspic::page

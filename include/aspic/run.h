#pragma once
// Runs: backends, output files, and recording of videos and images.
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/error.h"
#include "aspic/export.h"
#include "aspic/files.h"
#include "aspic/model.h"
#include "aspic/scene.h"
#include "aspic/solver.h"

namespace aspic {

struct BackendRow;  // of the library's table

/// What there is to know of a backend before one is made.
struct BackendInfo {
  std::string_view name;     ///< "gpu"
  std::string_view title;    ///< in a sentence and on a button: "Switch to GPU"
  std::string_view summary;  ///< what it is, in a line
  bool doubles = false;      ///< it computes in double precision too
  bool fast = false;         ///< it has fast arithmetic
  bool threaded = false;     ///< its number of threads can be chosen
};
/// All backends, in the order in which `auto` tries them. The last is the reference, which runs everywhere
/// and against which the others are measured.
ASPIC_API std::vector<BackendInfo> list_backends();

/// What the user asked for.
struct BackendChoice {
  const BackendRow* row = nullptr;              ///< null: auto
  Precision precision = Precision::single;      ///< one that the row has
  ForcePath force_path = ForcePath::automatic;  ///< one that the row has, or automatic
  Arithmetic arithmetic = Arithmetic::exact;    ///< fast: only if the row has it
  unsigned threads = 0;  ///< 1 to 1024, only if the row takes a number; 0: as many as are worthwhile

  friend bool operator==(const BackendChoice&, const BackendChoice&) = default;
};

/// A backend with its options after colons: "gpu:per-spring", "reference:double", "gpu:fast". What the text
/// leaves open is as in `asked`, where the backend has it. Error (usage): an unknown word.
ASPIC_API Result<BackendChoice> parse_backend(std::string_view text, const BackendChoice& asked = {});

/// Every word of parse_backend(): "auto, gpu, cpu, reference".
ASPIC_API std::string backend_words();

/// A solver with what a report says of it. The solver holds what it needs, so that all of this may be moved,
/// assigned and destroyed in any order, on the threads that the solver allows.
struct Backend {
  const BackendRow* row = nullptr;  ///< of the table
  std::unique_ptr<Solver> solver;   ///< at the state it was last load()ed; never null after make_backend()
  std::string device;               ///< the driver's name of it, or what the solver says of itself
  std::string force_path;           ///< "gather", …; empty if the backend has none
  Arithmetic arithmetic = Arithmetic::exact;  ///< as chosen
  std::string reason;                         ///< why `auto` took it; empty if it was named

  /// "gpu:gather", "gpu:fast", "reference:double", "reference".
  ASPIC_API std::string variant() const;
};

/// Makes the solver of a choice, `auto` included, at the model's initial state. Errors: usage, the backend
/// has not all of it; no_device, which says what is missing; scene_rejected, larger than the device or
/// memory. Call it on the thread that will use a gpu solver.
ASPIC_API Result<Backend> make_backend(const BackendChoice& choice, SharedModel model);

/// A file of states.
struct StateOutput {
  std::string option;                  ///< "state", "series", "checkpoint" or "export"
  std::string path;                    ///< empty: none
  std::optional<std::uint64_t> every;  ///< steps, ≥ 1; absent: what the format has
};

/// Images, videos and pages of a run.
struct ImageOutput {
  std::string video, frames;  ///< file and directory; empty: none
  std::string page;           ///< HTML file for browsers; empty: none
  std::string page_live;      ///< one that simulates the run in the browser; empty: none
  const VideoFormat* frames_format = find_video_format("png");  ///< of `frames`
  std::optional<double> fps;  ///< frames per second shown, > 0; absent: those of the format
  double speed = 1.0;         ///< simulated seconds per second shown, > 0
  ImageSize size;             ///< of frames
  bool text = true;           ///< parameters and time are written on them

  /// Whether anything is drawn: a page is not.
  bool any() const { return !video.empty() || !frames.empty(); }
  bool any_page() const { return !page.empty() || !page_live.empty(); }  ///< of either kind
};

/// What a page needs to know of a run before it starts.
struct PageFacts {
  const Scene* scene = nullptr;                 ///< null: there is no page
  std::uint64_t first_step = 0, last_step = 0;  ///< as planned
  std::string command = {};                     ///< that writes the page again; empty: none does
  Precision precision = Precision::single;      ///< of the solver
  Arithmetic arithmetic = Arithmetic::exact;    ///< of the solver
};

/// The files of a run: opened before it, completed after it. One that fails on the way does not keep the
/// others from being written. Calls may come from any thread, one at a time.
class ASPIC_API RunFiles {
 public:
  RunFiles(RunFiles&&) noexcept;
  RunFiles& operator=(RunFiles&&) noexcept;
  ~RunFiles();

  /// Opens every file that is named; the page of `images` where `page` tells of its run. Errors: usage for
  /// one name given twice, a page of more than it holds, or a live page of what a browser cannot repeat:
  /// double precision, fast arithmetic, inputs; io; interrupted.
  static Result<RunFiles> open(const std::vector<StateOutput>& states, const ImageOutput& images,
                               const RunFacts& facts, Overwrite overwrite, const PageFacts& page = {});

  /// The first step after `step` at which a file wants the state; the largest number if none does.
  std::uint64_t next_step(std::uint64_t step) const;
  /// Hands a state to the files that want it: the first of the run, and those of next_step(). Errors: a file
  /// refused the first state; a number is not finite. Later failures are those of failures().
  Status take(const Sample& sample);
  /// Completes all files with the last state. One that fails does not keep the others from being completed.
  /// Error: the first of failures().
  Status finish(const Sample& last);
  /// The first failure of each file so far. States in files of their own are tried again the next time.
  const std::vector<Error>& failures() const;
  /// Whether any output besides images and videos is not lost.
  bool any_left() const;

  /// Hands over the sinks of frames.
  std::vector<std::unique_ptr<FrameSink>> take_frame_sinks();
  /// Names of the completed files.
  const std::vector<std::string>& written() const;
  /// After finish(): the work of actuators over the series, as of its last row [J]; nothing without either.
  std::optional<double> actuator_work() const;

 private:
  struct Parts;
  explicit RunFiles(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// A warning about a scene or a run, given once for each place.
struct Diagnostic {
  std::string id;          ///< what kind it is, for programs: "overlap", "flat-cells" (docs/commands.md)
  std::string where;       ///< the first body: "cube[0]"; may be empty
  std::string text;        ///< what was found, where and when; no full stop
  std::string advice;      ///< what it means and what to do, likewise; may be empty
  std::uint64_t step = 0;  ///< at which it was found
  ASPIC_API std::string sentence() const;  ///< the text, then the advice
};

/// Watches a run for bodies within each other or terrain, lengths and speeds that it does not resolve, flat
/// cells and energy from nowhere. Calls may come from any thread, one at a time.
class ASPIC_API RunWatch {
 public:
  /// `starts`: the run starts in the model's initial state. look() takes a model that outlives the watch.
  RunWatch(const ModelSettings& of, const Model& model, bool starts = true, Precision = Precision::single);
  RunWatch(RunWatch&&) noexcept;
  RunWatch& operator=(RunWatch&&) noexcept;
  ~RunWatch();

  void knows_what(const RunWatch& other);    ///< tells nothing that the other told
  std::vector<Diagnostic> at_start() const;  ///< of the state where the run starts
  /// New ones. `inputs`: of all steps since the last look; `anew`: state or constants were set since then.
  std::vector<Diagnostic> look(const Model& model, const State& state, const InputLog& inputs, bool anew);
  /// The first step after `step` to look at, ten a second; the largest number: none.
  std::uint64_t next_step(std::uint64_t step) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Time spent on frames [s], in all. A device's time shows where it is waited for.
struct FrameTimes {
  std::uint64_t frames = 0;                                     ///< how many
  double simulate = 0.0, draw = 0.0, read = 0.0, encode = 0.0;  ///< in each stage [s]
  /// The share of one frame in a total [s]; 0 without any.
  double per_frame(double total) const { return frames > 0 ? total / static_cast<double>(frames) : 0.0; }
};

/// Records frames of a run while it runs, without a window. All calls, and the destructor, on the thread that
/// made it: that of the solver where this is a gpu one.
class ASPIC_API Recorder {
 public:
  /// Draws where a gpu backend's state lies, else in a separate headless context; the sinks have the size of
  /// `output`. Everything given by reference must outlive the recorder. Errors: no_device,
  /// scene_rejected (no device memory), io (a shader file).
  static Result<std::unique_ptr<Recorder>> create(const ImageOutput& output, const Scene& scene,
                                                  const Backend& backend,
                                                  std::vector<std::unique_ptr<FrameSink>> sinks,
                                                  std::uint64_t first_step, std::uint64_t last_step);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// The step that the next frame shows; after the last one, a step that no run reaches.
  std::uint64_t next_step() const;
  /// The solver is at `step` ≤ next_step(): renders every frame that shows it. Error: also that of the
  /// encoder, as soon as all outputs are lost.
  Status reach(Solver& solver, std::uint64_t step);
  /// The run ended at `step`, perhaps early: its state is in the last frame, and the outputs are completed.
  Status finish(Solver& solver, std::uint64_t step);
  /// Ends without videos, instead of finish(); frames in directories stay.
  void abandon();
  /// Of the outputs that are lost so far; the others continue.
  std::vector<Error> failures() const;
  /// After finish(): the names of the completed outputs.
  std::vector<std::string> written();

  void add_simulation(double seconds);  ///< counts time of the solver [s] for times()
  FrameTimes times() const;             ///< so far
  /// The driver's name of the device that draws.
  const std::string& device() const;

 private:
  struct Parts;
  explicit Recorder(std::unique_ptr<Parts> parts);
  Status draw(Solver& solver, std::uint64_t step, std::uint64_t copies);
  std::unique_ptr<Parts> parts_;
};

/// Renders single images of a backend's states, without a window. All calls, and the destructor, on the
/// thread that made it: that of the solver where this is a gpu one.
class ASPIC_API StillPainter {
 public:
  /// Draws the backend's model, which must outlive it, where a Recorder would. Errors: its create()'s.
  static Result<std::unique_ptr<StillPainter>> create(const Scene& scene, const Backend& backend);
  ~StillPainter();
  StillPainter(const StillPainter&) = delete;
  StillPainter& operator=(const StillPainter&) = delete;

  /// The state that the solver has, as `view` and as a video's frame shows it, with every ball as it is
  /// turned at the start: height·width·3 bytes as FrameSink::write() has them. `text`: parameters, time and
  /// scales are written on it. Errors: scene_rejected, the image is larger than the device renders or its
  /// memory; no_device, as Solver::advance().
  Result<std::vector<std::byte>> draw(const ViewSettings& view, const ImageSize& size, bool text = true);

 private:
  struct Parts;
  explicit StillPainter(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace aspic

#pragma once
// What the sections of a report share: the scene, solvers, images, processors.
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analysis/stability_probe.h"
#include "aspic/scene.h"
#include "report/page.h"
#include "report/studio.h"
#include "report/trial.h"
#include "verify/check.h"

namespace aspic::report {

/// Five values of a parameter.
inline constexpr std::size_t steps_of_parameter = 5;

class Study {
 public:
  Study(Scene scene, std::string scene_words, bool thorough, unsigned jobs, std::function<bool()> stop);

  const Scene scene;
  /// The scene as commands name it, --set included.
  const std::string scene_words;
  const bool thorough;
  const verify::Subject subject;
  /// Null: there are no images, and why not.
  std::unique_ptr<Studio> studio;
  std::string no_studio;

  /// The cpu backend on one thread: the bits of every backend.
  BackendChoice backend() const;
  MakeSolver make_solver() const;
  bool stopped() const { return stop_ && stop_(); }

  /// Runs tasks 0 … count − 1 on several threads. Error: the first of any task, or interrupted.
  Status each(std::size_t count, const std::function<Status(std::size_t)>& task) const;

  /// The scene with KEY=VALUE arguments (scene/short_keys.h) applied. Errors: with_overrides.
  Result<Scene> varied(const std::vector<std::string>& assignments) const;
  /// A run of a scene's model over `duration` [s], longest_run() at most, with states near `image_times`.
  Result<TrialResult> run(const Model& model, double duration, std::span<const double> image_times = {},
                          double interval = sample_interval) const;

  /// What some seconds of computing simulate [s]; without end if thorough.
  double longest_run(const Model& model) const;
  /// Runs that ended before their duration.
  std::size_t shortened() const { return shortened_; }

  /// A duration of `wanted` [s], less where a run would take seconds to compute, but at least the scene's
  /// own.
  Result<double> affordable(double wanted) const;
  /// The time step that a method takes here [s]: the scene's, at most 0.9 of the largest stable one; its
  /// nominal step where it is stable at any; nothing where no step is stable.
  std::optional<double> step_for(const Model& model, Integrator integrator) const;

  /// `aspic report SCENE --only SECTION --out DIR`
  std::string command(std::string_view section) const;

  /// A row of images, empty without a studio; with `follow` the camera moves sideways with the bodies.
  /// The model outlives the call.
  Result<std::vector<std::string>> images(const Model& model, std::span<const State> states,
                                          const ViewSettings& view, bool follow = false) const;

 private:
  unsigned jobs_;
  std::function<bool()> stop_;
  mutable std::atomic<std::size_t> shortened_ = 0;
};

/// Where the center of all particles is, or of all balls where there are none, without its height [m].
Vec3 way_of(const State& state);

/// The scene's view turned to where the states' particles are, or their balls where there are none, and as
/// near as shows them all: balls roll away.
ViewSettings framed(ViewSettings view, std::span<const State> states);

/// Moments of a landing [s]: contact, deepest squash and after; evenly spaced where nothing lands.
std::vector<double> telling_times(const CourseSummary& summary, double duration);

/// A measure over time of a run's samples.
Curve course_curve(std::string name, const std::vector<CourseSample>& samples,
                   const std::function<double(const CourseSample&)>& measure, Palette palette,
                   std::size_t index);

/// One row of a report's contents.
struct SectionRow {
  std::string_view name;  ///< of --only
  std::string_view title;
  Result<Section> (*make)(const Study& study);
};

// The sections, one source file each. Errors: those of solvers and images; interrupted.
Result<Section> integrators_section(const Study& study);
Result<Section> parameters_section(const Study& study);
Result<Section> stability_section(const Study& study);
Result<Section> contact_section(const Study& study);
Result<Section> backends_section(const Study& study);

}  // namespace aspic::report

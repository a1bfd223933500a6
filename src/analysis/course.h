#pragma once
// The course of a run in a few figures: where the center of mass is, how far a body is squashed, when it
// rests, how far it slides.
#include <cstdint>
#include <optional>
#include <vector>

#include "aspic/analysis.h"
#include "aspic/state.h"
#include "model/model.h"

namespace aspic {

/// A moment of a run. Up is against gravity, or y without gravity.
struct CourseSample {
  double time = 0.0;    ///< step · h [s]
  double height = 0.0;  ///< of the center of mass [m]
  double lowest = 0.0;  ///< of all particles and balls' centers [m]
  double extent = 0.0;  ///< of the first body, from its lowest to its highest particle [m]; 0 without bodies
  double slide = 0.0;   ///< what the center of mass has moved across gravity since the first contact [m]
  Measures measures;
};

/// What a run came to.
struct CourseSummary {
  CourseSample end;
  double squash = 0.0;       ///< largest loss of extent, as a share of the first sample's; 0 without bodies
  double squash_time = 0.0;  ///< when that was [s]
  std::optional<double> contact_time;  ///< the first sample with something within contact.distance of terrain
  /// The sample from which on nothing was faster than contact.resting-speed; absent: there was motion at
  /// the end.
  std::optional<double> rest_time;
};

/// Takes states of a model in the order of their steps. Figures are as fine as the states are close in time.
class Course {
 public:
  explicit Course(const Model& model);

  /// The state has the model's numbers of particles and balls.
  void take(const State& state);
  const std::vector<CourseSample>& samples() const { return samples_; }
  /// Legal once a state was taken.
  CourseSummary summary() const;

 private:
  bool contacts(const State& state) const;

  const Model& model_;
  Meter meter_;
  Vec3 up_;
  std::vector<CourseSample> samples_;
  std::optional<double> contact_time_;
  Vec3 contact_center_;  // of mass
};

/// Steps between samples that are about `interval` [s] apart, at least 1.
std::uint64_t sample_stride(double timestep, double interval);

}  // namespace aspic

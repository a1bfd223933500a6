#pragma once
// Steps of the explicit methods for the parallel solver: springs, contact and a stage of the method in one
// pass over the particles, the terrain's response at its end.
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "collision/contact_search.h"
#include "cpu_parallel/band_kernels.h"
#include "cpu_parallel/lattice_kernels.h"
#include "cpu_parallel/steps.h"

namespace aspic::parallel {

class ExplicitSteps final : public Steps {
 public:
  /// The model's integrator must be a staged one.
  explicit ExplicitSteps(const StepParts& parts);

  bool step(Particles& start, Particles& end, SolveReport& report) override;
  bool look_at(const Particles& start) override;
  /// The next step looks itself.
  void forget() override { known_ = false; }
  void constants_changed() override;
  std::uint64_t bytes() const override;

 private:
  /// Consecutive particles of one body that one thread moves: complete planes of a cube, or a piece of any
  /// other body.
  struct Task {
    std::size_t body;
    Range range;  ///< within all particles
    Box box;      ///< around them at the stage at hand
    bool sound;   ///< at the end of the step
    /// Those that may be near terrain at the step's start: at its end terrain moves none but them.
    std::vector<Range> near;
    std::vector<physics::RestingContact<float>> resting;  ///< of this step, in ascending particle index
    std::size_t kept;  ///< those before, in force_with_contact_, are of this or an earlier task
  };

  void cut(std::size_t body);
  void run(Task& task, const StageMove& stage);
  void run_bands(Task& task, const StageMove& stage, const ForceInput& input, bool near, Moved& moved);
  void finish(Task& task, const StageMove& stage, bool near, Range range, const Forces& forces, Moved& moved);
  void pull(const StageMove& stage, Range range, const Forces& forces);
  void add_contact(Task& task, const StageMove& stage, Range range, const Forces& forces);
  void end(Task& task, const StageMove& stage);
  void respond(Task& task, const StageMove& stage);
  void find_near(Task& task, const VectorArray& x) const;
  bool all_apart();
  /// run() of BodyContact.
  auto on_workers() {
    return [this](std::size_t count, const auto& task) { workers_.run(count, task); };
  }
  void contact(const StageMove& stage);
  void move_contact_particles(Task& task, const StageMove& stage);
  void keep_contact_particles(Task& task, const StageMove& stage, Range range, const Forces& forces);
  std::size_t first_contact_particle(const Task& task) const;
  void find_resting(Task& task, const StageMove& stage) const;
  template <class F>
  void for_near(const VectorArray& x, Range range, const F& f) const;

  const SharedModel& model_;
  const Staged& method_;
  const reference::Dynamics<float>& dynamics_;
  const std::vector<Springs>& springs_;
  MovingLengths& lengths_;
  const FloatArray &mass_, &inverse_mass_;
  Workers& workers_;
  std::vector<Task> tasks_;
  std::vector<Sweep> sweeps_;           // by thread
  std::vector<BandSweep> band_sweeps_;  // by thread
  Particles between_, sums_;
  bool known_ = false;                                       ///< the boxes, and what is near
  std::unique_ptr<collision::ContactSearch<float>> bodies_;  ///< null: no bodies can be in contact
  bool in_contact_ = false;                                  ///< in the stage at hand
  std::vector<Box> body_boxes_;                              ///< around all tasks of each body
  /// Of bodies_->particles(): forces with and without those of bodies [N], and their sums before the stage.
  std::vector<physics::Vector<float>> force_with_contact_, kept_force_;
  std::vector<std::array<physics::Vector<float>, 2>> kept_sums_;
};

}  // namespace aspic::parallel

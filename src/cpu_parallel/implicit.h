#pragma once
// Steps of implicit Euler for the parallel solver. The method is that of cpu_reference/implicit_euler.h, and
// so is every bit; here the work is shared by blocks of 256 particles, those of the reductions, so that a
// pass over them ends with the blocks' sums and the tree over these is the same for any number of threads.
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cpu_parallel/implicit_contact.h"
#include "cpu_parallel/implicit_kernels.h"
#include "cpu_parallel/steps.h"
#include "cpu_reference/implicit_euler.h"

namespace aspic::parallel {

class ImplicitEuler final : public Steps {
 public:
  explicit ImplicitEuler(const StepParts& parts);

  bool step(Particles& start, Particles& end, SolveReport& report) override;
  bool look_at(const Particles& start) override;
  void constants_changed() override;
  std::uint64_t bytes() const override;

  // What solve_step() asks of a system (cpu_reference/implicit_newton.h).
  reference::Trial<float> start();
  reference::Trial<float> fall();
  reference::Trial<float> try_step(float lambda, bool onwards);
  float start_solve();
  bool prescribes() const { return prescribes_; }
  bool contacts() const { return in_contact_; }
  reference::Trial<float> update_contacts(bool from_trial);
  bool interrupted() const { return dynamics_.interrupted(); }
  float apply();
  float advance(float alpha, bool first);
  void turn(float beta);

 private:
  using Vector = physics::Vector<float>;
  /// A particle that the ground holds at the trial.
  struct Held {
    std::size_t particle;
    physics::GroundReaction<float> reaction;
    Vector prescribed;  ///< the part of δ that the ground leaves no choice in [m/s]
  };
  /// A block's forces and diagonal blocks at the trial.
  struct BlockForces {
    BlockVectors f;
    std::array<BlockNumbers, 6> diagonal;
  };
  struct Block {
    Range range;
    std::vector<Segment> segments;
    std::vector<Held> held;
    bool near;        ///< near terrain at the step's start
    bool prescribes;  ///< whether a prescribed part is not zero
  };

  void cut_into_blocks();
  template <class Task>
  void for_each_block(const Task& task);
  Linearization at(const VectorArray& v, float h) const;
  void begin_block(Block& block);
  void hold_contact_force(const Block& block);
  float clearance(const Vector& x) const;
  void forces(const Block& block, const Linearization& at, BlockForces& out);
  ResidualShare evaluate_block(Block& block);
  void meet_ground(Block& block, const BlockVectors& free, const BlockNumbers& meets, BlockVectors& R,
                   std::array<BlockNumbers, 6>& diagonal);
  reference::Trial<float> evaluate();
  void multiply_block(const Block& block, const VectorArray& p);
  void update_block(const Block& block, Update how, float alpha);
  float sum_of_blocks() const;
  bool end_block(const Block& block);
  ImplicitBodyContact::Force start_force();

  const SharedModel& model_;
  const reference::Dynamics<float>& dynamics_;
  const std::vector<Springs>& springs_;
  MovingLengths& lengths_;
  const FloatArray &mass_, &inverse_mass_;
  Workers& workers_;
  physics::GroundAhead<float> ahead_;
  reference::SolveLimits<float> limits_;
  float h_;
  std::vector<Jacobians> jacobians_;  // by body
  std::vector<Block> blocks_;
  std::vector<float> sums_, largest_, falling_;  // by block
  LinearSystem system_;
  VectorArray held_force_;  // contact force of the course model [N]
  FloatArray clearance_;    // as BlockResidual::clearance
  bool prescribes_ = false;
  std::unique_ptr<ImplicitBodyContact> bodies_;  // none where none can touch
  bool in_contact_ = false;                      // whether bodies are near each other in this step
  const Particles* start_ = nullptr;
  Particles* end_ = nullptr;                                   // its velocities are the trial
  std::vector<physics::SpringJacobian<float>> pull_jacobian_;  // of every pull
};

}  // namespace aspic::parallel

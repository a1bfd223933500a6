#pragma once
// Balls on the device: the passes that follow the particles' step (shaders/compute/ball_blocks.glsl), for the
// explicit and the implicit solver alike.
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/pass.h"
#include "gpu/pass_profiler.h"
#include "gpu/program.h"
#include "gpu_solver/ball_face_passes.h"
#include "gpu_solver/gpu_solver.h"
#include "gpu_solver/kernels.h"
#include "gpu_solver/layout.h"
#include "model/counts.h"

namespace aspic {

/// Buckets of the grid's hash table for this many balls: a power of two, about two for each.
std::uint32_t grid_buckets(std::uint32_t balls);

/// Whether `automatic` takes the grid: with fewer balls, trying all of them costs less than keeping a grid.
bool grid_pays(std::uint32_t balls);

/// A mark represents 2^shift blocks of particles: the least shift with which all balls' marks take 16 MiB or
/// less (shaders/compute/ball_grid.glsl).
std::uint32_t mark_shift(std::uint32_t balls, std::uint32_t particles);

/// Fills the balls' part of the constants.
void fill_balls(layout::Simulation& block, const Model& model);

/// Bytes of device memory the balls of a scene take at first. Crowds take more, by what they need: 128 bytes
/// for each 256 balls in the scene and each body that touches more than 32 balls.
std::uint64_t ball_bytes(const ModelCounts& counts);

class BallPasses {
 public:
  /// The particles' states and the control block that stops the kernels: bound to every pass.
  struct Surroundings {
    const gl::Buffer* simulation = nullptr;
    const gl::Buffer* control = nullptr;  ///< Control, or Solve under implicit Euler
    bool implicit = false;
    gl::Binding poses = {};  ///< of moving terrain
    gl::Binding pulls = {};
  };

  /// Makes buffers and passes; nothing at all for a model without balls. Errors as make_gpu_solver.
  Status build(gl::Context& context, const Model& model, const KernelOptions& kernels,
               const Surroundings& surroundings, BallSearch search);

  bool any() const { return count_ > 0; }

  /// Another model, with as many balls and particles; its balls come with load().
  void set_model(const Model& model) { model_ = &model; }
  /// Writes the balls of a state into slot 0; launch steps count from the state's step.
  void load(const ConstStateView& state, std::uint64_t step);
  /// Writes the launch steps again, counted from `base_step`.
  void set_base_step(std::uint64_t base_step);

  /// Queues the passes of one step between particle states `start` and `end`. `step` and `parity` (which slot
  /// the step starts from) matter under explicit methods alone; under implicit Euler a and b are the two
  /// states.
  void queue(const gl::Buffer& start, const gl::Buffer& end, std::uint32_t step, std::uint32_t parity,
             gl::ReadBy last) const;

  /// Makes room for the contacts that found none, which the last passes have counted, or for twice as many;
  /// the passes can then be queued again for the same step. Error (scene_rejected): more than the device
  /// holds, with figures. Error (no_device): the context is lost.
  Status grow();

  /// Bytes held beyond those after build().
  std::uint64_t grown_bytes() const;

  /// Writes the balls of a slot where the view has places for them.
  void read(const StateView& view, std::uint32_t slot) const;

  const gl::Buffer& buffer() const { return balls_; }

  /// What a reader calls the passes, in their order.
  static std::vector<std::string> pass_names();
  /// Reports each dispatch to `profiler`, counting kinds from `first` on; null ends this.
  void set_profiler(gl::PassProfiler* profiler, std::size_t first) {
    profiler_ = profiler;
    first_kind_ = first;
    faces_.set_profiler(profiler, first + kernel_count);
  }

 private:
  enum Kernel : std::size_t {
    fly,
    clear,
    insert,
    find,
    gather,
    near,
    tally,
    partials,
    exchange,
    particles,
    end_implicit,
    kernel_count
  };
  /// One queue() at work.
  struct Queue {
    std::span<const gl::Binding> states;
    gl::ReadBy last;
  };
  bool wanted(Kernel kernel) const;
  Status build_buffers();
  Status allot(std::uint64_t list_words, std::uint64_t items);
  void reset_work();
  void mark(Kernel kernel) const {
    if (profiler_) profiler_->mark(first_kind_ + kernel);
  }
  void dispatch(const Queue& queue, Kernel kernel, std::uint32_t items,
                gl::ReadBy readers = gl::ReadBy::compute_pass) const;
  void dispatch_indirect(const Queue& queue, Kernel kernel, std::size_t arguments) const;
  void find_contacts(const Queue& queue) const;
  void queue_phase(const Queue& queue, std::uint32_t phase) const;

  gl::Context* context_ = nullptr;
  const Model* model_ = nullptr;
  std::uint32_t count_ = 0, particle_count_ = 0;
  std::uint64_t list_capacity_ = 0, item_capacity_ = 0, first_bytes_ = 0;
  bool grid_ = false, implicit_ = false;
  gl::Buffer balls_, bodies_, contacts_, grid_words_, work_, items_;
  // By kernel; nothing where the scene needs none.
  std::array<std::shared_ptr<const gl::Program>, kernel_count> programs_;
  std::array<std::optional<gl::Pass>, kernel_count> passes_;
  BallFacePasses faces_;
  gl::PassProfiler* profiler_ = nullptr;
  std::size_t first_kind_ = 0;
};

}  // namespace aspic

#include "cpu_parallel/cpu_solver.h"

#include <fmt/format.h>

#include <atomic>
#include <new>
#include <utility>
#include <variant>

#include "cpu_parallel/contact_pieces.h"
#include "cpu_parallel/kernels.h"
#include "cpu_parallel/springs.h"
#include "cpu_parallel/workers.h"
#include "cpu_reference/balls.h"
#include "cpu_reference/divergence.h"
#include "cpu_reference/reference_solver.h"

namespace aspic {
namespace parallel {
namespace {

/// Particles of a piece at most: its forces stay in the first-level cache.
constexpr std::size_t piece_size = 1024;
/// Springs evaluated in a stage that pay for another thread: about 15 µs.
constexpr std::size_t evaluations_per_thread = 16'384;

/// Particles of one body that one thread moves at a time.
struct Piece {
  std::size_t body;
  std::size_t plane;  ///< of a lattice
  Range own;          ///< within the plane or the body
  Range range;        ///< within all particles
};

using Springs = std::variant<Lattice, SpringLists>;

class CpuSolver final : public Solver {
 public:
  CpuSolver(const Model& model, const CpuOptions& options)
      : model_(model),
        method_(row_of(model.simulation.integrator)),
        dynamics_(model),
        balls_(model),
        workers_(options.threads > 0 ? options.threads : threads_for(model)) {
    std::size_t margin = slice;
    for (const Body& body : model.bodies) {
      if (edge_of_lattice(model, body) > 0) {
        springs_.emplace_back(std::in_place_type<Lattice>, model, body);
        margin = std::max(margin, std::get<Lattice>(springs_.back()).reach() + slice);
      } else {
        springs_.emplace_back(std::in_place_type<SpringLists>, model, body);
      }
    }
    cut_into_pieces();
    const std::size_t count = model.particle_count();
    state_ = Particles(count, margin);
    next_ = Particles(count, margin);
    if (method_.stages.size() > 1) {
      sums_ = Particles(count, 0);
      between_ = Particles(count, margin);
    }
    mass_ = FloatArray(count, slice);
    inverse_mass_ = FloatArray(count, slice);
    for (std::uint32_t i = 0; i < count; ++i) {
      mass_[i] = static_cast<float>(model.mass[i]);
      inverse_mass_[i] = static_cast<float>(model.inverse_mass[i]);
    }
    set(initial_state(model, Precision::single));
  }

  std::string_view backend() const override { return "cpu"; }
  std::string description() const override {
    return fmt::format("cpu, {} thread{}, {}, single precision", workers_.threads(),
                       workers_.threads() == 1 ? "" : "s", instruction_set());
  }
  Precision precision() const override { return Precision::single; }
  const Model& model() const override { return model_; }
  std::uint64_t bytes() const override {
    ModelCounts bodies;
    bodies.particles = model_.particle_count();
    bodies.balls = model_.ball_count();
    return cpu_bytes(bodies, model_.simulation.integrator);
  }

  Status load(const State& state) override {
    ASPIC_CHECK(check_sizes(model_, state));
    set(state);
    return {};
  }

  Status set_pull(const std::optional<Pull>& pull) override {
    ASPIC_TRY(const auto taken, rounded_pull(model_, pull, Precision::single));
    dynamics_.set_pull(taken);
    return {};
  }

  Result<std::optional<Divergence>> advance(std::uint64_t steps) override {
    for (std::uint64_t n = 0; n < steps && !divergence_ && !interrupted(); ++n) step();
    return divergence_;
  }

  Result<State> state() override;

 private:
  static unsigned threads_for(const Model& model) {
    const std::size_t worth = 2 * model.springs.size() / evaluations_per_thread;
    return static_cast<unsigned>(std::clamp<std::size_t>(worth, 1, available_threads()));
  }

  void cut_into_pieces();
  void set(const State& state);
  void step();
  void move_piece(std::size_t n, const StageMove& stage);
  void add_contact(std::size_t n, const StageMove& stage, const Forces& forces);
  template <class Act>
  void each_near(const VectorArray& x, const Range& range, const Act& act) const;
  void respond(const Range& range);
  void move_balls();

  const Model& model_;
  const IntegratorRow& method_;
  reference::Dynamics<float> dynamics_;
  reference::Balls<float> balls_;
  Workers workers_;
  std::vector<Springs> springs_;  // by body
  std::vector<Piece> pieces_;
  std::vector<std::vector<reference::RestingContact<float>>> resting_;  // by piece, for this step
  FloatArray mass_, inverse_mass_;
  Particles state_, next_, between_, sums_;
  reference::BallPhase<float> ball_phase_, next_balls_;
  std::atomic<bool> sound_ = true;  // so far in this step
  std::uint64_t step_ = 0;
  std::optional<Divergence> divergence_;
};

void CpuSolver::cut_into_pieces() {
  const auto cut = [&](std::size_t body, std::size_t plane, std::size_t first, std::size_t count) {
    for (std::size_t at = 0; at < count; at += piece_size) {
      const std::size_t size = std::min(piece_size, count - at);
      pieces_.push_back({body, plane, {at, size}, {first + at, size}});
    }
  };
  for (std::size_t b = 0; b < springs_.size(); ++b) {
    if (const auto* const lattice = std::get_if<Lattice>(&springs_[b])) {
      for (std::size_t plane = 0; plane < lattice->planes(); ++plane)
        cut(b, plane, lattice->first() + plane * lattice->plane_size(), lattice->plane_size());
    } else {
      const auto& lists = std::get<SpringLists>(springs_[b]);
      cut(b, 0, lists.first(), lists.count());
    }
  }
  resting_.resize(pieces_.size());
}

void CpuSolver::set(const State& state) {
  const auto take = [](const std::vector<Vec3>& from, VectorArray& to) {
    for (std::size_t i = 0; i < from.size(); ++i) parallel::set(to, i, reference::rounded<float>(from[i]));
  };
  take(state.position, state_.x);
  take(state.velocity, state_.v);
  ball_phase_ = {reference::field<float>(state.ball_position), reference::field<float>(state.ball_velocity),
                 reference::field<float>(state.ball_angular_velocity)};
  step_ = state.step;
  divergence_.reset();
}

Result<State> CpuSolver::state() {
  State state;
  state.precision = Precision::single;
  state.step = step_;
  const auto copy = [&](const VectorArray& from, std::vector<Vec3>& to) {
    to.reserve(model_.particle_count());
    for (std::size_t i = 0; i < model_.particle_count(); ++i)
      to.push_back({from[0][i], from[1][i], from[2][i]});
  };
  copy(state_.x, state.position);
  copy(state_.v, state.velocity);
  state.ball_position = reference::columns(ball_phase_.x);
  state.ball_velocity = reference::columns(ball_phase_.v);
  state.ball_angular_velocity = reference::columns(ball_phase_.omega);
  return state;
}

void CpuSolver::step() {
  const double h = model_.simulation.timestep;
  dynamics_.begin_step(step_);
  sound_.store(true, std::memory_order_relaxed);
  Particles* at = &state_;
  bool accumulate = false;
  for (std::size_t s = 0; s < method_.stages.size(); ++s) {
    const Stage& stage = method_.stages[s];
    const bool last = s + 1 == method_.stages.size();
    // Stages take turns between two sets of arrays, so that the end of the step is in next_.
    Particles* const to = (method_.stages.size() - s) % 2 == 1 ? &next_ : &between_;
    const StageMove move = {&state_,
                            at,
                            to,
                            &sums_,
                            inverse_mass_.data(),
                            static_cast<float>(h * stage.advance),
                            static_cast<float>(stage.weight),
                            static_cast<float>(h / method_.divisor),
                            accumulate,
                            last,
                            method_.drift};
    workers_.run(pieces_.size(), [&](std::size_t n) {
      if (!interrupted()) move_piece(n, move);
    });
    accumulate = accumulate || stage.weight != 0.0;
    at = to;
  }
  if (interrupted()) return;
  if (model_.ball_count() > 0) move_balls();
  if (!sound_.load(std::memory_order_relaxed) || model_.ball_count() > 0) {
    divergence_ = reference::find_divergence<float>(
        model_, [&](Eigen::Index i) { return vector_of(next_.x, static_cast<std::size_t>(i)); },
        [&](Eigen::Index i) { return vector_of(next_.v, static_cast<std::size_t>(i)); }, next_balls_,
        step_ + 1);
    if (divergence_) return;
  }
  std::swap(state_, next_);
  if (model_.ball_count() > 0) std::swap(ball_phase_, next_balls_);
  ++step_;
}

/// Calls act(i) for the particles of a range that terrain may touch. Of a body on the ground that is a small
/// part, which boxes around a few particles at a time find.
template <class Act>
void CpuSolver::each_near(const VectorArray& x, const Range& range, const Act& act) const {
  if (!near_terrain(model_, box_of(x, range))) return;
  for (std::size_t at = 0; at < range.count; at += slice) {
    const Range few = {range.first + at, std::min(slice, range.count - at)};
    if (!near_terrain(model_, box_of(x, few))) continue;
    for (std::size_t i = few.first; i < few.first + few.count; ++i) act(i);
  }
}

/// One stage of the particles of a piece.
void CpuSolver::move_piece(std::size_t n, const StageMove& stage) {
  alignas(64) float f[3][piece_size + slice];
  const Forces forces = {{f[0], f[1], f[2]}};
  const Piece& piece = pieces_[n];
  const Vector g = dynamics_.gravity();
  const ForceInput input = {stage.at, mass_.data(), {g.x(), g.y(), g.z()}};
  if (const auto* const lattice = std::get_if<Lattice>(&springs_[piece.body])) {
    lattice_forces(*lattice, input, piece.plane, piece.own, forces);
  } else {
    listed_forces(std::get<SpringLists>(springs_[piece.body]), input, piece.own, forces);
  }
  add_contact(n, stage, forces);
  move(stage, piece.range, forces);
  if (!stage.last) return;
  respond(piece.range);
  // With balls in the scene the step is not at its end yet.
  if (model_.ball_count() > 0) return;
  const auto limit = static_cast<float>(divergence_speed * divergence_speed);
  if (!all_sound(next_, piece.range, limit)) sound_.store(false, std::memory_order_relaxed);
}

/// The pull, and what terrain adds to the forces.
void CpuSolver::add_contact(std::size_t n, const StageMove& stage, const Forces& forces) {
  const Range& range = pieces_[n].range;
  const auto force = [&](std::size_t i) {
    const std::size_t at = i - range.first;
    return Vector{forces.component[0][at], forces.component[1][at], forces.component[2][at]};
  };
  const auto put = [&](std::size_t i, const Vector& f) {
    for (std::size_t c = 0; c < 3; ++c)
      forces.component[c][i - range.first] = f[static_cast<Eigen::Index>(c)];
  };
  if (const auto& pull = dynamics_.pull()) {
    const auto i = static_cast<std::size_t>(pull->particle);
    if (i - range.first < range.count)
      put(i,
          force(i) + reference::spring_force<float>(pull->spring, vector_of(stage.at->x, i),
                                                    vector_of(stage.at->v, i), pull->anchor, Vector::Zero()));
  }
  if (model_.contact.model == ContactModel::course) {
    return each_near(stage.at->x, range, [&](std::size_t i) {
      if (inverse_mass_[i] != 0.0f)
        put(i, dynamics_.with_contact(vector_of(stage.at->x, i), vector_of(stage.at->v, i), force(i)));
    });
  }
  std::vector<reference::RestingContact<float>>& resting = resting_[n];
  if (stage.at == stage.start) {  // the step's first stage
    resting.clear();
    each_near(stage.at->x, range, [&](std::size_t i) {
      dynamics_.find_resting(static_cast<Eigen::Index>(i), vector_of(stage.at->x, i),
                             vector_of(stage.at->v, i), resting);
    });
  }
  for (const reference::RestingContact<float>& at : resting) {
    const auto i = static_cast<std::size_t>(at.particle);
    put(i, reference::with_reaction<float>(at, force(i)));
  }
}

/// Terrain response at the end of the step.
void CpuSolver::respond(const Range& range) {
  each_near(next_.x, range, [&](std::size_t i) {
    Vector x = vector_of(next_.x, i), v = vector_of(next_.v, i);
    dynamics_.respond(static_cast<Eigen::Index>(i), vector_of(state_.x, i), vector_of(state_.v, i), x, v);
    parallel::set(next_.x, i, x);
    parallel::set(next_.v, i, v);
  });
}

/// Balls fly and meet particles, as in the reference.
void CpuSolver::move_balls() {
  const auto columns_of = [&](const VectorArray& a) {
    reference::Field<float> field(3, model_.particle_count());
    for (Eigen::Index i = 0; i < field.cols(); ++i) field.col(i) = vector_of(a, static_cast<std::size_t>(i));
    return field;
  };
  const reference::Phase<float> start = {columns_of(state_.x), columns_of(state_.v)};
  reference::Phase<float> end = {columns_of(next_.x), columns_of(next_.v)};
  next_balls_ = balls_.step(step_, ball_phase_, start, end);
  for (Eigen::Index i = 0; i < end.x.cols(); ++i) {
    parallel::set(next_.x, static_cast<std::size_t>(i), end.x.col(i));
    parallel::set(next_.v, static_cast<std::size_t>(i), end.v.col(i));
  }
}

/// Implicit Euler: the reference's solve, on one thread.
class OneThread final : public Solver {
 public:
  explicit OneThread(std::unique_ptr<Solver> reference) : reference_(std::move(reference)) {}
  std::string_view backend() const override { return "cpu"; }
  std::string description() const override { return "cpu, one thread for implicit Euler, single precision"; }
  Precision precision() const override { return reference_->precision(); }
  const Model& model() const override { return reference_->model(); }
  std::uint64_t bytes() const override { return reference_->bytes(); }
  Status load(const State& state) override { return reference_->load(state); }
  Status set_pull(const std::optional<Pull>& pull) override { return reference_->set_pull(pull); }
  void heed(const std::atomic<bool>* flag) override { reference_->heed(flag); }
  Result<std::optional<Divergence>> advance(std::uint64_t steps) override {
    return reference_->advance(steps);
  }
  std::optional<SolveStatistics> solve_statistics() override { return reference_->solve_statistics(); }
  Result<State> state() override { return reference_->state(); }

 private:
  std::unique_ptr<Solver> reference_;
};

}  // namespace
}  // namespace parallel

Result<std::unique_ptr<Solver>> make_cpu_solver(const Model& model, const CpuOptions& options) {
  if (row_of(model.simulation.integrator).solved()) {
    ASPIC_TRY(auto reference, make_reference_solver(model, Precision::single));
    return std::unique_ptr<Solver>(std::make_unique<parallel::OneThread>(std::move(reference)));
  }
  try {
    return std::unique_ptr<Solver>(std::make_unique<parallel::CpuSolver>(model, options));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::scene_rejected,
                "no memory left for the cpu solver of {} particles: use fewer particles-per-edge",
                model.particle_count());
  }
}

std::uint64_t cpu_bytes(const ModelCounts& counts, Integrator integrator) {
  const IntegratorRow& method = row_of(integrator);
  if (method.solved()) return reference_bytes(counts, Precision::single);
  // Start and end of a step, for several stages also the one between and the sums; mass and inverse mass.
  // Lists of springs are counted as those of a net, six places a particle; cubes have none.
  const std::uint64_t sets = method.stages.size() > 1 ? 4 : 2;
  return counts.particles * sizeof(float) * (6 * sets + 2) + counts.balls * sizeof(float) * (3 * 17 + 7);
}

}  // namespace aspic

#include "gpu_solver/ball_passes.h"

#include <algorithm>
#include <bit>

namespace aspic {
namespace {

using gl::Binding;
using gl::Buffer;
using gl::Reader;

constexpr std::array kernel_paths = {"compute/ball_fly.comp",      "compute/ball_clear.comp",
                                     "compute/ball_insert.comp",   "compute/ball_count.comp",
                                     "compute/ball_exchange.comp", "compute/ball_particles.comp",
                                     "compute/ball_end.comp"};

layout::vec4 packed(const Vec3& v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w)};
}

Vec3 unpacked(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

std::uint32_t grid_buckets(std::uint32_t balls, std::uint32_t particles) {
  return std::bit_ceil(2 * std::max({balls, particles, 32u}));
}

bool grid_pays(std::uint32_t balls, std::uint32_t particles) {
  return std::uint64_t{balls} * (std::uint64_t{balls} + particles) >= 40000;
}

void fill_balls(layout::Simulation& block, const Model& model) {
  block.ball_count = model.ball_count();
  block.ball_spin = model.contact.spin ? 1u : 0u;
  block.ball_restitution = static_cast<float>(model.contact.ball_restitution);
  block.ball_friction = static_cast<float>(model.contact.ball_friction);
  block.bucket_mask = grid_buckets(model.ball_count(), model.particle_count()) - 1;
  double radius = 0.0;
  for (const Ball& ball : model.balls) radius = std::max(radius, ball.radius);
  // A quarter more than the reach, so that neighbours are never two cells apart, rounding included.
  block.ball_cells_per_metre = static_cast<float>(1.0 / (1.25 * (2.0 * radius + model.contact.epsilon)));
  block.particle_cells_per_metre = static_cast<float>(1.0 / (1.25 * (radius + model.contact.epsilon)));
}

std::uint64_t ball_bytes(const ModelCounts& counts) {
  if (counts.balls == 0) return 0;
  const auto balls = static_cast<std::uint32_t>(counts.balls),
             particles = static_cast<std::uint32_t>(counts.particles);
  const std::uint64_t grid = grid_pays(balls, particles) ? 2 * std::uint64_t{grid_buckets(balls, particles)} +
                                                               counts.balls + counts.particles
                                                         : 0;
  return counts.balls * (BALL_SLOTS * sizeof(layout::Ball) + sizeof(layout::BallBody)) +
         4 * (counts.balls + counts.particles + grid);
}

std::vector<std::string> BallPasses::pass_names() {
  return {"balls: flight and terrain", "balls: empty the grid",    "balls: fill the grid",
          "balls: count contacts",     "balls: impulses on balls", "balls: impulses on particles",
          "balls: end of the step"};
}

Status BallPasses::build(gl::Context& context, const Model& model, const gl::ShaderLibrary& library,
                         const KernelOptions& kernels, const Surroundings& surroundings, BallSearch search) {
  model_ = &model;
  count_ = model.ball_count();
  particle_count_ = model.particle_count();
  if (!any()) return {};
  implicit_ = surroundings.implicit;
  grid_ = search == BallSearch::automatic ? grid_pays(count_, particle_count_) : search == BallSearch::grid;
  buckets_ = grid_buckets(count_, particle_count_);
  const std::uint64_t bodies = std::uint64_t{count_} + particle_count_;
  ASPIC_ASSIGN_OR_RETURN(
      balls_, Buffer::create(context, "balls", BALL_SLOTS * std::uint64_t{count_} * sizeof(layout::Ball)));
  ASPIC_ASSIGN_OR_RETURN(bodies_,
                         Buffer::create(context, "ball constants", count_ * sizeof(layout::BallBody)));
  ASPIC_ASSIGN_OR_RETURN(counts_, Buffer::create(context, "ball contacts", 4 * bodies));
  ASPIC_ASSIGN_OR_RETURN(
      lists_, Buffer::create(context, "ball grid", grid_ ? 4 * (2 * std::uint64_t{buckets_} + bodies) : 0));

  std::vector<gl::Define> defines = kernels.defines;
  if (implicit_) defines.push_back({"ASPIC_IMPLICIT", "1"});
  if (grid_) defines.push_back({"ASPIC_BALL_GRID", "1"});
  const std::vector<Binding> bindings = {
      {BINDING_SIMULATION, surroundings.simulation, gl::BufferKind::uniform},
      {BINDING_BALLS, &balls_},
      {BINDING_BALL_BODIES, &bodies_},
      {BINDING_BALL_COUNTS, &counts_},
      {BINDING_BALL_GRID, &lists_},
      {implicit_ ? std::uint32_t{BINDING_SOLVE} : std::uint32_t{BINDING_CONTROL}, surroundings.control}};
  for (std::size_t k = 0; k < kernel_count; ++k) {
    const bool wanted = k == end_implicit ? implicit_ : (k != clear && k != insert) || grid_;
    if (!wanted) continue;
    ASPIC_ASSIGN_OR_RETURN(programs_[k], context.programs().compute(library, kernel_paths[k], defines));
    passes_[k].emplace(*programs_[k], bindings, Reader::compute_pass);
  }
  return {};
}

void BallPasses::load(const State& state) {
  if (!any()) return;
  std::vector<layout::Ball> balls(count_);
  for (std::size_t b = 0; b < balls.size(); ++b) {
    const Ball& ball = model_->balls[b];
    const double inertia = ball.inertia(), w = ball.launched(state.step) ? 1.0 / ball.mass : 0.0;
    balls[b].position = packed(state.ball_position[b], ball.radius);
    balls[b].velocity = packed(state.ball_velocity[b], w);
    balls[b].spin = packed(state.ball_angular_velocity[b], ball.radius / inertia);
    balls[b].start_velocity = packed(state.ball_velocity[b], ball.radius * ball.radius / inertia);
  }
  balls_.upload_items(std::span<const layout::Ball>(balls));
  set_base_step(state.step);
}

void BallPasses::set_base_step(std::uint64_t base_step) {
  if (!any()) return;
  std::vector<layout::BallBody> bodies(count_);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Ball& ball = model_->balls[b];
    const std::uint64_t wait = ball.launch_step > base_step ? ball.launch_step - base_step : 0;
    bodies[b] = {static_cast<float>(ball.mass), static_cast<float>(1.0 / ball.mass),
                 static_cast<std::uint32_t>(std::min<std::uint64_t>(wait, 0xffffffffu)), 0};
  }
  bodies_.upload_items(std::span<const layout::BallBody>(bodies));
}

void BallPasses::dispatch(Kernel kernel, std::uint32_t items, std::span<const Binding> states,
                          std::uint32_t phase, Reader readers) const {
  if (kernel == tally || kernel == exchange || kernel == particles) {
    programs_[kernel]->set(LOCATION_BALL_PHASE, phase);
  }
  passes_[kernel]->dispatch_for(items, states, readers);
  if (profiler_ && items > 0) profiler_->mark(first_kind_ + kernel);
}

void BallPasses::queue(const Buffer& start, const Buffer& end, std::uint32_t step, std::uint32_t parity,
                       Reader last) const {
  if (!any()) return;
  const std::array<Binding, 2> states = {{{BINDING_STATE_A, &start}, {BINDING_STATE_B, &end}}};
  if (!implicit_) {
    for (const auto& program : programs_) {
      if (!program) continue;
      program->set(LOCATION_STEP, step);
      program->set(LOCATION_BALL_PARITY, parity);
    }
  }
  const Reader next = Reader::compute_pass;
  const std::uint32_t bodies = count_ + particle_count_;
  dispatch(fly, count_, states, 0, next);
  if (grid_) {
    dispatch(clear, 2 * buckets_, states, 0, next);
    dispatch(insert, bodies, states, 0, next);
  }
  for (std::uint32_t phase = 0; phase < BALL_PHASES; ++phase) {
    const bool ends = phase + 1 == BALL_PHASES && !implicit_;
    dispatch(tally, bodies, states, phase, next);
    dispatch(exchange, count_, states, phase, ends ? last : next);
    if (phase != BALL_PHASE_BALLS) dispatch(particles, particle_count_, states, phase, ends ? last : next);
  }
  if (implicit_) dispatch(end_implicit, 1, states, 0, last);
}

void BallPasses::read(State& state, std::uint32_t slot) const {
  if (!any()) return;
  const auto balls = balls_.download_items<layout::Ball>(count_, std::uint64_t{slot} * count_);
  for (const layout::Ball& ball : balls) {
    state.ball_position.push_back(unpacked(ball.position));
    state.ball_velocity.push_back(unpacked(ball.velocity));
    state.ball_angular_velocity.push_back(unpacked(ball.spin));
  }
}

}  // namespace aspic

#include "cpu_parallel/implicit.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "aspic/solver.h"
#include "cpu_parallel/contact_pieces.h"

namespace aspic::parallel {
namespace {

/// Jacobians of springs are kept where those of a body fit into the caches nearest to the processor: there
/// loading them costs less than a square root and a division. Beyond that it is the other way round.
constexpr std::size_t most_kept_particles = 16'384;

Vector vector_of(const BlockVectors& a, std::size_t n) {
  return {a[0].of[n], a[1].of[n], a[2].of[n]};
}
void set(BlockVectors& a, std::size_t n, const Vector& v) {
  for (std::size_t c = 0; c < 3; ++c) a[c].of[n] = v[static_cast<Eigen::Index>(c)];
}

/// Adds a spring to the diagonal block of particle n.
void add(std::array<BlockNumbers, 6>& blocks, std::size_t n, const physics::SpringJacobian<float>& H) {
  physics::DiagonalBlock<float> block(0.0f);
  float* const numbers[6] = {&block.xx, &block.yy, &block.zz, &block.xy, &block.xz, &block.yz};
  for (std::size_t c = 0; c < 6; ++c) *numbers[c] = blocks[c].of[n];
  block.add(H);
  for (std::size_t c = 0; c < 6; ++c) blocks[c].of[n] = *numbers[c];
}

void add_to(BlockNumbers& sum, const FloatArray& more, const Range& range) {
  for (std::size_t n = 0; n < range.count; ++n) sum.of[n] += more[range.first + n];
}

std::array<float*, 3> from(BlockVectors& a, std::size_t n) {
  return {a[0].of + n, a[1].of + n, a[2].of + n};
}

Jacobians jacobians_of(const Springs& springs, float h) {
  return with_springs(springs, [&](const auto& each) {
    if constexpr (std::is_same_v<std::decay_t<decltype(each)>, LatticeStencil>)
      return Jacobians(each, h, each.planes() * each.plane_size() <= most_kept_particles);
    else
      return Jacobians(each, h, each.count() <= most_kept_particles);
  });
}

}  // namespace

ImplicitEuler::ImplicitEuler(const StepParts& parts)
    : model_(parts.model),
      dynamics_(parts.dynamics),
      springs_(parts.springs),
      lengths_(parts.lengths),
      mass_(parts.mass),
      inverse_mass_(parts.inverse_mass),
      workers_(parts.workers),
      ahead_(dynamics_.grounds(), dynamics_.contact(), model_->contact.model == ContactModel::coulomb),
      limits_(model_->simulation.implicit),
      h_(static_cast<float>(model_->simulation.timestep)),
      system_(model_->particle_count(), parts.margin) {
  for (const Springs& each : springs_) jacobians_.push_back(jacobians_of(each, h_));
  cut_into_blocks();
  sums_.resize(blocks_.size());
  largest_.resize(blocks_.size());
  falling_.resize(blocks_.size());
  const std::size_t count = model_->particle_count();
  if (model_->contact.model == ContactModel::course) held_force_ = vector_array(count, slice);
  if (ahead_.acts()) clearance_ = FloatArray(count, slice);
  if (has_body_contact(*model_))
    bodies_ = std::make_unique<ImplicitBodyContact>(*model_, inverse_mass_, workers_);
}

void ImplicitEuler::constants_changed() {
  ahead_ = {dynamics_.grounds(), dynamics_.contact(), model_->contact.model == ContactModel::coulomb};
  limits_ = reference::SolveLimits<float>(model_->simulation.implicit);
  h_ = static_cast<float>(model_->simulation.timestep);
  for (std::size_t body = 0; body < springs_.size(); ++body)
    with_springs(springs_[body], [&](const auto& each) { jacobians_[body].set_constants(each, h_); });
  if (bodies_) bodies_ = std::make_unique<ImplicitBodyContact>(*model_, inverse_mass_, workers_);
}

template <class Task>
void ImplicitEuler::for_each_block(const Task& task) {
  workers_.run(blocks_.size(), [&](std::size_t n) { task(blocks_[n], n); });
}

float ImplicitEuler::sum_of_blocks() const {
  return physics::tree_sum(sums_);
}

Linearization ImplicitEuler::at(const VectorArray& v, float h) const {
  return {&start_->x, &v, mass_.data(), &dynamics_.body_force(), h};
}

void ImplicitEuler::begin_block(Block& block) {
  block.near = near_terrain(*model_, box_of(start_->x, block.range));
  if (model_->contact.model == ContactModel::course) return hold_contact_force(block);
  if (!ahead_.acts()) return;
  for (std::size_t i = block.range.first; i < block.range.first + block.range.count; ++i)
    clearance_[i] = clearance(parallel::vector_of(start_->x, i));
}

/// The course model's contact force at the step's start. A step of no length linearizes there.
void ImplicitEuler::hold_contact_force(const Block& block) {
  const Range& range = block.range;
  if (!block.near) {
    for (FloatArray& component : held_force_) std::fill_n(component.data() + range.first, range.count, 0.0f);
    return;
  }
  BlockForces before;
  forces(block, at(start_->v, 0.0f), before);
  for (std::size_t n = 0; n < range.count; ++n) {
    const std::size_t i = range.first + n;
    const Vector f = vector_of(before.f, n);
    const Vector with =
        inverse_mass_[i] == 0.0f
            ? f
            : dynamics_.with_contact(parallel::vector_of(start_->x, i), parallel::vector_of(start_->v, i), f);
    parallel::set(held_force_, i, with - f);
  }
}

/// Springs and pulls, at the trial velocity and with the step of `at`.
void ImplicitEuler::forces(const Block& block, const Linearization& at, BlockForces& out) {
  for (const Segment& segment : block.segments) {
    const std::size_t n = segment.first - block.range.first;
    LinearizedForces to = {from(out.f, n), {}};
    for (std::size_t c = 0; c < 6; ++c) to.block[c] = out.diagonal[c].of + n;
    with_springs(springs_[segment.body],
                 [&](const auto& springs) { linearize(springs, jacobians_[segment.body], at, segment, to); });
  }
  for (std::size_t k = 0; k < dynamics_.pulls().size(); ++k) {
    const physics::PullConstants<float>& pull = dynamics_.pulls()[k];
    const auto i = static_cast<std::size_t>(pull.particle);
    const std::size_t n = i - block.range.first;
    if (n >= block.range.count) continue;
    const auto [f, H] =
        physics::linearized<float>(pull, at.h, parallel::vector_of(*at.x, i), parallel::vector_of(*at.v, i));
    set(out.f, n, vector_of(out.f, n) + f);
    add(out.diagonal, n, H);
    pull_jacobian_[k] = H;
  }
}

reference::Trial<float> ImplicitEuler::start() {
  lengths_.set(dynamics_, 0.0);
  for_each_block([&](Block& block, std::size_t) {
    begin_block(block);
    for (std::size_t c = 0; c < 3; ++c)
      std::copy_n(start_->v[c].data() + block.range.first, block.range.count,
                  end_->v[c].data() + block.range.first);
  });
  in_contact_ = bodies_ && bodies_->start(dynamics_.step(), *start_, start_force());
  lengths_.set(dynamics_, 1.0);
  return evaluate();
}

/// Of particles in ascending order: springs are evaluated block by block. A step of no length linearizes
/// there.
ImplicitBodyContact::Force ImplicitEuler::start_force() {
  return [this, of = std::make_shared<BlockForces>(), known = blocks_.size()](std::uint32_t i) mutable {
    const std::size_t n = i / block_size;
    if (n != known) forces(blocks_[n], at(start_->v, 0.0f), *of);
    known = n;
    return vector_of(of->f, i - blocks_[n].range.first);
  };
}

reference::Trial<float> ImplicitEuler::update_contacts(bool from_trial) {
  if (!from_trial)
    for (std::size_t c = 0; c < 3; ++c)
      std::copy_n(system_.base[c].data(), model_->particle_count(), end_->v[c].data());
  lengths_.set(dynamics_, 0.0);
  in_contact_ = bodies_->search_again(*start_, end_->v, h_, start_force());
  lengths_.set(dynamics_, 1.0);
  return evaluate();
}

reference::Trial<float> ImplicitEuler::fall() {
  const Vector gained = h_ * dynamics_.body_force().gravity;
  for_each_block([&](Block& block, std::size_t) {
    for (std::size_t i = block.range.first; i < block.range.first + block.range.count; ++i) {
      if (inverse_mass_[i] != 0.0f) parallel::set(end_->v, i, parallel::vector_of(start_->v, i) + gained);
    }
  });
  return evaluate();
}

reference::Trial<float> ImplicitEuler::try_step(float lambda, bool onwards) {
  for_each_block(
      [&](Block& block, std::size_t) { try_velocity(system_, end_->v, block.range, onwards, lambda); });
  return evaluate();
}

reference::Trial<float> ImplicitEuler::evaluate() {
  const bool course = model_->contact.model == ContactModel::course;
  const bool pushes = in_contact_ && bodies_->react(end_->v, course ? &held_force_ : nullptr);
  for_each_block([&](Block& block, std::size_t n) {
    const ResidualShare share = evaluate_block(block);
    largest_[n] = share.largest;
    sums_[n] = share.merit;
    falling_[n] = share.falling;
  });
  const auto holds = [](const Block& block) { return !block.held.empty(); };
  prescribes_ = std::ranges::any_of(blocks_, &Block::prescribes);
  return {physics::tree_max(largest_), sum_of_blocks(), physics::tree_sum(falling_),
          pushes || std::ranges::any_of(blocks_, holds)};
}

ResidualShare ImplicitEuler::evaluate_block(Block& block) {
  BlockForces at_trial;
  forces(block, at(end_->v, h_), at_trial);
  const bool course = model_->contact.model == ContactModel::course;
  const BlockResidual at = {&start_->v,
                            &end_->v,
                            in_contact_ ? &bodies_->force()
                            : course    ? &held_force_
                                        : nullptr,
                            mass_.data(),
                            inverse_mass_.data(),
                            h_,
                            ahead_.acts() ? clearance_.data() : nullptr};
  for (std::size_t c = 0; in_contact_ && c < 6; ++c)
    add_to(at_trial.diagonal[c], bodies_->blocks()[c], block.range);
  BlockVectors R, free;
  BlockNumbers meets;
  block.held.clear();
  block.prescribes = false;
  if (residuals(at, block.range, at_trial.f, system_.r, R, free, meets))
    meet_ground(block, free, meets, R, at_trial.diagonal);
  invert(at_trial.diagonal, block.range, system_);
  const Vector fall = h_ * dynamics_.body_force().gravity;
  return share_of(R, inverse_mass_.data() + block.range.first, {fall.x(), fall.y(), fall.z()},
                  block.range.count);
}

/// The ground's reaction on those particles of a block that may meet it.
void ImplicitEuler::meet_ground(Block& block, const BlockVectors& free, const BlockNumbers& meets,
                                BlockVectors& R, std::array<BlockNumbers, 6>& diagonal) {
  std::vector<physics::Gap<float>> gaps;
  for (std::size_t n = 0; n < block.range.count; ++n) {
    if (meets.of[n] == 0.0f) continue;
    const std::size_t i = block.range.first + n;
    gaps.clear();
    for (const physics::Ground<float>& ground : dynamics_.grounds())
      gaps.push_back(physics::gap<float>(ground, ground.start, parallel::vector_of(start_->x, i)));
    const auto reaction = ahead_.react_to(gaps.data(), mass_[i], vector_of(free, n));
    if (reaction.freedom == physics::Freedom::all) continue;
    const Vector residual = parallel::vector_of(end_->v, i) - reaction.v;
    const Vector prescribed = -reaction.held_part(residual);
    set(R, n, residual);
    parallel::set(system_.r, i, reaction.right_hand_side(mass_[i], residual));
    add(diagonal, n, {reaction.stiffness, 0.0f, reaction.across});
    block.held.push_back({i, reaction, prescribed});
    block.prescribes = block.prescribes || (prescribed.array() != 0.0f).any();
  }
}

/// z = A·p
void ImplicitEuler::multiply_block(const Block& block, const VectorArray& p) {
  const Range& range = block.range;
  BlockVectors product;
  for (const Segment& segment : block.segments) {
    with_springs(springs_[segment.body], [&](const auto& springs) {
      multiply(springs, jacobians_[segment.body], at(end_->v, h_), p, segment,
               from(product, segment.first - range.first));
    });
  }
  for (std::size_t k = 0; k < dynamics_.pulls().size(); ++k) {
    const auto i = static_cast<std::size_t>(dynamics_.pulls()[k].particle);
    if (i - range.first >= range.count) continue;
    set(product, i - range.first,
        vector_of(product, i - range.first) + pull_jacobian_[k] * parallel::vector_of(p, i));
  }
  for (std::size_t c = 0; in_contact_ && c < 3; ++c) add_to(product[c], bodies_->product()[c], range);
  for (const Held& held : block.held) {
    const std::size_t n = held.particle - range.first;
    const Vector p_i = parallel::vector_of(p, held.particle);
    set(product, n, held.reaction.free_product(p_i, vector_of(product, n)));
  }
  const float* const w = inverse_mass_.data() + range.first;
  for (std::size_t c = 0; c < 3; ++c) {
    float* const z = system_.z[c].data() + range.first;
    for (std::size_t n = 0; n < range.count; ++n) z[n] = w[n] == 0.0f ? 0.0f : product[c].of[n];
  }
}

void ImplicitEuler::update_block(const Block& block, Update how, float alpha) {
  update(system_, block.range, how, alpha);
  for (const Held& held : block.held) {
    const Vector z = parallel::vector_of(system_.z, held.particle);
    parallel::set(system_.z, held.particle, held.reaction.free_part(z));
  }
}

float ImplicitEuler::start_solve() {
  if (prescribes_) {
    for_each_block([&](Block& block, std::size_t) {
      for (FloatArray& component : system_.delta)
        std::fill_n(component.data() + block.range.first, block.range.count, 0.0f);
      for (const Held& held : block.held) parallel::set(system_.delta, held.particle, held.prescribed);
    });
    if (in_contact_) bodies_->multiply(system_.delta);
    for_each_block([&](Block& block, std::size_t) { multiply_block(block, system_.delta); });
  }
  for_each_block([&](Block& block, std::size_t n) {
    update_block(block, prescribes_ ? Update::prescribed : Update::none, 1.0f);
    parallel::turn(system_, block.range, true, 0.0f);
    sums_[n] = dot(system_.r, system_.z, block.range);
  });
  return sum_of_blocks();
}

float ImplicitEuler::apply() {
  if (in_contact_) bodies_->multiply(system_.p);
  for_each_block([&](Block& block, std::size_t n) {
    multiply_block(block, system_.p);
    sums_[n] = dot(system_.p, system_.z, block.range);
  });
  return sum_of_blocks();
}

float ImplicitEuler::advance(float alpha, bool first) {
  for_each_block([&](Block& block, std::size_t n) {
    update_block(block, first ? Update::first : Update::further, alpha);
    sums_[n] = dot(system_.r, system_.z, block.range);
  });
  return sum_of_blocks();
}

void ImplicitEuler::turn(float beta) {
  for_each_block([&](Block& block, std::size_t) { parallel::turn(system_, block.range, false, beta); });
}

bool ImplicitEuler::step(Particles& start, Particles& end, SolveReport& report) {
  start_ = &start;
  end_ = &end;
  pull_jacobian_.resize(dynamics_.pulls().size());
  const bool accepted = reference::solve_step(*this, limits_, report);
  std::atomic<bool> sound = true;
  for_each_block([&](Block& block, std::size_t) {
    if (!accepted) {
      for (std::size_t c = 0; c < 3; ++c)
        std::copy_n(system_.base[c].data() + block.range.first, block.range.count,
                    end.v[c].data() + block.range.first);
    }
    if (!end_block(block)) sound.store(false, std::memory_order_relaxed);
  });
  return sound;
}

bool ImplicitEuler::look_at(const Particles& start) {
  return all_sound(start, {0, model_->particle_count()}, speed_limit);
}

/// What the ground prescribes, the positions, and the terrain's response.
bool ImplicitEuler::end_block(const Block& block) {
  const Range& range = block.range;
  std::array<const physics::GroundReaction<float>*, block_size> reactions{};
  for (const Held& held : block.held) {  // the ground gives way by no tolerance
    parallel::set(end_->v, held.particle, parallel::vector_of(end_->v, held.particle) + held.prescribed);
    reactions[held.particle - range.first] = &held.reaction;
  }
  drift(start_->x, end_->v, h_, end_->x, range);
  if (!block.held.empty() || near_terrain(*model_, box_of(end_->x, range))) {
    for (std::size_t n = 0; n < range.count; ++n) {
      const std::size_t i = range.first + n;
      if (inverse_mass_[i] == 0.0f) continue;
      const Vector x_0 = parallel::vector_of(start_->x, i), v_0 = parallel::vector_of(start_->v, i);
      Vector x = parallel::vector_of(end_->x, i), v = parallel::vector_of(end_->v, i);
      if (!ahead_.acts()) dynamics_.respond(static_cast<Eigen::Index>(i), x_0, v_0, x, v);
      for (std::size_t t = 0; ahead_.acts() && t < dynamics_.grounds().size(); ++t)
        physics::respond_solved<float>(dynamics_.grounds()[t], dynamics_.contact(),
                                       dynamics_.body_force().gravity, mass_[i],
                                       reactions[n] != nullptr && reactions[n]->holds(t), x_0, v_0, x, v);
      parallel::set(end_->x, i, x);
      parallel::set(end_->v, i, v);
    }
  }
  return all_sound(*end_, range, speed_limit);
}

}  // namespace aspic::parallel

#include "cpu_parallel/explicit.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>

#include "cpu_parallel/contact_kernels.h"
#include "cpu_parallel/contact_pieces.h"

namespace aspic::parallel {
namespace {

/// Particles whose box is looked at together where terrain is near, and of a task of a body with lists: their
/// forces stay in the first-level cache.
constexpr std::size_t piece_size = 1024;
/// Planes of a task of a cube, at least, where a cube is cut into more tasks than there are threads: at its
/// lower side springs of two planes are evaluated again.
constexpr std::size_t least_planes = 24;
/// Of a task of a body with bands, as many particles as the springs reach that many times.
constexpr std::size_t least_reaches = 12;
/// Bodies whose boxes are compared pair by pair, at most.
constexpr std::size_t most_boxes = 64;

/// Calls f(part) for parts of a range of at most `size`.
template <class F>
void for_parts(Range range, std::size_t size, const F& f) {
  for (std::size_t at = 0; at < range.count; at += size)
    f(Range{range.first + at, std::min(size, range.count - at)});
}

/// Around both.
Box around(Box a, const Box& b) {
  for (std::size_t c = 0; c < 3; ++c) {
    a.min[c] = std::min(a.min[c], b.min[c]);
    a.max[c] = std::max(a.max[c], b.max[c]);
  }
  return a;
}

/// Whether two boxes are less than `margin` [m] apart, or one of them holds numbers that are none.
bool meet(const Box& a, const Box& b, float margin) {
  for (std::size_t c = 0; c < 3; ++c)
    if (a.min[c] > b.max[c] + margin || b.min[c] > a.max[c] + margin) return false;
  return true;
}

physics::ParticleView<const float> view(const Particles& particles) {
  const auto of = [](const VectorArray& a) { return std::array{a[0].data(), a[1].data(), a[2].data()}; };
  return {of(particles.x), of(particles.v), 1};
}

}  // namespace

ExplicitSteps::ExplicitSteps(const StepParts& parts)
    : model_(parts.model),
      method_(*row_of(parts.model->simulation.integrator).staged()),
      dynamics_(parts.dynamics),
      springs_(parts.springs),
      lengths_(parts.lengths),
      mass_(parts.mass),
      inverse_mass_(parts.inverse_mass),
      workers_(parts.workers) {
  std::size_t plane_size = 0, row_size = 0, reach = 0, most = 0;
  for (std::size_t body = 0; body < springs_.size(); ++body) {
    if (const auto* const lattice = std::get_if<LatticeStencil>(&springs_[body])) {
      plane_size = std::max(plane_size, lattice->plane_size());
      row_size = std::max(row_size, lattice->row_size());
    }
    if (const auto* const bands = std::get_if<Bands>(&springs_[body])) {
      reach = std::max(reach, bands->reach());
      most = std::max(most, bands->most());
    }
    cut(body);
  }
  for (unsigned n = 0; most > 0 && n < workers_.threads(); ++n) band_sweeps_.emplace_back(reach, most);
  for (unsigned n = 0; plane_size > 0 && n < workers_.threads(); ++n)
    sweeps_.emplace_back(plane_size, row_size);
  ExplicitSteps::constants_changed();
  if (method_.stages.size() == 1) return;
  sums_ = Particles(model_->particle_count(), slice);
  between_ = Particles(model_->particle_count(), parts.margin);
}

void ExplicitSteps::constants_changed() {
  known_ = false;
  bodies_ = has_body_contact(*model_) ? std::make_unique<collision::ContactSearch<float>>(*model_) : nullptr;
  if (bodies_) bodies_->set_kernels(closest_points_in_lanes, contacts_in_lanes);
}

std::uint64_t ExplicitSteps::bytes() const {
  std::uint64_t sum = sizeof(*this) + bytes_of(sums_) + bytes_of(between_) + bytes_of(tasks_) +
                      bytes_of(sweeps_) + bytes_of(band_sweeps_) + bytes_of(force_with_contact_) +
                      bytes_of(kept_force_) + bytes_of(kept_sums_);
  for (const Task& task : tasks_) sum += bytes_of(task.near) + bytes_of(task.resting);
  for (const Sweep& sweep : sweeps_) sum += sweep.bytes();
  for (const BandSweep& sweep : band_sweeps_) sum += sweep.bytes();
  return bodies_ ? sum + bodies_->bytes() : sum;
}

void ExplicitSteps::cut(std::size_t body) {
  const auto add = [&](Range range) { tasks_.push_back({body, range, {}, true, {}, {}, 0}); };
  if (const auto* const lists = std::get_if<SpringLists>(&springs_[body]))
    return for_parts({lists->first(), lists->count()}, piece_size, add);
  if (const auto* const bands = std::get_if<Bands>(&springs_[body])) {
    // At its lower side springs that reach into a task are evaluated again.
    const std::size_t least = std::max(least_reaches * bands->reach(), band_piece);
    const std::size_t parts = workers_.threads() == 1 ? 1 : std::max<std::size_t>(1, bands->count() / least);
    const std::size_t size = (bands->count() + parts - 1) / parts;
    return for_parts({bands->first(), bands->count()}, (size + slice - 1) / slice * slice, add);
  }
  const auto& lattice = std::get<LatticeStencil>(springs_[body]);
  const std::size_t planes = lattice.planes(), threads = workers_.threads();
  const std::size_t tasks =
      threads == 1 ? 1
                   : std::min(planes, threads * std::max<std::size_t>(1, planes / (threads * least_planes)));
  for (std::size_t n = 0; n < tasks; ++n) {
    const std::size_t from = planes * n / tasks, to = planes * (n + 1) / tasks;
    add({lattice.first() + from * lattice.plane_size(), (to - from) * lattice.plane_size()});
  }
}

bool ExplicitSteps::look_at(const Particles& start) {
  workers_.run(tasks_.size(), [&](std::size_t n) {
    Task& task = tasks_[n];
    task.box = box_of(start.x, task.range);
    find_near(task, start.x);
    task.sound = all_sound(start, task.range, speed_limit);
  });
  known_ = true;
  return std::ranges::all_of(tasks_, &Task::sound);
}

/// Whether boxes show that no bodies are near each other, so that none has to be looked at.
bool ExplicitSteps::all_apart() {
  if (model_->contact.self || springs_.size() > most_boxes) return false;
  constexpr float far = std::numeric_limits<float>::infinity();
  body_boxes_.assign(springs_.size(), Box{{far, far, far}, {-far, -far, -far}});
  for (const Task& task : tasks_) body_boxes_[task.body] = around(body_boxes_[task.body], task.box);
  const auto margin = static_cast<float>(1.01 * bodies_->most_margin());
  for (std::size_t a = 0; a < body_boxes_.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (meet(body_boxes_[a], body_boxes_[b], margin)) return false;
  return true;
}

bool ExplicitSteps::step(Particles& start, Particles& end, SolveReport&) {
  if (!known_) look_at(start);
  const bool may_contact =
      bodies_ && !all_apart() && bodies_->begin_step(dynamics_.step(), view(start), on_workers());
  if (may_contact) {
    force_with_contact_.resize(bodies_->particles().size());
    kept_force_.resize(force_with_contact_.size());
    if (method_.stages.size() > 1) kept_sums_.resize(force_with_contact_.size());
  }
  const double h = model_->simulation.timestep;
  const std::size_t stages = method_.stages.size();
  const Particles* at = &start;
  bool accumulate = false;
  for (std::size_t s = 0; s < stages; ++s) {
    const Stage& stage = method_.stages[s];
    // Stages take turns between two sets of arrays, so that the last one is in `end`.
    Particles* const to = (stages - s) % 2 == 1 ? &end : &between_;
    const StageMove move = {&start,
                            at,
                            to,
                            &sums_,
                            inverse_mass_.data(),
                            static_cast<float>(h * stage.advance),
                            static_cast<float>(stage.weight),
                            static_cast<float>(h / method_.divisor),
                            accumulate,
                            s + 1 == stages,
                            method_.drift};
    lengths_.set(dynamics_, s == 0 ? 0.0 : method_.stages[s - 1].advance);
    in_contact_ = may_contact && bodies_->find(view(*at), on_workers());
    workers_.run(tasks_.size(), [&](std::size_t n) {
      if (!dynamics_.interrupted()) run(tasks_[n], move);
    });
    if (in_contact_ && !dynamics_.interrupted()) contact(move);
    accumulate = accumulate || stage.weight != 0.0;
    at = to;
  }
  return std::ranges::all_of(tasks_, &Task::sound);
}

/// One stage of the particles of a task.
void ExplicitSteps::run(Task& task, const StageMove& stage) {
  alignas(64) float f[3][piece_size + slice];
  const Forces forces = {{f[0], f[1], f[2]}};
  const ForceInput input = {stage.at, mass_.data(), &dynamics_.body_force()};
  const bool near = near_terrain(*model_, task.box);
  if (stage.at == stage.start) find_resting(task, stage);
  if (in_contact_) task.kept = first_contact_particle(task);
  Moved moved(speed_limit);
  if (const auto* const lattice = std::get_if<LatticeStencil>(&springs_[task.body])) {
    const std::size_t size = lattice->plane_size();
    const std::size_t from = (task.range.first - lattice->first()) / size,
                      to = from + task.range.count / size;
    Sweep& sweep = sweeps_[workers_.current()];
    for (std::size_t plane = from; plane < std::min(from + 2, lattice->planes()); ++plane)
      begin_plane(*lattice, input, sweep, plane);
    for (std::size_t below = std::min<std::size_t>(from, 2); below > 0; --below)
      lattice_ghosts(*lattice, input, sweep, from - below, static_cast<int>(below));
    for (std::size_t plane = from; plane < to; ++plane) {
      if (plane + 2 < lattice->planes()) begin_plane(*lattice, input, sweep, plane + 2);
      for_parts({0, size}, chunk_size, [&](Range own) {
        lattice_forces(*lattice, input, sweep, plane, own, forces);
        finish(task, stage, near, {lattice->first() + plane * size + own.first, own.count}, forces, moved);
      });
    }
  } else if (std::holds_alternative<Bands>(springs_[task.body])) {
    run_bands(task, stage, input, near, moved);
  } else {
    const auto& lists = std::get<SpringLists>(springs_[task.body]);
    listed_forces(lists, input, {task.range.first - lists.first(), task.range.count}, forces);
    finish(task, stage, near, task.range, forces, moved);
  }
  task.box = moved.box();
  task.sound = moved.sound;
  if (in_contact_) return;  // some move again first
  end(task, stage);
}

void ExplicitSteps::run_bands(Task& task, const StageMove& stage, const ForceInput& input, bool near,
                              Moved& moved) {
  alignas(64) float f[3][band_piece + slice];
  const Forces forces = {{f[0], f[1], f[2]}};
  const auto& bands = std::get<Bands>(springs_[task.body]);
  BandSweep& sweep = band_sweeps_[workers_.current()];
  const std::size_t from = task.range.first - bands.first();
  const std::size_t below = from - std::min(from, (bands.reach() + slice - 1) / slice * slice);
  sweep.begin(bands, input, below);
  for_parts({below, from - below}, band_piece, [&](Range part) {
    band_ghosts(bands, input, sweep, part.count, from);
    sweep.advance(bands, input, part.count);
  });
  for_parts({from, task.range.count}, band_piece, [&](Range own) {
    band_forces(bands, input, sweep, own.count, forces);
    finish(task, stage, near, {bands.first() + own.first, own.count}, forces, moved);
    sweep.advance(bands, input, (own.count + slice - 1) / slice * slice);
  });
}

/// What ends a stage of a task whose particles have moved.
void ExplicitSteps::end(Task& task, const StageMove& stage) {
  if (!stage.last) return;
  find_near(task, stage.next->x);
  respond(task, stage);
}

namespace {

Vector force_at(const Forces& forces, std::size_t n) {
  return {forces.component[0][n], forces.component[1][n], forces.component[2][n]};
}
void put_force(const Forces& forces, std::size_t n, const Vector& f) {
  for (std::size_t c = 0; c < 3; ++c) forces.component[c][n] = f[static_cast<Eigen::Index>(c)];
}

}  // namespace

/// What comes after the springs of some of a task's particles.
void ExplicitSteps::finish(Task& task, const StageMove& stage, bool near, Range range, const Forces& forces,
                           Moved& moved) {
  pull(stage, range, forces);
  if (in_contact_) keep_contact_particles(task, stage, range, forces);
  if (near || !task.resting.empty()) add_contact(task, stage, range, forces);
  move(stage, range, forces, moved);
}

/// Stores what is needed to move the particles of a range again that may be in contact with bodies.
void ExplicitSteps::keep_contact_particles(Task& task, const StageMove& stage, Range range,
                                           const Forces& forces) {
  const auto all = bodies_->particles();
  for (; task.kept < all.size() && all[task.kept] < range.first + range.count; ++task.kept) {
    const std::size_t i = all[task.kept];
    force_with_contact_[task.kept] = kept_force_[task.kept] = force_at(forces, i - range.first);
    if (stage.accumulate) kept_sums_[task.kept] = {vector_of(stage.sums->x, i), vector_of(stage.sums->v, i)};
  }
}

/// Adds normal forces and friction of bodies, then completes the stage of the particles in contact.
void ExplicitSteps::contact(const StageMove& stage) {
  bodies_->add_forces(
      view(*stage.start), [&](std::uint32_t p) { return inverse_mass_[p]; }, force_with_contact_,
      on_workers());
  workers_.run(tasks_.size(), [&](std::size_t n) {
    move_contact_particles(tasks_[n], stage);
    end(tasks_[n], stage);
  });
}

/// Moves the particles of a task on which contact forces act, from where the stage began.
void ExplicitSteps::move_contact_particles(Task& task, const StageMove& stage) {
  const auto all = bodies_->particles();
  alignas(64) float f[3][slice] = {};
  const Forces forces = {{f[0], f[1], f[2]}};
  Moved moved(speed_limit);
  const auto same = [&](std::size_t n) {
    return std::memcmp(force_with_contact_[n].data(), kept_force_[n].data(), sizeof(Vector)) == 0;
  };
  for (std::size_t n = first_contact_particle(task); n < task.kept;) {
    if (same(n)) {
      ++n;
      continue;
    }
    // One after the other, they move together.
    Range part = {all[n], 0};
    for (; n < task.kept && part.count < slice && all[n] == part.first + part.count; ++n, ++part.count) {
      put_force(forces, part.count, force_with_contact_[n]);
      if (!stage.accumulate) continue;
      set(stage.sums->x, all[n], kept_sums_[n][0]);
      set(stage.sums->v, all[n], kept_sums_[n][1]);
    }
    add_contact(task, stage, part, forces);
    move(stage, part, forces, moved);
  }
  task.box = around(task.box, moved.box());
  task.sound = task.sound && moved.sound;
}

/// Index of the first particle of a task among those that may be in contact with bodies.
std::size_t ExplicitSteps::first_contact_particle(const Task& task) const {
  const auto all = bodies_->particles();
  return static_cast<std::size_t>(std::ranges::lower_bound(all, task.range.first) - all.begin());
}

void ExplicitSteps::pull(const StageMove& stage, Range range, const Forces& forces) {
  for (const physics::PullConstants<float>& pull : dynamics_.pulls()) {
    const auto i = static_cast<std::size_t>(pull.particle);
    if (i - range.first >= range.count) continue;
    put_force(forces, i - range.first,
              force_at(forces, i - range.first) +
                  physics::pull_force<float>(pull, vector_of(stage.at->x, i), vector_of(stage.at->v, i)));
  }
}

namespace {

/// Calls f(part) for runs of those particles of a part in the box, of at most `slice`, that are not in front
/// of every terrain: a cube that lies on the ground has a few in nearly every slice.
template <class F>
void for_behind(const Model& model, const VectorArray& x, Range part, const Box& box, const F& f) {
  std::uint32_t behind = 0;
  for (const Terrain& terrain : model.terrain) {
    const FarSide side = far_side(model, terrain, box);
    for (std::size_t n = 0; n < part.count; ++n) {
      const std::size_t i = part.first + n;
      const bool far = dot(side.normal, Vec3{x[0][i], x[1][i], x[2][i]}) > side.limit;
      behind |= std::uint32_t{!far} << n;
    }
  }
  for (std::size_t n = 0; behind >> n != 0;) {
    n += static_cast<std::size_t>(std::countr_zero(behind >> n));
    const auto count = static_cast<std::size_t>(std::countr_one(behind >> n));
    f(Range{part.first + n, count});
    n += count;
  }
}

}  // namespace

/// Calls f(part) for runs of particles of a range that may be near terrain.
template <class F>
void ExplicitSteps::for_near(const VectorArray& x, Range range, const F& f) const {
  for_parts(range, piece_size, [&](Range piece) {
    if (!near_terrain(*model_, box_of(x, piece))) return;
    for_parts(piece, slice, [&](Range part) {
      const Box box = box_of(x, part);
      if (near_terrain(*model_, box)) for_behind(*model_, x, part, box, f);
    });
  });
}

void ExplicitSteps::find_near(Task& task, const VectorArray& x) const {
  task.near.clear();
  if (near_terrain(*model_, task.box))
    for_near(x, task.range, [&](Range part) { task.near.push_back(part); });
}

void ExplicitSteps::find_resting(Task& task, const StageMove& stage) const {
  task.resting.clear();
  for (const Range& part : task.near) {
    for (std::size_t i = part.first; i < part.first + part.count; ++i)
      dynamics_.find_resting(static_cast<Eigen::Index>(i), vector_of(stage.at->x, i),
                             vector_of(stage.at->v, i), task.resting);
  }
}

/// What terrain adds to the forces.
void ExplicitSteps::add_contact(Task& task, const StageMove& stage, Range range, const Forces& forces) {
  const VectorArray &x = stage.at->x, &v = stage.at->v;
  if (model_->contact.model == ContactModel::course) {
    return for_near(x, range, [&](Range part) {
      for (std::size_t i = part.first; i < part.first + part.count; ++i) {
        const std::size_t n = i - range.first;
        if (inverse_mass_[i] != 0.0f)
          put_force(forces, n, dynamics_.with_contact(vector_of(x, i), vector_of(v, i), force_at(forces, n)));
      }
    });
  }
  using Contact = physics::RestingContact<float>;
  const auto particle = [](const Contact& at) { return static_cast<std::size_t>(at.particle); };
  for (auto at = std::ranges::lower_bound(task.resting, range.first, {}, particle);
       at != task.resting.end() && particle(*at) < range.first + range.count; ++at) {
    const std::size_t n = particle(*at) - range.first;
    put_force(forces, n, physics::with_reaction<float>(*at, force_at(forces, n)));
  }
}

/// Terrain response at the end of the step. Particles that it moves are checked again, for the box and for
/// divergence.
void ExplicitSteps::respond(Task& task, const StageMove& stage) {
  Particles& next = *stage.next;
  for (const Range& part : task.near) {
    for (std::size_t i = part.first; i < part.first + part.count; ++i) {
      Vector x = vector_of(next.x, i), v = vector_of(next.v, i);
      dynamics_.respond(static_cast<Eigen::Index>(i), vector_of(stage.start->x, i),
                        vector_of(stage.start->v, i), x, v);
      set(next.x, i, x);
      set(next.v, i, v);
    }
    task.box = around(task.box, box_of(next.x, part));
    task.sound = task.sound && all_sound(next, part, speed_limit);
  }
  if (!task.sound) task.sound = all_sound(next, task.range, speed_limit);
}

}  // namespace aspic::parallel

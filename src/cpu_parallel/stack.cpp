#include "cpu_parallel/stack.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "cpu_parallel/contact_pieces.h"
#include "model/contact_surface.h"
#include "model/inputs.h"
#include "physics/divergence.h"

namespace aspic::parallel {
namespace {

/// Particles at most: the rows of 16 models fill about 2 MB. Larger ones are faster alone.
constexpr std::uint32_t most_particles = 2048;
constexpr auto constant_rows = static_cast<std::size_t>(ConstantRow::count);

Vector vector_at(const Forces& forces, std::size_t n) {
  return {forces.component[0][n], forces.component[1][n], forces.component[2][n]};
}
void put(const Forces& forces, std::size_t n, const Vector& f) {
  for (std::size_t c = 0; c < 3; ++c) forces.component[c][n] = f[static_cast<Eigen::Index>(c)];
}
Forces forces_of(VectorArray& f) {
  return {{f[0].data(), f[1].data(), f[2].data()}};
}

template <class F>
void for_bits(std::uint32_t bits, const F& f) {
  for (; bits != 0; bits &= bits - 1) f(static_cast<std::size_t>(std::countr_zero(bits)));
}

/// The vectors of one lane.
template <class T, class AnyArray>
Strided<T> column(AnyArray& array, std::size_t lane, std::size_t count) {
  return {array[0].data() + lane, count, stack_lanes, array[1].data() - array[0].data()};
}

}  // namespace

bool Stack::takes(const Model& model) {
  return row_of(model.simulation.integrator).staged() && model.ball_count() == 0 &&
         !has_body_contact(model) && model.particle_count() > 0 && model.particle_count() <= most_particles;
}

bool Stack::same(const Model& a, const Model& b) {
  return a.simulation.timestep == b.simulation.timestep && check_same_topology(a, b);
}

Stack::Stack(const std::vector<SharedModel>& models, std::shared_ptr<const UpperEnds> springs)
    : particles_(models.front()->particle_count()), springs_(std::move(springs)) {
  const Model& first = *models.front();
  const std::size_t size = particles_ * stack_lanes;
  for (Particles* const each : {&state_, &next_}) *each = Particles(size, 0);
  if (row_of(first.simulation.integrator).staged()->stages.size() > 1)
    for (Particles* const each : {&between_, &sums_}) *each = Particles(size, 0);
  force_ = vector_array(size, 0);
  mass_ = FloatArray(size, 0);
  inverse_mass_ = FloatArray(size, 0);
  constants_ = FloatArray(first.spring_classes.size() * constant_rows * stack_lanes, 0);
  fronts_.resize(first.terrain.size());
  near_.reserve(particles_);
  for (const SharedModel& model : models) {
    const std::size_t lane = lanes_.size();
    lanes_.emplace_back(model);
    take_constants(lane);
    take_masses(lane, {});
    const State start = initial_state(*model, Precision::single);
    load(lane, view_of(start), start.step);
  }
}

std::uint64_t Stack::bytes() const {
  std::uint64_t sum = sizeof(*this) + bytes_of(lanes_) + bytes_of(fronts_) + bytes_of(near_) +
                      bytes_of(force_) + bytes_of(mass_) + bytes_of(inverse_mass_) + bytes_of(constants_);
  for (const Particles* const each : {&state_, &next_, &between_, &sums_}) sum += bytes_of(*each);
  for (const Lane& lane : lanes_) sum += lane.dynamics.bytes() + bytes_of(lane.kept) + bytes_of(lane.resting);
  return sum;
}

template <class F>
void Stack::for_running(const F& f) {
  for_bits(running_, [&](std::size_t lane) { f(lanes_[lane], lane); });
}

ConstStateView Stack::view(std::size_t lane) const {
  const std::vector<float>& kept = lanes_[lane].kept;
  ConstStateView view;
  if (kept.empty()) {
    view[0] = column<const float>(state_.x, lane, particles_);
    view[1] = column<const float>(state_.v, lane, particles_);
  } else {
    view[0] = Strided<const float>{kept.data(), particles_};
    view[1] = Strided<const float>{kept.data() + 3 * particles_, particles_};
  }
  for (std::size_t n = 2; n < view.size(); ++n) view[n] = Strided<const float>{};
  return view;
}

void Stack::load(std::size_t lane, const ConstStateView& view, std::uint64_t step) {
  Lane& own = lanes_[lane];
  copy_vectors(view[0], column<float>(state_.x, lane, particles_));
  copy_vectors(view[1], column<float>(state_.v, lane, particles_));
  own.step = step;
  own.pins_held = false;
  own.kept.clear();
  // Where it had diverged, its particles were pinned.
  if (own.divergence)
    for (std::size_t i = 0; i < particles_; ++i)
      inverse_mass_[at(i, lane)] = own.dynamics.inverse_mass(static_cast<Eigen::Index>(i));
  own.divergence.reset();
  running_ |= 1u << lane;
  known_ = false;
}

void Stack::set_inputs(std::size_t lane, const Inputs& inputs) {
  lanes_[lane].dynamics.set_inputs(inputs);
  if (!lanes_[lane].divergence) take_masses(lane, inputs);
  lanes_[lane].pins_held = false;
}

void Stack::set_constants(std::size_t lane, SharedModel model, const Inputs& inputs) {
  Lane& own = lanes_[lane];
  if (own.divergence) {  // its state comes back
    const std::vector<float> kept = own.kept;
    ConstStateView last = view(lane);
    last[0] = Strided<const float>{kept.data(), particles_};
    last[1] = Strided<const float>{kept.data() + 3 * particles_, particles_};
    load(lane, last, own.step);
  }
  own.model = std::move(model);
  own.dynamics = reference::Dynamics<float>(*own.model);
  own.dynamics.set_inputs(inputs);
  own.pins_held = false;
  known_ = false;
  take_constants(lane);
  take_masses(lane, inputs);
}

void Stack::retire(std::size_t lane) {
  lanes_[lane].kept.clear();
  still(lane);
}

void Stack::take_constants(std::size_t lane) {
  const Model& model = *lanes_[lane].model;
  lanes_[lane].lengths.reset();
  if (!model.actuation.empty()) lanes_[lane].lengths.emplace(model);
  float* to = constants_.data() + lane;
  for (const SpringClass& spring : model.spring_classes) {
    const Constants of(spring);
    for (const float each : {of.stiffness, of.damping, of.rest_length, of.slack}) {
      *to = each;
      to += stack_lanes;
    }
  }
  body_forces_[lane] = lanes_[lane].dynamics.body_force();
}

/// Rest lengths that follow signals, of the stage at that share of the step.
void Stack::take_lengths(double share) {
  for_running([&](Lane& lane, std::size_t index) {
    if (!lane.lengths) return;
    const Model& model = *lane.model;
    std::size_t n = 0;
    for (const double length : lane.lengths->at(lane.step, share, lane.dynamics.channels())) {
      const std::uint32_t spring_class = model.actuation.classes[n++].spring_class;
      const auto row = [&](ConstantRow which) -> float& {
        return constants_[(spring_class * constant_rows + static_cast<std::size_t>(which)) * stack_lanes +
                          index];
      };
      row(ConstantRow::rest_length) = static_cast<float>(length);
      if (model.spring_classes[spring_class].cord) row(ConstantRow::slack) = static_cast<float>(length);
    }
  });
}

void Stack::take_masses(std::size_t lane, const Inputs& inputs) {
  const Model& model = *lanes_[lane].model;
  const auto fill = [&](FloatArray& to, const Runs<double>& from) {
    std::size_t i = 0;
    for (const auto& [end, value] : from.runs())
      for (; i < end; ++i) to[at(i, lane)] = static_cast<float>(value);
  };
  fill(mass_, model.mass);
  fill(inverse_mass_, inverse_mass_under(model, inputs));
}

/// A lane whose model diverged goes through the steps of the others at rest: nothing that it has is read.
void Stack::still(std::size_t lane) {
  for (Particles* const each : {&state_, &next_, &between_, &sums_}) {
    if (each->x[0].bytes() == 0) continue;
    for (VectorArray* const vectors : {&each->x, &each->v})
      for (FloatArray& component : *vectors)
        for (std::size_t i = 0; i < particles_; ++i) component[at(i, lane)] = 0.0f;
  }
  for (std::size_t i = 0; i < particles_; ++i) inverse_mass_[at(i, lane)] = 0.0f;
  running_ &= ~(1u << lane);
}

/// Pinned particles stand from the beginning of a step on.
void Stack::hold_pins(Lane& lane, std::size_t index) {
  if (std::exchange(lane.pins_held, true)) return;
  for (std::size_t i = 0; i < particles_; ++i) {
    const std::size_t n = at(i, index);
    if (inverse_mass_[n] != 0.0f) continue;
    if ((vector_of(state_.v, n).array() != 0.0f).any()) parallel::set(state_.v, n, Vector::Zero());
  }
}

void Stack::advance() {
  const Model& first = *lanes_.front().model;
  const Staged& method = *row_of(first.simulation.integrator).staged();
  const bool course = first.contact.model == ContactModel::course;
  const double h = first.simulation.timestep;
  for_running([&](Lane& lane, std::size_t index) {
    hold_pins(lane, index);
    lane.dynamics.begin_step(lane.step);
  });
  if (!course) {
    if (!known_) find_near(state_.x);
    find_resting();
  }
  const Particles* where = &state_;
  bool accumulate = false, sound = true;
  const std::size_t stages = method.stages.size();
  for (std::size_t s = 0; s < stages; ++s) {
    const Stage& stage = method.stages[s];
    // Stages take turns between two sets of arrays, so that the last one is in `next_`.
    Particles* const to = (stages - s) % 2 == 1 ? &next_ : &between_;
    const Forces forces = forces_of(force_);
    take_lengths(s == 0 ? 0.0 : method.stages[s - 1].advance);
    stack_forces({springs_.get(), constants_.data(), mass_.data(), body_forces_.data()}, *where, forces);
    add_pulls(*where);
    if (course) find_near(where->x);
    add_contact(*where);
    Moved moved(speed_limit);
    move({&state_, where, to, &sums_, inverse_mass_.data(), static_cast<float>(h * stage.advance),
          static_cast<float>(stage.weight), static_cast<float>(h / method.divisor), accumulate,
          s + 1 == stages, method.drift},
         {0, particles_ * stack_lanes}, forces, moved);
    accumulate = accumulate || stage.weight != 0.0;
    where = to;
    sound = moved.sound;
  }
  find_near(next_.x);
  known_ = true;
  settle(respond() && sound);
}

/// Which particles may be near terrain. Most models are far from all of it, and a box around each says so.
void Stack::find_near(const VectorArray& x) {
  near_.clear();
  if (fronts_.empty()) return;
  LaneBoxes boxes;
  lane_boxes(x, particles_, boxes);
  std::uint32_t near = 0;
  for_running([&](const Lane& lane, std::size_t index) {
    Box box;
    for (std::size_t c = 0; c < 3; ++c) {
      box.min[c] = boxes.low[c][index];
      box.max[c] = boxes.high[c][index];
    }
    if (!near_terrain(*lane.model, box)) return;
    near |= 1u << index;
    for (std::size_t n = 0; n < fronts_.size(); ++n) {
      const FarSide side = far_side(*lane.model, lane.model->terrain[n], box);
      const double normal[3] = {side.normal.x, side.normal.y, side.normal.z};
      for (std::size_t c = 0; c < 3; ++c) fronts_[n].normal[c][index] = static_cast<float>(normal[c]);
      fronts_[n].limit[index] = static_cast<float>(side.limit);
    }
  });
  if (near != 0) find_near_rows(x, particles_, fronts_, near, near_);
}

void Stack::find_resting() {
  for_running([](Lane& lane, std::size_t) { lane.resting.clear(); });
  for (const NearRow& row : near_) {
    for_bits(row.lanes & running_, [&](std::size_t index) {
      Lane& lane = lanes_[index];
      const std::size_t n = at(row.particle, index);
      lane.dynamics.find_resting(static_cast<Eigen::Index>(row.particle), vector_of(state_.x, n),
                                 vector_of(state_.v, n), lane.resting);
    });
  }
}

void Stack::add_pulls(const Particles& where) {
  const Forces forces = forces_of(force_);
  for_running([&](const Lane& lane, std::size_t index) {
    for (const physics::PullConstants<float>& pull : lane.dynamics.pulls()) {
      const std::size_t n = at(static_cast<std::size_t>(pull.particle), index);
      put(forces, n,
          vector_at(forces, n) +
              physics::pull_force<float>(pull, vector_of(where.x, n), vector_of(where.v, n)));
    }
  });
}

/// What terrain adds to the forces.
void Stack::add_contact(const Particles& where) {
  const Forces forces = forces_of(force_);
  if (lanes_.front().model->contact.model == ContactModel::course) {
    for (const NearRow& row : near_) {
      for_bits(row.lanes & running_, [&](std::size_t index) {
        const std::size_t n = at(row.particle, index);
        if (inverse_mass_[n] == 0.0f) return;
        put(forces, n,
            lanes_[index].dynamics.with_contact(vector_of(where.x, n), vector_of(where.v, n),
                                                vector_at(forces, n)));
      });
    }
    return;
  }
  for_running([&](const Lane& lane, std::size_t index) {
    for (const physics::RestingContact<float>& rests : lane.resting) {
      const std::size_t n = at(static_cast<std::size_t>(rests.particle), index);
      put(forces, n, physics::with_reaction<float>(rests, vector_at(forces, n)));
    }
  });
}

/// Terrain response at the end of the step. Returns whether all that it moved are finite and slow enough.
bool Stack::respond() {
  bool sound = true;
  for (const NearRow& row : near_) {
    for_bits(row.lanes & running_, [&](std::size_t index) {
      const std::size_t n = at(row.particle, index);
      Vector x = vector_of(next_.x, n), v = vector_of(next_.v, n);
      lanes_[index].dynamics.respond(static_cast<Eigen::Index>(row.particle), vector_of(state_.x, n),
                                     vector_of(state_.v, n), x, v);
      parallel::set(next_.x, n, x);
      parallel::set(next_.v, n, v);
      sound = sound && x.allFinite() && physics::dot3<float>(v, v) <= speed_limit;
    });
  }
  return sound;
}

/// The step's end: who diverged in it stays where the step began.
void Stack::settle(bool sound) {
  std::uint32_t failed = 0;
  for_running([&](Lane& lane, std::size_t index) {
    if (!sound) {
      lane.divergence = physics::find_divergence<float>(
          *lane.model,
          [&](Eigen::Index i) { return vector_of(next_.x, at(static_cast<std::size_t>(i), index)); },
          [&](Eigen::Index i) { return vector_of(next_.v, at(static_cast<std::size_t>(i), index)); }, {},
          lane.step + 1);
    }
    if (!lane.divergence) {
      ++lane.step;
      return;
    }
    failed |= 1u << index;
    lane.kept.resize(6 * particles_);
    copy_vectors(column<const float>(std::as_const(state_).x, index, particles_),
                 Strided<float>{lane.kept.data(), particles_});
    copy_vectors(column<const float>(std::as_const(state_).v, index, particles_),
                 Strided<float>{lane.kept.data() + 3 * particles_, particles_});
  });
  std::swap(state_, next_);
  for_bits(failed, [&](std::size_t index) { still(index); });
}

}  // namespace aspic::parallel

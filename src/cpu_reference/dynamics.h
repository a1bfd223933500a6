#pragma once
// What the forces of a model need in the solver's precision: masses, constants, inputs, and the terrain of
// the step under way, with its response.
#include <atomic>
#include <utility>
#include <vector>

#include "aspic/inputs.h"
#include "model/inputs.h"
#include "model/model.h"
#include "physics/body_force.h"
#include "physics/pulls/law.h"
#include "physics/terrain/coulomb.h"

namespace aspic::reference {

using namespace physics;

template <class T>
class Dynamics {
 public:
  explicit Dynamics(const Model& model)
      : model_(&model),
        body_force_(model),
        contact_(model),
        mass_(model.mass),
        inverse_mass_(model.inverse_mass) {
    for (const Terrain& terrain : model.terrain) grounds_.emplace_back(terrain);
  }

  /// The step from the state of this number begins: moving ground takes its places at both ends of it, rest
  /// lengths follow their signals from then on.
  void begin_step(std::uint64_t step) {
    step_ = step;
    for (Ground<T>& ground : grounds_) ground.begin_step(model_->simulation.timestep, step);
  }

  std::uint64_t step() const { return step_; }
  const Model& model() const { return *model_; }
  T time_step() const { return static_cast<T>(model_->simulation.timestep); }

  /// While `*flag` is true forces are left incomplete, for a step that is canceled; see
  /// Solver::set_stop_flag.
  void set_stop_flag(const std::atomic<bool>* flag) { flag_ = flag; }
  bool interrupted() const { return flag_ && flag_->load(std::memory_order_relaxed); }

  /// Inputs of the model that rounded_inputs() returned hold until others are set; balls feel their pulls
  /// elsewhere (balls.h).
  void set_inputs(const Inputs& inputs) {
    pulls_.clear();
    for (const Pull& pull : inputs.pulls)
      if (!pull.ball) pulls_.emplace_back(pull);
    inverse_mass_ = Runs<T>(inverse_mass_under(*model_, inputs));
    channels_ = inputs.channels;
  }
  const std::vector<double>& channels() const { return channels_; }
  /// Bytes it holds on the heap.
  std::uint64_t bytes() const {
    return mass_.bytes() + inverse_mass_.bytes() + grounds_.capacity() * sizeof(Ground<T>);
  }
  /// Those on particles, in the order in which they are added.
  const std::vector<PullConstants<T>>& pulls() const { return pulls_; }

  /// Terrains in file order.
  const std::vector<Ground<T>>& grounds() const { return grounds_; }
  const ContactConstants<T>& contact() const { return contact_; }
  const BodyForce<T>& body_force() const { return body_force_; }
  T mass(Eigen::Index i) const { return mass_[static_cast<std::size_t>(i)]; }
  T inverse_mass(Eigen::Index i) const { return inverse_mass_[static_cast<std::size_t>(i)]; }
  /// Constants of all spring classes, this share of the step after its start.
  std::vector<SpringConstants<T>> classes_at(double share) const {
    return physics::classes_at<T>(*model_, step_, share, channels_);
  }

  /// w·f [m/s²]
  Field<T> weighed(Field<T> f) const {
    for (Eigen::Index i = 0; i < f.cols(); ++i) f.col(i) *= inverse_mass(i);
    return f;
  }

  /// The Coulomb model: appends every contact of particle i with ground on which it rests at (x0, v0), in
  /// file order. None in the course model.
  void find_resting(Eigen::Index i, const Vector<T>& x0, const Vector<T>& v0,
                    std::vector<RestingContact<T>>& contacts) const {
    if (model_->contact.model == ContactModel::course || inverse_mass(i) == T(0)) return;
    for (const Ground<T>& ground : grounds_) {
      if (!(distance<T>(ground, ground.start, x0) < contact_.distance)) continue;
      const Gap<T> g = gap<T>(ground, ground.start, x0);
      if (!rests<T>(contact_, g.d, dot3<T>(ground.start.relative(v0), g.n))) continue;
      contacts.push_back({i, ground.friction, least_normal_speed<T>(contact_, g.d),
                          contact_.step * inverse_mass(i), g.n, ground.end.relative(v0)});
    }
  }

  /// The course model: the force f [N] on a particle that is not pinned, with every terrain's part.
  Vector<T> with_contact(const Vector<T>& x, const Vector<T>& v, Vector<T> f) const {
    for (const Ground<T>& ground : grounds_) f = with_contact_force<T>(ground, contact_, x, v, f);
    return f;
  }

  /// Terrain response on particle i at the end of a step from (x0, v0) to (x, v); terrains act in file order.
  void respond(Eigen::Index i, const Vector<T>& x0, const Vector<T>& v0, Vector<T>& x, Vector<T>& v) const {
    if (inverse_mass(i) == T(0)) return;
    for (const Ground<T>& ground : grounds_) {
      if (model_->contact.model == ContactModel::coulomb) {
        respond_coulomb<T>(ground, contact_, mass(i), x0, v0, x, v);
      } else {
        respond_course<T>(ground, contact_.distance, mass(i), x, v);
      }
    }
  }

  /// The same on all particles.
  void respond(const Field<T>& x0, const Field<T>& v0, Field<T>& x, Field<T>& v) const {
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      Vector<T> xi = x.col(i), vi = v.col(i);
      respond(i, x0.col(i), v0.col(i), xi, vi);
      x.col(i) = xi;
      v.col(i) = vi;
    }
  }

  /// The course model: adds every terrain's part to the forces.
  void add_contact_force(const Field<T>& x, const Field<T>& v, Field<T>& f) const {
    if (model_->contact.model != ContactModel::course) return;
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      if (inverse_mass(i) != T(0)) f.col(i) = with_contact(x.col(i), v.col(i), f.col(i));
    }
  }

 private:
  const Model* model_;
  const std::atomic<bool>* flag_ = nullptr;
  BodyForce<T> body_force_;
  ContactConstants<T> contact_;
  std::vector<Ground<T>> grounds_;
  std::vector<PullConstants<T>> pulls_;
  Runs<T> mass_, inverse_mass_;
  std::vector<double> channels_;  // of the inputs
  std::uint64_t step_ = 0;
};

// Compiled once, in dynamics.cpp.
extern template class Dynamics<float>;
extern template class Dynamics<double>;

}  // namespace aspic::reference

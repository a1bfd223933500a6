#include "cpu_parallel/lengths.h"

#include "model/model.h"

namespace aspic::parallel {

void MovingLengths::set_model(const Model& model) {
  model_ = &model;
  lengths_.reset();
  bodies_.clear();
  if (model.actuation.empty()) return;
  lengths_.emplace(model);
  std::uint32_t body = 0;
  for (const ActuatedClass& each : model.actuation.classes) {
    while (each.spring_class >= model.bodies[body].first_class + model.bodies[body].class_count) ++body;
    bodies_.push_back(body);
  }
}

void MovingLengths::set(const reference::Dynamics<float>& dynamics, double share) {
  if (!lengths_) return;
  const std::span<const double> lengths = lengths_->at(dynamics.step(), share, dynamics.channels());
  for (std::size_t n = 0; n < lengths.size();) {
    const std::uint32_t body = bodies_[n];
    const auto put = [&](auto& springs) {
      for (; n < lengths.size() && bodies_[n] == body; ++n)
        springs.set_rest_length(model_->actuation.classes[n].spring_class, static_cast<float>(lengths[n]));
    };
    if (auto* const bands = std::get_if<Bands>(&springs_[body])) {
      put(*bands);
      bands->rest_lengths_set();
    } else {
      put(std::get<SpringLists>(springs_[body]));
    }
  }
}

}  // namespace aspic::parallel

#include "assembled.h"

#include <Eigen/IterativeLinearSolvers>

#include "model/springs.h"

namespace aspic::bench {

using physics::Vector;
using reference::Trial;

AssembledSystem::AssembledSystem(const Model& model)
    : model_(model),
      springs_(all_springs(model)),
      dynamics_(model),
      limits_(model.simulation.implicit),
      h_(static_cast<float>(model.simulation.timestep)) {
  const auto rows = 3 * static_cast<Eigen::Index>(model.particle_count());
  std::vector<Eigen::Triplet<float>> entries;
  const auto block = [&](std::uint32_t i, std::uint32_t j) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c)
        entries.emplace_back(static_cast<int>(3 * i) + r, static_cast<int>(3 * j) + c, 1.0f);
    }
  };
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) block(i, i);
  for (const Spring& spring : springs_) {
    block(spring.a, spring.b);
    block(spring.b, spring.a);
  }
  matrix_.resize(rows, rows);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  for (std::size_t i = 0; i < model.particle_count(); ++i) {
    const int* const outer = matrix_.outerIndexPtr() + 3 * i;
    row_size_.push_back(static_cast<std::size_t>(outer[1] - outer[0]));
  }
  for (const Spring& s : springs_)
    places_.push_back({place(s.a, s.a), place(s.a, s.b), place(s.b, s.a), place(s.b, s.b)});
}

std::size_t AssembledSystem::place(std::uint32_t row, std::uint32_t column) const {
  const int* const columns = matrix_.innerIndexPtr();
  const int* const outer = matrix_.outerIndexPtr() + 3 * std::size_t{row};
  const int* const at =
      std::lower_bound(columns + outer[0], columns + outer[1], static_cast<int>(3 * column));
  return static_cast<std::size_t>(at - columns);
}

/// H on the diagonal, −H off it.
void AssembledSystem::add(const Spring& spring, const physics::SpringJacobian<float>& H, std::size_t number) {
  const Eigen::Matrix3f part =
      H.across * Eigen::Matrix3f::Identity() + (H.along - H.across) * (H.n * H.n.transpose());
  const auto& [aa, ab, ba, bb] = places_[number];
  float* const values = matrix_.valuePtr();
  const std::size_t row_a = row_size_[spring.a], row_b = row_size_[spring.b];
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const float value = part(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
      values[aa + r * row_a + c] += value;
      values[ab + r * row_a + c] -= value;
      values[ba + r * row_b + c] -= value;
      values[bb + r * row_b + c] += value;
    }
  }
}

Trial<float> AssembledSystem::evaluate() {
  const Eigen::Index count = trial_.cols();
  Field f(3, count);
  std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0f);
  for (std::uint32_t i = 0; i < count; ++i) {
    f.col(i) = dynamics_.mass(i) * dynamics_.body_force().gravity;
    const std::size_t at = place(i, i);
    for (std::size_t r = 0; r < 3; ++r) matrix_.valuePtr()[at + r * row_size_[i] + r] = dynamics_.mass(i);
  }
  const auto classes = dynamics_.classes_at(1.0);
  for (std::size_t n = 0; n < springs_.size(); ++n) {
    const Spring& spring = springs_[n];
    const Vector<float> v = trial_.col(spring.a) - trial_.col(spring.b);
    const Vector<float> e = (s_->x.col(spring.a) - s_->x.col(spring.b)) + h_ * v;
    const auto [on_a, H] = physics::linearized<float>(classes[spring.spring_class], h_, e, v);
    f.col(spring.a) += on_a;
    f.col(spring.b) -= on_a;
    add(spring, H, n);
  }
  r_.resize(3, count);
  Trial<float> result{0.0f, 0.0f, 0.0f, false};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector<float> change = trial_.col(i) - s_->v.col(i);
    const Vector<float> R = change - h_ * (dynamics_.inverse_mass(i) * f.col(i));
    r_.col(i) = h_ * f.col(i) - dynamics_.mass(i) * change;
    result.residual = std::max(result.residual, physics::largest_component<float>(R));
    result.merit += R.squaredNorm();
    result.falling += (R + h_ * dynamics_.body_force().gravity).squaredNorm();
  }
  return result;
}

Trial<float> AssembledSystem::start() {
  base_ = trial_ = s_->v;
  return evaluate();
}

Trial<float> AssembledSystem::fall() {
  trial_ = s_->v.colwise() + h_ * dynamics_.body_force().gravity;
  return evaluate();
}

Trial<float> AssembledSystem::try_step(float lambda, bool onwards) {
  if (onwards) base_ = trial_;
  trial_ = base_ + lambda * delta_;
  return evaluate();
}

void AssembledSystem::solve(float forcing, std::uint32_t most, std::uint32_t& iterations) {
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> method;
  method.setTolerance(forcing);
  method.setMaxIterations(static_cast<Eigen::Index>(most));
  method.compute(matrix_);
  const Eigen::Map<const Eigen::VectorXf> r(r_.data(), r_.size());
  const Eigen::VectorXf solution = method.solve(r);
  iterations += static_cast<std::uint32_t>(method.iterations());
  delta_ = Eigen::Map<const Field>(solution.data(), 3, r_.cols());
}

physics::Phase<float> AssembledSystem::step(const physics::Phase<float>& s, SolveReport& report) {
  s_ = &s;
  const bool accepted = reference::solve_step(*this, limits_, report);
  const Field& v = accepted ? trial_ : base_;
  return {s.x + h_ * v, v};
}

}  // namespace aspic::bench

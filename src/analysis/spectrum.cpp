#include "analysis/spectrum.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/split_mix.h"

namespace aspic {
namespace {

using Vector = Eigen::VectorXd;

/// A start vector with a share of every mode, the same on every run.
Vector start_vector(std::size_t size) {
  Vector v(static_cast<Eigen::Index>(size));
  SplitMix64 random(0);
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = random.share() - 0.5;
  return v;
}

}  // namespace

LinearisedBody::LinearisedBody(const Model& model, std::uint32_t first_particle,
                               std::uint32_t particle_count) {
  root_inverse_mass_.reserve(particle_count);
  for (std::uint32_t i = 0; i < particle_count; ++i) {
    root_inverse_mass_.push_back(std::sqrt(model.inverse_mass[first_particle + i]));
  }
  const auto begin = std::lower_bound(model.springs.begin(), model.springs.end(), first_particle,
                                      [](const Spring& s, std::uint32_t particle) { return s.a < particle; });
  const auto end = std::lower_bound(begin, model.springs.end(), first_particle + particle_count,
                                    [](const Spring& s, std::uint32_t particle) { return s.a < particle; });
  springs_.reserve(static_cast<std::size_t>(end - begin));
  smallest_ratio_ = std::numeric_limits<double>::infinity();
  for (auto spring = begin; spring != end; ++spring) {
    const SpringClass& c = model.spring_classes[spring->spring_class];
    const Vec3 e = model.initial_position[spring->a] - model.initial_position[spring->b];
    const double l = length(e);
    const bool moves = model.inverse_mass[spring->a] > 0.0 || model.inverse_mass[spring->b] > 0.0;
    if (l == 0.0 || !moves || (c.stiffness == 0.0 && c.damping == 0.0)) continue;
    springs_.push_back(
        {spring->a - first_particle, spring->b - first_particle, e / l, c.stiffness, c.damping});
    const double ratio = c.damping / c.stiffness;
    smallest_ratio_ = std::min(smallest_ratio_, ratio);
    largest_ratio_ = std::max(largest_ratio_, ratio);
  }
  if (springs_.empty()) smallest_ratio_ = 0.0;
}

std::size_t LinearisedBody::free_dof() const {
  return 3 * static_cast<std::size_t>(std::count_if(root_inverse_mass_.begin(), root_inverse_mass_.end(),
                                                    [](double root) { return root > 0.0; }));
}

bool LinearisedBody::proportional() const {
  // The ratios come from products such as 2ζ√(km/2): a few roundings apart is the same.
  return largest_ratio_ == smallest_ratio_ || largest_ratio_ <= smallest_ratio_ * (1.0 + 1e-12);
}

LargestEigenvalue LinearisedBody::largest_eigenvalue(double stiffness_factor, double damping_factor,
                                                     double tolerance, int max_iterations) const {
  if (springs_.empty()) return {};
  const auto apply = [&](const Vector& in, Vector& out) {
    out.setZero();
    for (const LinearSpring& s : springs_) {
      const double wa = root_inverse_mass_[s.a], wb = root_inverse_mass_[s.b];
      const Eigen::Index a = 3 * static_cast<Eigen::Index>(s.a), b = 3 * static_cast<Eigen::Index>(s.b);
      const Vec3& n = s.direction;
      const double along_a = n.x * in[a] + n.y * in[a + 1] + n.z * in[a + 2];
      const double along_b = n.x * in[b] + n.y * in[b + 1] + n.z * in[b + 2];
      const double force =
          (stiffness_factor * s.stiffness + damping_factor * s.damping) * (wa * along_a - wb * along_b);
      const double fa = wa * force, fb = wb * force;
      out[a] += fa * n.x;
      out[a + 1] += fa * n.y;
      out[a + 2] += fa * n.z;
      out[b] -= fb * n.x;
      out[b + 1] -= fb * n.y;
      out[b + 2] -= fb * n.z;
    }
  };

  const std::size_t size = 3 * root_inverse_mass_.size();
  Vector current = start_vector(size), previous = Vector::Zero(current.size()), image(current.size());
  current.normalize();
  std::vector<double> diagonal, off_diagonal;
  double beta = 0.0;
  LargestEigenvalue best{0.0, false};
  const int limit =
      std::min<int>(max_iterations, static_cast<int>(std::min<std::size_t>(size, 1u << 20)) + 1);
  for (int iteration = 1; iteration <= limit; ++iteration) {
    apply(current, image);
    const double alpha = current.dot(image);
    image -= alpha * current + beta * previous;
    diagonal.push_back(alpha);
    const double next_beta = image.norm();
    const bool exhausted = next_beta <= 1e-14 * (std::abs(alpha) + beta);
    if (iteration % 5 == 0 || exhausted || iteration == limit) {
      const auto n = static_cast<Eigen::Index>(diagonal.size());
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> tridiagonal;
      tridiagonal.computeFromTridiagonal(Eigen::Map<Vector>(diagonal.data(), n),
                                         Eigen::Map<Vector>(off_diagonal.data(), n - 1));
      best.value = std::max(0.0, tridiagonal.eigenvalues()[n - 1]);
      const double residual = next_beta * std::abs(tridiagonal.eigenvectors()(n - 1, n - 1));
      best.converged = exhausted || residual <= tolerance * best.value;
      if (best.converged) break;
    }
    off_diagonal.push_back(next_beta);
    previous.swap(current);
    current = image / next_beta;
    beta = next_beta;
  }
  return best;
}

std::vector<std::complex<double>> LinearisedBody::eigenvalues() const {
  std::vector<Eigen::Index> row(root_inverse_mass_.size(), -1);
  Eigen::Index free = 0;
  for (std::size_t i = 0; i < root_inverse_mass_.size(); ++i) {
    if (root_inverse_mass_[i] > 0.0) {
      row[i] = free;
      free += 3;
    }
  }
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(2 * free, 2 * free);
  // (x, v/σ) with σ² about κ_max balances the blocks: without it rounding in K would swamp the eigenvalues.
  double sigma = 0.0;
  for (const LinearSpring& s : springs_) {
    sigma = std::max({sigma, root_inverse_mass_[s.a] * std::sqrt(s.stiffness),
                      root_inverse_mass_[s.b] * std::sqrt(s.stiffness)});
  }
  if (sigma == 0.0) sigma = 1.0;
  companion.topRightCorner(free, free).diagonal().setConstant(sigma);
  for (const LinearSpring& s : springs_) {
    const Eigen::Vector3d n(s.direction.x, s.direction.y, s.direction.z);
    const Eigen::Matrix3d outer = n * n.transpose();
    const auto add = [&](std::uint32_t i, std::uint32_t j, double sign) {
      if (row[i] < 0 || row[j] < 0) return;
      const double w = sign * root_inverse_mass_[i] * root_inverse_mass_[j];
      companion.block<3, 3>(free + row[i], row[j]) -= w * s.stiffness / sigma * outer;
      companion.block<3, 3>(free + row[i], free + row[j]) -= w * s.damping * outer;
    };
    add(s.a, s.a, 1.0);
    add(s.b, s.b, 1.0);
    add(s.a, s.b, -1.0);
    add(s.b, s.a, -1.0);
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(companion, false);
  const auto& values = solver.eigenvalues();
  return {values.data(), values.data() + values.size()};
}

}  // namespace aspic

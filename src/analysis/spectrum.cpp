#include "analysis/spectrum.h"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/dense.h"
#include "base/split_mix.h"
#include "model/springs.h"

namespace aspic {
namespace {

using DynamicVector = Eigen::VectorXd;

/// A start vector with a share of every mode, the same on every run.
DynamicVector start_vector(std::size_t size) {
  DynamicVector v(static_cast<Eigen::Index>(size));
  SplitMix64 random(0);
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = random.share() - 0.5;
  return v;
}

/// The largest eigenvalue θ of the symmetric tridiagonal matrix of a Lanczos iteration, and the last
/// component of its unit vector, from eigenvalues alone: s² = Π (θ − μ_j)/(θ − θ_j) with the eigenvalues μ of
/// the matrix without its last row (Golub and Van Loan, §8.5, and the interlacing theorem, which keeps every
/// factor from 0 to 1).
struct TopOfTridiagonal {
  double value, last_component;
};
Eigen::VectorXd tridiagonal_eigenvalues(std::vector<double>& diagonal, std::vector<double>& off_diagonal,
                                        Eigen::Index n) {
  if (n == 0) return {};
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(Eigen::Map<DynamicVector>(diagonal.data(), n),
                                Eigen::Map<DynamicVector>(off_diagonal.data(), n - 1),
                                Eigen::EigenvaluesOnly);
  return solver.eigenvalues();
}
TopOfTridiagonal top_of(std::vector<double>& diagonal, std::vector<double>& off_diagonal) {
  const auto n = static_cast<Eigen::Index>(diagonal.size());
  const DynamicVector all = tridiagonal_eigenvalues(diagonal, off_diagonal, n),
                      inner = tridiagonal_eigenvalues(diagonal, off_diagonal, n - 1);
  const double top = all[n - 1];
  double squared = 1.0;
  for (Eigen::Index j = 0; j + 1 < n; ++j) {
    // Equal eigenvalues are copies that a converged iteration makes by rounding.
    const double below = top - all[j];
    squared *= below > 0.0 ? std::clamp((top - inner[j]) / below, 0.0, 1.0) : 0.0;
  }
  return {top, std::sqrt(squared)};
}

}  // namespace

bool WorkBudget::spend(std::uint64_t evaluations) {
  constexpr std::uint64_t between_looks = 1000000;
  left_ -= std::min(left_, evaluations);
  since_look_ += evaluations;
  if (watch_ && left_ > 0 && since_look_ >= between_looks) {
    since_look_ = 0;
    if (!watch_(1.0 - static_cast<double>(left_) / static_cast<double>(all_))) left_ = 0;
  }
  return left_ > 0;
}

LinearizedBody::LinearizedBody(const Model& model, std::uint32_t first_particle, std::uint32_t particle_count,
                               bool springs) {
  root_inverse_mass_.reserve(particle_count);
  for (std::uint32_t i = 0; i < particle_count; ++i) {
    root_inverse_mass_.push_back(std::sqrt(model.inverse_mass[first_particle + i]));
  }
  const std::vector<Vec3> position = model.initial_position.list(first_particle, particle_count);
  std::vector<double> stiffness_disc(particle_count, 0.0), damping_disc(particle_count, 0.0);
  smallest_ratio_ = std::numeric_limits<double>::infinity();
  const std::vector<LengthRange> ranges = rest_length_ranges(model);
  for (const Spring& spring : springs_of(model, first_particle, particle_count)) {
    const SpringClass& c = model.spring_classes[spring.spring_class];
    const std::uint32_t a = spring.a - first_particle, b = spring.b - first_particle;
    const Vec3 e = position[a] - position[b];
    const double l = length(e);
    const bool moves = root_inverse_mass_[a] > 0.0 || root_inverse_mass_[b] > 0.0;
    if (l == 0.0 || !moves || (c.stiffness == 0.0 && c.damping == 0.0)) continue;
    if (springs) springs_.push_back({a, b, e / l, c.stiffness, c.damping});
    ++spring_count_;
    for (const auto& [own, other] : {std::pair(a, b), std::pair(b, a)}) {
      const double share = root_inverse_mass_[own] * (root_inverse_mass_[own] + root_inverse_mass_[other]);
      stiffness_disc[own] += c.stiffness * share;
      damping_disc[own] += c.damping * share;
    }
    if (c.rest_length > 0.0)
      shortening_ = std::max(shortening_, 1.0 - ranges[spring.spring_class].least / c.rest_length);
    const double ratio = c.damping / c.stiffness;
    smallest_ratio_ = std::min(smallest_ratio_, ratio);
    largest_ratio_ = std::max(largest_ratio_, ratio);
  }
  if (spring_count_ == 0) smallest_ratio_ = 0.0;
  for (std::uint32_t i = 0; i < particle_count; ++i) {
    // Unlike std::max this keeps a NaN.
    if (!(stiffness_disc[i] <= stiffness_bound_)) stiffness_bound_ = stiffness_disc[i];
    if (!(damping_disc[i] <= damping_bound_)) damping_bound_ = damping_disc[i];
  }
}

void LinearizedBody::join(const LinearizedBody& other) {
  if (other.spring_count_ == 0) return;
  smallest_ratio_ =
      spring_count_ == 0 ? other.smallest_ratio_ : std::min(smallest_ratio_, other.smallest_ratio_);
  largest_ratio_ = std::max(largest_ratio_, other.largest_ratio_);
  spring_count_ += other.spring_count_;
  shortening_ = std::max(shortening_, other.shortening_);
  if (!(other.stiffness_bound_ <= stiffness_bound_)) stiffness_bound_ = other.stiffness_bound_;
  if (!(other.damping_bound_ <= damping_bound_)) damping_bound_ = other.damping_bound_;
}

std::size_t LinearizedBody::free_dof() const {
  return 3 * static_cast<std::size_t>(std::count_if(root_inverse_mass_.begin(), root_inverse_mass_.end(),
                                                    [](double root) { return root > 0.0; }));
}

bool LinearizedBody::proportional() const {
  // The ratios come from products such as 2ζ√(km/2): a few roundings apart is the same.
  return largest_ratio_ == smallest_ratio_ || largest_ratio_ <= smallest_ratio_ * (1.0 + 1e-12);
}

void LinearizedBody::multiply(double stiffness_factor, double damping_factor, const double* in,
                              double* out) const {
  std::fill_n(out, 3 * root_inverse_mass_.size(), 0.0);
  for (const LinearSpring& s : springs_) {
    const double wa = root_inverse_mass_[s.a], wb = root_inverse_mass_[s.b];
    const std::size_t a = 3 * std::size_t{s.a}, b = 3 * std::size_t{s.b};
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
}

std::vector<Vec3> LinearizedBody::stiffest_mode(double stiffness_factor, double damping_factor,
                                                int rounds) const {
  const std::size_t particles = root_inverse_mass_.size();
  DynamicVector mode = start_vector(3 * particles), image(mode.size());
  for (int round = 0; round < rounds; ++round) {
    multiply(stiffness_factor, damping_factor, mode.data(), image.data());
    const double size = image.norm();
    if (!(size > 0.0)) return std::vector<Vec3>(particles);
    mode = image / size;
  }
  std::vector<Vec3> displacement(particles);
  double largest = 0.0;
  for (std::size_t i = 0; i < particles; ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    displacement[i] = root_inverse_mass_[i] * Vec3{mode[at], mode[at + 1], mode[at + 2]};
    largest = std::max(largest, length(displacement[i]));
  }
  for (Vec3& d : displacement) d = d / largest;
  return displacement;
}

LargestEigenvalue LinearizedBody::largest_eigenvalue(double stiffness_factor, double damping_factor,
                                                     double tolerance, int max_iterations,
                                                     WorkBudget& work) const {
  if (spring_count_ == 0) return {};
  const double bound = eigenvalue_bound(stiffness_factor, damping_factor);
  const std::uint64_t work_of_iteration = springs_.size() + root_inverse_mass_.size();
  // Fewer iterations than these say little.
  constexpr std::uint64_t least_iterations = 20;
  if (springs_.empty() || !std::isfinite(bound) || work.left() < least_iterations * work_of_iteration)
    return {bound, false};
  const std::size_t size = 3 * root_inverse_mass_.size();
  DynamicVector current = start_vector(size), previous = DynamicVector::Zero(current.size()),
                image(current.size());
  current.normalize();
  std::vector<double> diagonal, off_diagonal;
  double beta = 0.0;
  LargestEigenvalue best{bound, false};
  const int limit =
      std::min<int>(max_iterations, static_cast<int>(std::min<std::size_t>(size, 1u << 20)) + 1);
  int next_look = 5;
  for (int iteration = 1; iteration <= limit; ++iteration) {
    multiply(stiffness_factor, damping_factor, current.data(), image.data());
    const double alpha = current.dot(image);
    image -= alpha * current + beta * previous;
    diagonal.push_back(alpha);
    const double next_beta = image.norm();
    const bool exhausted = next_beta <= 1e-14 * (std::abs(alpha) + beta);
    const bool last = !work.spend(work_of_iteration) || iteration == limit;
    if (iteration >= next_look || exhausted || last) {
      next_look = iteration + std::max(5, iteration / 10);
      const TopOfTridiagonal top = top_of(diagonal, off_diagonal);
      const double residual = exhausted ? 0.0 : next_beta * top.last_component;
      best.converged = exhausted || residual <= tolerance * top.value;
      best.value =
          best.converged ? std::max(0.0, top.value) : std::min(bound, std::max(0.0, top.value) + residual);
      if (best.converged || last) break;
    }
    off_diagonal.push_back(next_beta);
    previous.swap(current);
    current = image / next_beta;
    beta = next_beta;
  }
  return best;
}

std::vector<std::complex<double>> LinearizedBody::eigenvalues() const {
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
  return aspic::eigenvalues(companion);
}

}  // namespace aspic

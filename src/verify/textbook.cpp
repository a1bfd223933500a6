#include "verify/textbook.h"

#include <Eigen/LU>
#include <cmath>

#include "model/springs.h"

namespace aspic::verify {
namespace {

template <class T>
using Column = Eigen::Matrix<T, Eigen::Dynamic, 1>;

Eigen::Index at(std::uint32_t particle) {
  return 3 * static_cast<Eigen::Index>(particle);
}

}  // namespace

template <class T>
Motion<T> motion_of(const State& state) {
  const auto n = static_cast<Eigen::Index>(3 * state.position.size());
  Motion<T> motion{Column<T>(n), Column<T>(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto particle = static_cast<std::size_t>(i / 3);
    motion.x[i] = static_cast<T>(state.position[particle][static_cast<int>(i % 3)]);
    motion.v[i] = static_cast<T>(state.velocity[particle][static_cast<int>(i % 3)]);
  }
  return motion;
}

template <class T>
Column<T> force(const Model& model, const Motion<T>& motion, T rest) {
  Column<T> f = Column<T>::Zero(motion.x.size());
  for (std::uint32_t i = 0; i < model.particle_count(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      f[at(i) + axis] = static_cast<T>(model.mass[i]) * static_cast<T>(model.simulation.gravity[axis]);
    }
  }
  for (const Spring& spring : springs_of(model)) {
    const SpringClass& constants = model.spring_classes[spring.spring_class];
    const Eigen::Matrix<T, 3, 1> stretch =
        motion.x.template segment<3>(at(spring.a)) - motion.x.template segment<3>(at(spring.b));
    const Eigen::Matrix<T, 3, 1> rate =
        motion.v.template segment<3>(at(spring.a)) - motion.v.template segment<3>(at(spring.b));
    const T now = stretch.norm();
    if (now == T(0)) continue;
    const Eigen::Matrix<T, 3, 1> along = stretch / now;
    const T tension =
        static_cast<T>(constants.stiffness) * (now - rest * static_cast<T>(constants.rest_length)) +
        static_cast<T>(constants.damping) * rate.dot(along);
    f.template segment<3>(at(spring.a)) -= tension * along;
    f.template segment<3>(at(spring.b)) += tension * along;
  }
  return f;
}

template Motion<double> motion_of<double>(const State&);
template Motion<long double> motion_of<long double>(const State&);
template Column<double> force<double>(const Model&, const Motion<double>&, double);
template Column<long double> force<long double>(const Model&, const Motion<long double>&, long double);

double elastic_energy(const Model& model, const State& state, std::int64_t particle) {
  long double sum = 0;
  for (const Spring& spring : springs_of(model)) {
    if (particle >= 0 && spring.a != particle && spring.b != particle) continue;
    const SpringClass& constants = model.spring_classes[spring.spring_class];
    const Vec3 e = state.position[spring.a] - state.position[spring.b];
    const long double now =
        std::sqrt(static_cast<long double>(e.x) * e.x + static_cast<long double>(e.y) * e.y +
                  static_cast<long double>(e.z) * e.z);
    const long double longer = now - constants.rest_length;
    sum += constants.stiffness * longer * longer / 2;
  }
  return static_cast<double>(sum);
}

Motion<long double> exact_motion(const Model& model, const State& start, double duration, int steps,
                                 const std::function<long double(long double)>& stretch) {
  using Real = long double;
  const auto slope = [&](const Motion<Real>& now, Real time) {
    Motion<Real> rate{now.v, force(model, now, stretch ? stretch(time) : Real(1))};
    for (Eigen::Index i = 0; i < rate.v.size(); ++i) {
      rate.v[i] *= static_cast<Real>(model.inverse_mass[static_cast<std::size_t>(i / 3)]);
    }
    return rate;
  };
  const auto moved = [](const Motion<Real>& from, Real h, const Motion<Real>& rate) {
    return Motion<Real>{from.x + h * rate.x, from.v + h * rate.v};
  };
  const Real h = static_cast<Real>(duration) / steps;
  Motion<Real> now = motion_of<Real>(start);
  for (int n = 0; n < steps; ++n) {
    const Real t = n * h;
    const auto k1 = slope(now, t), k2 = slope(moved(now, h / 2, k1), t + h / 2),
               k3 = slope(moved(now, h / 2, k2), t + h / 2), k4 = slope(moved(now, h, k3), t + h);
    now.x += h / 6 * (k1.x + 2 * k2.x + 2 * k3.x + k4.x);
    now.v += h / 6 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v);
  }
  return now;
}

Eigen::VectorXd dense_backward_euler(const Model& model, const State& start) {
  const double h = model.simulation.timestep;
  const Motion<double> from = motion_of<double>(start);
  const Eigen::Index n = from.x.size();
  Eigen::VectorXd mass(n);
  for (Eigen::Index i = 0; i < n; ++i) mass[i] = model.mass[static_cast<std::size_t>(i / 3)];
  const auto defect = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
    return mass.cwiseProduct(v - from.v) - h * force(model, Motion<double>{from.x + h * v, v});
  };
  Eigen::VectorXd v = from.v, F = defect(v);
  for (int iteration = 0; iteration < 100 && F.lpNorm<Eigen::Infinity>() > 1e-13; ++iteration) {
    Eigen::MatrixXd J = mass.asDiagonal();
    for (const Spring& spring : springs_of(model)) {
      const SpringClass& s = model.spring_classes[spring.spring_class];
      const Eigen::Vector3d rate = v.segment<3>(at(spring.a)) - v.segment<3>(at(spring.b));
      const Eigen::Vector3d e = from.x.segment<3>(at(spring.a)) - from.x.segment<3>(at(spring.b)) + h * rate;
      const double now = e.norm();
      if (now == 0.0) continue;
      const Eigen::Vector3d u = e / now;
      const Eigen::Matrix3d across = (Eigen::Matrix3d::Identity() - u * u.transpose()) / now;
      const double tension = s.stiffness * (now - s.rest_length) + s.damping * rate.dot(u);
      // d(tension·u)/dv': tension's own change along u, and u turning; u turns the damping's direction as
      // well.
      const Eigen::Vector3d tension_change =
          (h * s.stiffness + s.damping) * u + h * s.damping * across * rate;
      const Eigen::Matrix3d block = h * (u * tension_change.transpose() + h * tension * across);
      J.block<3, 3>(at(spring.a), at(spring.a)) += block;
      J.block<3, 3>(at(spring.b), at(spring.b)) += block;
      J.block<3, 3>(at(spring.a), at(spring.b)) -= block;
      J.block<3, 3>(at(spring.b), at(spring.a)) -= block;
    }
    const Eigen::VectorXd change = J.partialPivLu().solve(F);
    double share = 1.0;
    Eigen::VectorXd next = v - change, F_next = defect(next);
    while (F_next.norm() > F.norm() && share > 1e-6) {
      share /= 2;
      next = v - share * change;
      F_next = defect(next);
    }
    if (!(F_next.norm() < F.norm())) break;  // rounding is all that is left
    v = next;
    F = F_next;
  }
  return v;
}

WorstMode power_iteration(const Model& model, int iterations) {
  const auto n = 3 * static_cast<Eigen::Index>(model.particle_count());
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) shape[i] = std::sin(1.0 + 1.7 * static_cast<double>(i * i));
  shape.normalize();
  WorstMode worst;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    Eigen::VectorXd image = Eigen::VectorXd::Zero(n);
    for (const Spring& spring : springs_of(model)) {
      const Vec3 e = model.initial_position[spring.a] - model.initial_position[spring.b];
      const Eigen::Vector3d u = Eigen::Vector3d(e.x, e.y, e.z).normalized();
      const double wa = std::sqrt(model.inverse_mass[spring.a]), wb = std::sqrt(model.inverse_mass[spring.b]);
      const double pull =
          model.spring_classes[spring.spring_class].stiffness *
          (wa * u.dot(shape.segment<3>(at(spring.a))) - wb * u.dot(shape.segment<3>(at(spring.b))));
      image.segment<3>(at(spring.a)) += wa * pull * u;
      image.segment<3>(at(spring.b)) -= wb * pull * u;
    }
    worst.kappa = shape.dot(image);
    shape = image.normalized();
  }
  worst.shape = shape;
  return worst;
}

}  // namespace aspic::verify

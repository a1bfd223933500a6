#include "cpu_reference/terms.h"

#include "model/springs.h"

namespace aspic::reference {
namespace {

/// −0 + a is a to every bit, for a = −0 as well.
template <class T>
Field<T> nothing(Eigen::Index count) {
  return Field<T>::Constant(3, count, T(-0.0));
}

/// Gravity and resistance, with the mass of A.
template <class T>
class BodyForceTerm final : public Term<T> {
 public:
  using Term<T>::Term;

  void add_force(const Field<T>&, const Field<T>& v, double, Field<T>& f) const override {
    for (Eigen::Index i = 0; i < f.cols(); ++i) f.col(i) += force_.at(dynamics_.mass(i), v.col(i));
  }
  void linearize(const Field<T>& x, const Field<T>& v, Field<T>& f,
                 typename Term<T>::Blocks& blocks) override {
    add_force(x, v, 1.0, f);
    mass_.resize(f.cols());
    for (Eigen::Index i = 0; i < f.cols(); ++i) {
      mass_[i] = force_.implicit_mass(dynamics_.mass(i), v.col(i), dynamics_.time_step());
      blocks[static_cast<std::size_t>(i)].add(DiagonalBlock<T>(mass_[i]));
    }
  }
  void multiply(const Field<T>& p, Field<T>& product) const override {
    for (Eigen::Index i = 0; i < p.cols(); ++i) product.col(i) += mass_[i] * p.col(i);
  }

 private:
  using Term<T>::dynamics_;
  const BodyForce<T>& force_ = dynamics_.body_force();
  Eigen::Array<T, Eigen::Dynamic, 1> mass_;
};

/// Springs are sorted by (a, b), so each particle's sum runs over its springs in ascending neighbor index.
template <class T>
class SpringTerm final : public Term<T> {
 public:
  using Term<T>::Term;

  void add_force(const Field<T>& x, const Field<T>& v, double share, Field<T>& f) const override {
    const std::vector<SpringConstants<T>> classes = dynamics_.classes_at(share);
    for (const Spring& spring : springs_of(dynamics_.model())) {
      const auto& [a, b, of] = spring;
      const Vector<T> on_a = spring_force<T>(classes[of], x.col(a) - x.col(b), v.col(a) - v.col(b));
      f.col(a) += on_a;
      f.col(b) -= on_a;
    }
  }
  void linearize(const Field<T>& x, const Field<T>& v, Field<T>& f,
                 typename Term<T>::Blocks& blocks) override {
    const T h = dynamics_.time_step();
    const std::vector<SpringConstants<T>> classes = dynamics_.classes_at(1.0);
    jacobians_.clear();
    jacobians_.reserve(spring_count(dynamics_.model()));
    for (const Spring& spring : springs_of(dynamics_.model())) {
      const auto& [a, b, of] = spring;
      // Not from a rounded x': the difference of the positions is exact where they are close.
      const Vector<T> relative = v.col(a) - v.col(b);
      const auto [on_a, H] = linearized<T>(classes[of], h, (x.col(a) - x.col(b)) + h * relative, relative);
      f.col(a) += on_a;
      f.col(b) -= on_a;
      blocks[a].add(H);
      blocks[b].add(H);
      jacobians_.push_back(H);
    }
  }
  void multiply(const Field<T>& p, Field<T>& product) const override {
    std::size_t n = 0;
    for (const Spring& spring : springs_of(dynamics_.model())) {
      const Vector<T> on_a = jacobians_[n++] * Vector<T>(p.col(spring.a) - p.col(spring.b));
      product.col(spring.a) += on_a;
      product.col(spring.b) -= on_a;
    }
  }

 private:
  using Term<T>::dynamics_;
  std::vector<SpringJacobian<T>> jacobians_;
};

/// Springs whose other end is the anchor, which does not move.
template <class T>
class PullTerm final : public Term<T> {
 public:
  using Term<T>::Term;

  void add_force(const Field<T>& x, const Field<T>& v, double, Field<T>& f) const override {
    for (const PullConstants<T>& pull : dynamics_.pulls())
      f.col(pull.particle) += pull_force<T>(pull, x.col(pull.particle), v.col(pull.particle));
  }
  void linearize(const Field<T>& x, const Field<T>& v, Field<T>& f,
                 typename Term<T>::Blocks& blocks) override {
    jacobians_.clear();
    for (const PullConstants<T>& pull : dynamics_.pulls()) {
      const Eigen::Index i = pull.particle;
      const auto [on_particle, H] = linearized<T>(pull, dynamics_.time_step(), x.col(i), v.col(i));
      f.col(i) += on_particle;
      blocks[static_cast<std::size_t>(i)].add(H);
      jacobians_.push_back(H);
    }
  }
  void multiply(const Field<T>& p, Field<T>& product) const override {
    for (std::size_t n = 0; n < jacobians_.size(); ++n) {
      const Eigen::Index i = dynamics_.pulls()[n].particle;
      product.col(i) += jacobians_[n] * Vector<T>(p.col(i));
    }
  }

 private:
  using Term<T>::dynamics_;
  std::vector<SpringJacobian<T>> jacobians_;
};

}  // namespace

template <class T>
Terms<T>::Terms(const Dynamics<T>& dynamics) : dynamics_(dynamics) {
  terms_.push_back(std::make_unique<BodyForceTerm<T>>(dynamics));
  terms_.push_back(std::make_unique<SpringTerm<T>>(dynamics));
  terms_.push_back(std::make_unique<PullTerm<T>>(dynamics));
}

template <class T>
Field<T> Terms<T>::force(const Field<T>& x, const Field<T>& v, double share) const {
  Field<T> f = nothing<T>(x.cols());
  for (const auto& term : terms_)
    if (!dynamics_.interrupted()) term->add_force(x, v, share, f);
  return f;
}

template <class T>
std::pair<Field<T>, typename Terms<T>::Blocks> Terms<T>::linearize(const Field<T>& x, const Field<T>& v) {
  Field<T> f = nothing<T>(x.cols());
  Blocks blocks(static_cast<std::size_t>(x.cols()), DiagonalBlock<T>(T(0)));
  for (const auto& term : terms_) term->linearize(x, v, f, blocks);
  return {std::move(f), std::move(blocks)};
}

template <class T>
Field<T> Terms<T>::product(const Field<T>& p) const {
  Field<T> product = nothing<T>(p.cols());
  for (const auto& term : terms_) term->multiply(p, product);
  return product;
}

template class Terms<float>;
template class Terms<double>;

}  // namespace aspic::reference

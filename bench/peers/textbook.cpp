// Mass points and springs as a textbook writes them: a list of springs, a vector for each point, one thread,
// explicit Euler, single precision.
#include <Eigen/Dense>

#include "peer.h"

namespace {

using Eigen::Vector3f;

struct Spring {
  int a, b;
  float rest_length;
};

class Textbook {
 public:
  explicit Textbook(const peer::Lattice& lattice)
      : k_(static_cast<float>(lattice.stiffness)),
        c_(static_cast<float>(lattice.damping)),
        m_(static_cast<float>(lattice.mass)),
        h_(static_cast<float>(lattice.timestep)),
        gravity_(0.0f, -static_cast<float>(lattice.gravity), 0.0f) {
    lattice.for_each_particle(lattice.stretch, [&](double x, double y, double z) {
      start_.emplace_back(Eigen::Vector3d(x, y, z).cast<float>());
    });
    lattice.for_each_spring([&](int a, int b, double length) {
      springs_.push_back({a, b, static_cast<float>(length)});
    });
    f_.resize(start_.size());
    load();
  }

  peer::Json hello() const {
    return {{"name", "textbook"},
            {"version", "Eigen " + std::to_string(EIGEN_WORLD_VERSION) + "." +
                            std::to_string(EIGEN_MAJOR_VERSION) + "." + std::to_string(EIGEN_MINOR_VERSION)},
            {"threads", 1},
            {"integrator", "explicit-euler"},
            {"damping", c_},
            {"deviation", 0.0}};
  }
  std::size_t springs() const { return springs_.size(); }

  void load() {
    x_ = start_;
    v_.assign(x_.size(), Vector3f::Zero());
  }

  void advance(long steps) {
    for (long n = 0; n < steps; ++n) step();
  }

  std::vector<double> positions() const {
    std::vector<double> result;
    for (const Vector3f& x : x_) result.insert(result.end(), {x.x(), x.y(), x.z()});
    return result;
  }

 private:
  void step() {
    for (Vector3f& f : f_) f = m_ * gravity_;
    for (const Spring& spring : springs_) {
      const auto a = static_cast<std::size_t>(spring.a), b = static_cast<std::size_t>(spring.b);
      const Vector3f e = x_[a] - x_[b];
      const float L = e.norm();
      const Vector3f n = e / L;
      const Vector3f force = -(k_ * (L - spring.rest_length) + c_ * (v_[a] - v_[b]).dot(n)) * n;
      f_[a] += force;
      f_[b] -= force;
    }
    for (std::size_t i = 0; i < x_.size(); ++i) {
      x_[i] += h_ * v_[i];
      v_[i] += h_ / m_ * f_[i];
    }
  }

  float k_, c_, m_, h_;
  Vector3f gravity_;
  std::vector<Vector3f> start_, x_, v_, f_;
  std::vector<Spring> springs_;
};

}  // namespace

int main(int argc, char** argv) {
  return peer::converse(argc, argv, [](const peer::Lattice& lattice) { return Textbook(lattice); });
}

#pragma once
// The cube that all peers written in C++ simulate. C++17 and the standard library alone, so that any compiler
// takes it.
#include <cmath>
#include <cstdlib>
#include <vector>

namespace peer {

/// The cube: as docs/physics.md, section 2, numbers it.
struct Lattice {
  int n = 10;              ///< particles per edge, ≥ 3
  double edge = 4.0;       ///< [m]
  double height = 9.0;     ///< of the center [m]
  double mass = 1.0;       ///< of a particle [kg]
  double stiffness = 0.0;  ///< of every spring [N/m]
  double damping = 0.0;    ///< [N·s/m]
  double timestep = 0.0;   ///< [s]
  double gravity = 0.0;    ///< downward [m/s²]
  double stretch = 1.0;    ///< of the start along y; rest lengths are those without

  int count() const { return n * n * n; }
  double spacing() const { return edge / (n - 1); }

  /// start(x, y, z) for every particle in order.
  template <class Take>
  void for_each_particle(double factor, const Take& take) const {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k)
          take(-edge / 2 + i * spacing(), height + factor * (-edge / 2 + j * spacing()),
               -edge / 2 + k * spacing());
  }

  /// take(a, b, rest length) for every spring, a < b, in ascending a.
  template <class Take>
  void for_each_spring(const Take& take) const {
    struct Offset {
      int i, j, k;
    };
    std::vector<Offset> offsets;
    for (int i = 0; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j)
        for (int k = -2; k <= 2; ++k) {
          const int squares = i * i + j * j + k * k;
          const bool near = squares <= 3, straight = squares == 4 && std::abs(i + j + k) == 2 &&
                                                     (i == 0) + (j == 0) + (k == 0) == 2;
          const bool ahead = i > 0 || (i == 0 && (j > 0 || (j == 0 && k > 0)));
          if (ahead && (near || straight)) offsets.push_back({i, j, k});
        }
    const auto inside = [&](int at) { return at >= 0 && at < n; };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k)
          for (const Offset& o : offsets) {
            if (!inside(i + o.i) || !inside(j + o.j) || !inside(k + o.k)) continue;
            take((i * n + j) * n + k, ((i + o.i) * n + j + o.j) * n + k + o.k,
                 spacing() * std::sqrt(static_cast<double>(o.i * o.i + o.j * o.j + o.k * o.k)));
          }
  }
};

}  // namespace peer

#pragma once
// What the peers written in C++ share: the lattice, and the conversation with `aspic bench` (README.md).
#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace peer {

/// The cube: as docs/physics.md, section 2, numbers it.
struct Lattice {
  int n = 10;              ///< particles per edge, ≥ 3
  double edge = 4.0;       ///< [m]
  double height = 9.0;     ///< of the centre [m]
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

using Json = nlohmann::ordered_json;

/// The conversation. `make(lattice)` gives an object with
///   Json hello()              what the first line says besides the number of springs
///   std::size_t springs()
///   void load()               back to the start
///   void advance(long steps)
///   std::vector<double> positions()   x, y, z of every particle [m]
template <class Make>
int converse(int argc, char** argv, const Make& make) {
  Lattice lattice;
  int threads = 1;
  CLI::App app("A peer of aspic bench: bench/peers/README.md");
  // Words of peers.txt come before those of aspic, and win.
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeFirst);
  app.add_option("--size", lattice.n)->required();
  app.add_option("--edge", lattice.edge)->required();
  app.add_option("--height", lattice.height)->required();
  app.add_option("--mass", lattice.mass)->required();
  app.add_option("--stiffness", lattice.stiffness)->required();
  app.add_option("--damping", lattice.damping)->required();
  app.add_option("--timestep", lattice.timestep)->required();
  app.add_option("--gravity", lattice.gravity)->required();
  app.add_option("--stretch", lattice.stretch)->required();
  app.add_option("--threads", threads);
  CLI11_PARSE(app, argc, argv);

  auto peer = make(lattice);
  const auto say = [](const Json& line) { std::cout << line.dump() << std::endl; };
  Json hello = peer.hello();
  hello["springs"] = peer.springs();
  say(hello);
  std::string word;
  for (long steps = 0; std::cin >> word >> steps;) {
    peer.load();
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor_start = std::clock();
    peer.advance(steps);
    const double processor_seconds = static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    const std::vector<double> x = peer.positions();
    double sum = 0.0;
    for (std::size_t i = 1; i < x.size(); i += 3) sum += x[i];
    Json answer = {{"seconds", took.count()},
                   {"processor_seconds", processor_seconds},
                   {"height", sum / static_cast<double>(lattice.count())}};
    if (word == "positions") answer["positions"] = x;
    say(answer);
  }
  return 0;
}

}  // namespace peer

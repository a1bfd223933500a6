#pragma once
// What the peers written in C++ share: the lattice, and the conversation with `aspic bench` (README.md).
#include <CLI/CLI.hpp>
#include <chrono>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lattice.h"

namespace peer {

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

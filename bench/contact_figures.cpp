// What contact between bodies costs a step on the backend cpu, next to the rest of it: the same steps from
// the same states with and without it (Google Benchmark).
//   build/release/bench/contact_figures --benchmark_repetitions=7
//       --benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true
// `stack`: eight cubes of 20³, which sway on each other, bounce ever less, or rest; `heap`: the scene, which
// falls together or lies; `crowd`: ever more cubes side by side. One thread by its processor time, two by the
// clock.
#include <aspic/aspic.h>
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "checked.h"

namespace {

using namespace aspic;

/// Eight cubes of twenty times the default stiffness, which stand on the ground; `lean` [1/s]: the speed with
/// which the tower leans over, by height.
ModelSettings stack(double lean, int count = 8) {
  ModelSettings settings;
  settings.terrain.push_back({});
  for (int n = 0; n < count; ++n) {
    CubeSettings& cube = settings.cubes.emplace_back();
    cube.particles_per_edge = 20;
    cube.structural.stiffness = cube.shear.stiffness = cube.bending.stiffness = 40000.0;
    cube.position = {0.0, 2.01 + 4.03 * n, 0.0};
    cube.velocity = {lean * cube.position.y, 0.0, 0.3 * lean * cube.position.y};
  }
  settings.simulation.integrator = Integrator::symplectic_euler;
  return settings;
}

/// The same with so much damping that it comes to rest.
ModelSettings damped_stack() {
  ModelSettings settings = stack(0.0);
  for (CubeSettings& cube : settings.cubes)
    cube.structural.damping = cube.shear.damping = cube.bending.damping = 150.0;
  settings.simulation.timestep = 0.0005;
  return settings;
}

/// A layer of so many cubes of 2³ that drift about next to each other, most of them touching four.
ModelSettings crowd(int count) {
  ModelSettings settings;
  const int edge = static_cast<int>(std::ceil(std::sqrt(count) - 1e-9));
  for (int n = 0; n < count; ++n) {
    CubeSettings& cube = settings.cubes.emplace_back();
    cube.particles_per_edge = 2;
    cube.edge_length = 1.0;
    cube.position = {1.08 * (n % edge), 0.0, 1.08 * (n / edge)};
    const auto some = [&](int of) { return 0.1 * ((n * of) % 17 - 8); };
    cube.velocity = {some(5), some(7), some(11)};
  }
  settings.simulation.gravity = {};
  settings.simulation.integrator = Integrator::symplectic_euler;
  return settings;
}

double seconds(unsigned threads) {
  if (threads > 1)
    return 1e-9 * static_cast<double>(std::chrono::steady_clock::now().time_since_epoch().count());
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::unique_ptr<Solver> solver_of(const ModelSettings& settings, unsigned threads) {
  BackendChoice choice = checked(parse_backend("cpu"));
  choice.threads = threads;
  return std::move(checked(make_backend(choice, checked(make_model(settings)))).solver);
}

/// The state at this time, made when it is first asked for.
class Start {
 public:
  Start(ModelSettings settings, double at) : settings_(std::move(settings)), at_(at) {}
  const State& operator()() {
    if (!made_) {
      const auto solver = solver_of(settings_, 1);
      (void)checked(solver->advance(static_cast<std::uint64_t>(at_ / settings_.simulation.timestep)));
      made_ = checked(solver->state());
    }
    return *made_;
  }

 private:
  ModelSettings settings_;
  double at_;
  std::optional<State> made_;
};

/// So many steps from the state at this time on.
void add(const std::string& name, const ModelSettings& settings, double from, std::uint64_t steps = 1000) {
  const auto start = std::make_shared<Start>(settings, from);
  for (const unsigned threads : {1u, 2u}) {
    for (const bool touching : {true, false}) {
      ModelSettings own = settings;
      own.contact.bodies = touching;
      const auto run = [=](benchmark::State& state) {
        const std::unique_ptr<Solver> solver = solver_of(own, threads);
        for ([[maybe_unused]] auto _ : state) {
          check(solver->load((*start)()));
          const double before = seconds(threads);
          (void)checked(solver->advance(steps));
          state.SetIterationTime((seconds(threads) - before) / static_cast<double>(steps));
        }
      };
      benchmark::RegisterBenchmark(
          fmt::format("{}/{}/{}", name, threads, touching ? "touching" : "apart").c_str(), run)
          ->Unit(benchmark::kMicrosecond)
          ->UseManualTime()
          ->Iterations(1);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  add("stack, swaying", stack(0.05), 1.0);
  add("stack, settling", stack(0.0), 5.0);
  add("stack, resting", damped_stack(), 8.0);
  const ModelSettings heap = checked(load_scene("heap", {})).model;
  add("heap, falling", heap, 0.6);
  add("heap, lying", heap, 6.0);
  add("one cube", stack(0.0, 1), 0.1);
  for (const int count : {100, 1000, 10000}) add(fmt::format("crowd of {}", count), crowd(count), 0.02, 20);
  benchmark::RunSpecifiedBenchmarks();
}

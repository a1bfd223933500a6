// Implicit Euler on cubes (Google Benchmark):
//   build/release/bench/implicit_figures [--benchmark_filter=Free] [--benchmark_repetitions=5]
// Landing: a cube falls and lands within 60 steps of 1/60 s, one simulated second; `real_time` tells how many
// times faster than that it was. Free: a cube that wobbles in free flight, the same steps by each solver, one
// of them Eigen's conjugate gradients on an assembled matrix.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "assembled.h"
#include "cpu_parallel/cpu_solver.h"
#include "cpu_reference/reference_solver.h"

namespace aspic {
namespace {

constexpr std::uint64_t landing_steps = 60, free_steps = 20;
constexpr double timestep = 1.0 / 60;

template <class T>
T taken(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

ModelSettings cube(int n) {
  ModelSettings settings;
  settings.simulation.integrator = Integrator::implicit_euler;
  settings.simulation.timestep = timestep;
  settings.cubes.resize(1);
  settings.cubes[0].particles_per_edge = n;
  return settings;
}

/// The scene cube-plane, half a metre above the ground.
Model landing(int n) {
  ModelSettings settings = cube(n);
  settings.cubes[0].position.y = 1.5;
  settings.terrain.push_back(
      {.geometry = {{"point", Vec3{0.0, -1.0, 0.0}}, {"normal", Vec3{0.0, 1.0, 0.0}}}});
  return taken(build_model(settings));
}

/// Sheared and twisted, without terrain.
Model wobbling(int n) {
  Model model = taken(build_model(cube(n)));
  std::vector<Vec3> places, velocities;
  for (const Vec3 x : model.initial_position) {
    places.push_back({x.x + 0.1 * std::sin(x.z), 0.95 * x.y, x.z});
    velocities.push_back({0.5 * x.z, 0.0, -0.5 * places.back().x});
  }
  model.initial_position = std::move(places);
  model.initial_velocity = velocities;
  return model;
}

void report(benchmark::State& state, const SolveStatistics& solves) {
  const auto each = [&](std::uint64_t n) {
    return static_cast<double>(n) / static_cast<double>(std::max<std::uint64_t>(solves.steps, 1));
  };
  state.counters["newton"] = each(solves.newton_iterations);
  state.counters["cg"] = each(solves.cg_iterations);
  state.counters["converged"] = each(solves.converged);
  state.counters["real_time"] = benchmark::Counter(static_cast<double>(solves.steps) * timestep,
                                                   benchmark::Counter::kIsIterationInvariantRate);
}

/// The same steps from the model's initial state, again and again.
void run(benchmark::State& state, Solver& solver, std::uint64_t steps) {
  const aspic::State start = initial_state(solver.model(), Precision::single);
  for (auto _ : state) {
    if (!solver.load(start).ok() || !solver.advance(steps).ok()) return state.SkipWithError("no result");
  }
  report(state, *solver.solve_statistics());
}

void LandingReference(benchmark::State& state) {
  const Model model = landing(static_cast<int>(state.range(0)));
  run(state, *taken(make_reference_solver(model, Precision::single)), landing_steps);
}
void LandingCpu(benchmark::State& state) {
  const Model model = landing(static_cast<int>(state.range(0)));
  run(state, *taken(make_cpu_solver(model, {static_cast<unsigned>(state.range(1))})), landing_steps);
}

void FreeReference(benchmark::State& state) {
  const Model model = wobbling(static_cast<int>(state.range(0)));
  run(state, *taken(make_reference_solver(model, Precision::single)), free_steps);
}
void FreeCpu(benchmark::State& state) {
  const Model model = wobbling(static_cast<int>(state.range(0)));
  run(state, *taken(make_cpu_solver(model, {static_cast<unsigned>(state.range(1))})), free_steps);
}

/// Its end must be the cpu solver's but for the tolerance: a particle's error grows by at most that in a
/// step.
void FreeAssembled(benchmark::State& state) {
  const Model model = wobbling(static_cast<int>(state.range(0)));
  bench::AssembledSystem system(model);
  const aspic::State start = initial_state(model, Precision::single);
  reference::Phase<float> s;
  SolveStatistics solves;
  for (auto _ : state) {
    s = {reference::field<float>(start.position), reference::field<float>(start.velocity)};
    solves = {};
    for (std::uint64_t n = 0; n < free_steps; ++n) {
      SolveReport step;
      s = system.step(s, step);
      solves.add(step);
    }
  }
  report(state, solves);
  const auto solver = taken(make_cpu_solver(model, {1}));
  taken(solver->advance(free_steps));
  const auto expected = reference::field<float>(taken(solver->state()).velocity);
  const double most = 2.0 * static_cast<double>(free_steps) *
                      implicit_tolerance(model.simulation.implicit, Precision::single);
  const double difference = static_cast<double>((expected - s.v).cwiseAbs().maxCoeff());
  if (!(difference <= most)) state.SkipWithError("the assembled solve ends elsewhere");
  state.counters["difference"] = difference;
}

void each_size(benchmark::internal::Benchmark* benchmark) {
  for (const int n : {10, 20, 32}) benchmark->Arg(n);
  benchmark->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
}
void each_size_and_thread(benchmark::internal::Benchmark* benchmark) {
  for (const int n : {10, 20, 32}) {
    for (const int threads : {1, 2}) benchmark->Args({n, threads});
  }
  benchmark->Unit(benchmark::kMillisecond)->UseRealTime()->MeasureProcessCPUTime();
}

BENCHMARK(LandingReference)->Apply(each_size);
BENCHMARK(LandingCpu)->Apply(each_size_and_thread);
BENCHMARK(FreeReference)->Apply(each_size);
BENCHMARK(FreeAssembled)->Apply(each_size);
BENCHMARK(FreeCpu)->Apply(each_size_and_thread);

}  // namespace
}  // namespace aspic

BENCHMARK_MAIN();

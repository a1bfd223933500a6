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
  if (!result.ok()) throw std::runtime_error(result.error().message());
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

/// The scene cube-plane, half a meter above the ground.
Model landing(int n) {
  ModelSettings settings = cube(n);
  settings.cubes[0].position.y = 1.5;
  settings.terrain.push_back(
      {.geometry = {{"point", Vec3{0.0, -1.0, 0.0}}, {"normal", Vec3{0.0, 1.0, 0.0}}}});
  return taken(build_model(settings));
}

/// The cube alone.
Model free_cube(int n) {
  return taken(build_model(cube(n)));
}

/// Where it begins, sheared and twisted.
aspic::State wobbling(const Model& model) {
  aspic::State state = initial_state(model, Precision::single);
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    Vec3& x = state.position[i];
    x = {x.x + 0.1 * std::sin(x.z), 0.95 * x.y, x.z};
    state.velocity[i] = {0.5 * x.z, 0.0, -0.5 * x.x};
  }
  return state;
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

/// The same steps again and again.
void run(benchmark::State& state, Solver& solver, const aspic::State& start, std::uint64_t steps) {
  for ([[maybe_unused]] auto _ : state) {
    if (!solver.load(start).ok() || !solver.advance(steps).ok()) return state.SkipWithError("no result");
  }
  report(state, *solver.solve_statistics());
}

void landing_reference(benchmark::State& state) {
  const Model model = landing(static_cast<int>(state.range(0)));
  run(state, *taken(make_reference_solver(model, Precision::single)), initial_state(model, Precision::single),
      landing_steps);
}
void landing_cpu(benchmark::State& state) {
  const Model model = landing(static_cast<int>(state.range(0)));
  run(state, *taken(make_cpu_solver(model, {static_cast<unsigned>(state.range(1))})),
      initial_state(model, Precision::single), landing_steps);
}

void free_reference(benchmark::State& state) {
  const Model model = free_cube(static_cast<int>(state.range(0)));
  run(state, *taken(make_reference_solver(model, Precision::single)), wobbling(model), free_steps);
}
void free_cpu(benchmark::State& state) {
  const Model model = free_cube(static_cast<int>(state.range(0)));
  run(state, *taken(make_cpu_solver(model, {static_cast<unsigned>(state.range(1))})), wobbling(model),
      free_steps);
}

/// Its end must be the cpu solver's but for the tolerance: a particle's error grows by at most that in a
/// step.
void free_assembled(benchmark::State& state) {
  const Model model = free_cube(static_cast<int>(state.range(0)));
  bench::AssembledSystem system(model);
  const aspic::State start = wobbling(model);
  physics::Phase<float> s;
  SolveStatistics solves;
  for ([[maybe_unused]] auto _ : state) {
    s = {physics::field<float>(start.position), physics::field<float>(start.velocity)};
    solves = {};
    for (std::uint64_t n = 0; n < free_steps; ++n) {
      SolveReport step;
      s = system.step(s, step);
      solves.add(step);
    }
  }
  report(state, solves);
  const auto solver = taken(make_cpu_solver(model, {1}));
  if (!solver->load(start).ok()) return state.SkipWithError("no state");
  taken(solver->advance(free_steps));
  const auto expected = physics::field<float>(taken(solver->state()).velocity);
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

BENCHMARK(landing_reference)->Apply(each_size);
BENCHMARK(landing_cpu)->Apply(each_size_and_thread);
BENCHMARK(free_reference)->Apply(each_size);
BENCHMARK(free_assembled)->Apply(each_size);
BENCHMARK(free_cpu)->Apply(each_size_and_thread);

}  // namespace
}  // namespace aspic

BENCHMARK_MAIN();

// Time to read the state of a million particles: as a new State, into a State that is used again, into arrays
// of the caller, in the solver's own memory; and to load it. A copy of 12 MB for comparison.
//   build/release/bench/view_figures --benchmark_repetitions=11 --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>

#include <cstring>
#include <memory>
#include <vector>

#include "aspic/scene.h"
#include "checked.h"
#include "cpu_parallel/cpu_solver.h"
#include "cpu_reference/reference_solver.h"
#include "gpu/context.h"
#include "gpu_solver/gpu_solver.h"

namespace {

using namespace aspic;

const SharedModel& model() {
  static const SharedModel made = [] {
    const std::vector<std::string> large = {"cube[0].particles-per-edge=100"};
    return shared(checked(build_model(checked(load_scene("cube-plane", large)).model)));
  }();
  return made;
}

Solver& cpu() {
  static const std::unique_ptr<Solver> made = checked(make_cpu_solver(model()));
  return *made;
}
Solver& reference() {
  static const std::unique_ptr<Solver> made = checked(make_reference_solver(model(), Precision::single));
  return *made;
}

Solver& gpu() {
  static const auto context = checked(gl::Context::create_headless());
  static const std::unique_ptr<GpuSolver> made = checked(make_gpu_solver(*context, model()));
  return *made;
}

/// ns a particle, as the column `particle`.
void count_particles(benchmark::State& state) {
  state.counters["particle"] =
      benchmark::Counter(static_cast<double>(model()->particle_count()) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void copy(benchmark::State& state) {
  const std::vector<float> from(3 * std::size_t{model()->particle_count()}, 1.0f);
  std::vector<float> to(from.size());
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), from.size() * sizeof(float));
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
}

template <class T>
void into(benchmark::State& state, Solver& solver, std::ptrdiff_t stride, std::ptrdiff_t component) {
  const std::size_t count = model()->particle_count();
  std::vector<T> to(3 * count);
  StateView view;
  view[field_number("position")] = Strided<T>{to.data(), count, stride, component};
  for (auto _ : state) {
    (void)checked(solver.read_into(view));
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  count_particles(state);
}

void whole(benchmark::State& state, Solver& solver) {
  for (auto _ : state) benchmark::DoNotOptimize(checked(solver.state()));
  count_particles(state);
}

void again(benchmark::State& state, Solver& solver) {
  State kept = checked(solver.state());
  for (auto _ : state) {
    kept.step = checked(solver.read_into(view_of(kept)));
    benchmark::ClobberMemory();
  }
  count_particles(state);
}

void load(benchmark::State& state, Solver& solver) {
  const State kept = checked(solver.state());
  for (auto _ : state) check(solver.load(kept));
  count_particles(state);
}

void where_it_lies(benchmark::State& state, Solver& solver) {
  for (auto _ : state) benchmark::DoNotOptimize(solver.view());
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const auto add = [](const char* name, const auto& run) {
    benchmark::RegisterBenchmark(name, run)->Unit(benchmark::kMillisecond);
  };
  const auto count = static_cast<std::ptrdiff_t>(model()->particle_count());
  add("copy of 12 MB", copy);
  add("cpu/three arrays of floats", [=](benchmark::State& s) { into<float>(s, cpu(), 1, count); });
  add("cpu/rows of floats", [](benchmark::State& s) { into<float>(s, cpu(), 3, 1); });
  add("cpu/rows of doubles", [](benchmark::State& s) { into<double>(s, cpu(), 3, 1); });
  add("cpu/where it lies", [](benchmark::State& s) { where_it_lies(s, cpu()); });
  add("cpu/State", [](benchmark::State& s) { whole(s, cpu()); });
  add("cpu/State again", [](benchmark::State& s) { again(s, cpu()); });
  add("cpu/load", [](benchmark::State& s) { load(s, cpu()); });
  add("gpu/three arrays of floats", [=](benchmark::State& s) { into<float>(s, gpu(), 1, count); });
  add("gpu/rows of floats", [](benchmark::State& s) { into<float>(s, gpu(), 3, 1); });
  add("gpu/rows of doubles", [](benchmark::State& s) { into<double>(s, gpu(), 3, 1); });
  add("gpu/State", [](benchmark::State& s) { whole(s, gpu()); });
  add("gpu/State again", [](benchmark::State& s) { again(s, gpu()); });
  add("gpu/load", [](benchmark::State& s) { load(s, gpu()); });
  add("reference/rows of floats", [](benchmark::State& s) { into<float>(s, reference(), 3, 1); });
  add("reference/State", [](benchmark::State& s) { whole(s, reference()); });
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

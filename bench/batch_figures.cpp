// A thousand cubes of 6³ as one batch, and the same models one after the other through the public interface,
// in turns: million spring evaluations per second, and how the hashes compare.
//   build/release/bench/batch_figures --benchmark_repetitions=7 --benchmark_enable_random_interleaving=true
//       --benchmark_report_aggregates_only=true
// `in the air`: the first 100 steps; `on the ground`: 100 steps after 2,000, when all of them lie there.
#include <aspic/aspic.h>
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "checked.h"

namespace {

using namespace aspic;

constexpr std::size_t instances = 1000;
/// Of a measurement: in this time nothing meets the ground, or all of it lies there.
constexpr std::uint64_t steps = 100;

/// Cubes that differ in place, gravity and stiffness.
std::vector<SharedModel> models() {
  std::vector<SharedModel> made;
  for (std::size_t i = 0; i < instances; ++i) {
    const auto differs = static_cast<double>(i);
    const std::vector<std::string> keys = {
        "cube[0].particles-per-edge=6", fmt::format("cube[0].position=[{}, 2.2, 0]", 0.01 * differs),
        fmt::format("simulation.gravity=[0, {}, 0]", -9.8 + 1e-3 * differs),
        fmt::format("cube[0].structural.stiffness={}", 1500.0 + differs)};
    made.push_back(checked(make_model(checked(load_scene("cube-plane", keys)).model)));
  }
  return made;
}

/// The states in which a measurement begins.
struct Start {
  const char* name;
  std::vector<State> states;
};

struct Figures {
  std::vector<SharedModel> models = ::models();
  std::vector<std::unique_ptr<Solver>> alone;
  std::vector<Batch> batches;
  double evaluations = 0.0;
  Start starts[2] = {{"in the air", {}}, {"on the ground", {}}};

  Figures() {
    for (const SharedModel& model : models) {
      alone.push_back(std::move(checked(make_backend(checked(parse_backend("cpu")), model)).solver));
      evaluations += static_cast<double>(spring_facts(*model).size()) * static_cast<double>(steps);
    }
    for (const unsigned threads : {1u, 0u}) batches.push_back(checked(Batch::create(models, {threads})));
    Batch& batch = batches.back();
    for (Start& start : starts) {
      for (std::size_t i = 0; i < instances; ++i) start.states.push_back(checked(batch.state(i)));
      (void)checked(batch.advance(2000));
    }
  }
  void begin(const Start& start) {
    for (std::size_t i = 0; i < instances; ++i) {
      (void)alone[i]->load(start.states[i]);
      for (Batch& batch : batches) (void)batch.load(i, start.states[i]);
    }
  }
};

Figures& figures() {
  static Figures all;
  return all;
}

void time_of(benchmark::State& state, const Start& start, const std::function<void()>& act) {
  for (auto _ : state) {
    state.PauseTiming();
    figures().begin(start);
    state.ResumeTiming();
    act();
  }
  state.counters["M/s"] =
      benchmark::Counter(1e-6 * figures().evaluations, benchmark::Counter::kIsIterationInvariantRate);
}

/// What a program does that controls all of them: a step of each, then the next.
void step_by_step() {
  for (std::uint64_t n = 0; n < steps; ++n)
    for (const auto& solver : figures().alone) (void)checked(solver->advance(1));
}
/// The first to its end, then the second.
void run_by_run() {
  for (const auto& solver : figures().alone)
    for (std::uint64_t n = 0; n < steps; ++n) (void)checked(solver->advance(1));
}
/// Every solver's steps in one call.
void at_once() {
  for (const auto& solver : figures().alone) (void)checked(solver->advance(steps));
}

bool hashes_are_equal(const Start& start) {
  Figures& all = figures();
  all.begin(start);
  at_once();
  std::size_t differing = 0;
  for (Batch& batch : all.batches) {
    (void)checked(batch.advance(steps));
    for (std::size_t i = 0; i < instances; ++i)
      differing += state_hash(checked(batch.state(i))) != state_hash(checked(all.alone[i]->state())) ? 1 : 0;
  }
  fmt::print("{}: {} of {} hashes differ from the lone runs'\n", start.name, differing, 2 * instances);
  return differing == 0;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  bool equal = true;
  for (const Start& start : figures().starts) {
    equal = hashes_are_equal(start) && equal;
    const auto add = [&start](const char* name, const std::function<void()>& act) {
      benchmark::RegisterBenchmark(fmt::format("{}/{}", start.name, name).c_str(),
                                   [&start, act](benchmark::State& s) { time_of(s, start, act); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    };
    add("alone, step by step", step_by_step);
    add("alone, run by run", run_by_run);
    add("alone, a call each", at_once);
    add("batch, 1 thread", [] { (void)checked(figures().batches[0].advance(steps)); });
    add("batch", [] { (void)checked(figures().batches[1].advance(steps)); });
    add("batch, step by step", [] {
      for (std::uint64_t n = 0; n < steps; ++n) (void)checked(figures().batches[1].advance(1));
    });
  }
  fmt::print("{}\n", figures().batches[1].description());
  benchmark::RunSpecifiedBenchmarks();
  return equal ? 0 : 1;
}

// The inner pieces of the solvers one by one, and what this processor does at best (Google Benchmark):
//   build/release/bench/pieces [--benchmark_filter=lattice]
// Times are of one thread; "/AVX2" and so on is the instruction set.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <hwy/targets.h>

#include <cstring>
#include <set>

#include "cpu_parallel/contact_pieces.h"
#include "cpu_parallel/kernels.h"
#include "cpu_parallel/lattice_kernels.h"
#include "cpu_parallel/springs.h"
#include "model/counts.h"
#include "model/incident_springs.h"
#include "physics/reductions.h"
#include "rates.h"

namespace aspic {
namespace {

using benchmark::Counter;
using benchmark::State;

/// Particles handled at a time, as by the cpu solver.
constexpr std::size_t piece = 1024;

/// Until the end of its life only this instruction set is used.
class Only {
 public:
  explicit Only(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~Only() { hwy::SetSupportedTargetsForTest(0); }
};

/// A body as the cpu solver holds it.
struct Body {
  Model model;
  parallel::Particles at, next;
  parallel::FloatArray mass, inverse_mass;
  physics::BodyForce<float> body_force;
  alignas(64) float f[3][piece + parallel::slice];

  explicit Body(const ModelSettings& settings) : model(*build_model(settings)), body_force(model) {
    const std::size_t count = model.particle_count(), margin = count;
    at = parallel::Particles(count, margin);
    next = parallel::Particles(count, margin);
    mass = parallel::FloatArray(count, parallel::slice);
    inverse_mass = parallel::FloatArray(count, parallel::slice);
    const aspic::State start = initial_state(model, Precision::single);
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3& x = start.position[i];
      parallel::set(at.x, i, {static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)});
      mass[i] = static_cast<float>(model.mass[i]);
      inverse_mass[i] = static_cast<float>(model.inverse_mass[i]);
    }
  }
  parallel::ForceInput input() const { return {&at, mass.data(), &body_force}; }
  parallel::Forces forces() { return {{f[0], f[1], f[2]}}; }

  /// Calls act(range) for every piece.
  template <class Act>
  void for_each_piece(const Act& act) const {
    const std::size_t count = model.particle_count();
    for (std::size_t i = 0; i < count; i += piece) act(parallel::Range{i, std::min(piece, count - i)});
  }
};

ModelSettings cube_settings(int n) {
  ModelSettings settings;
  settings.cubes.resize(1);
  settings.cubes[0].particles_per_edge = n;
  settings.terrain.push_back({});
  return settings;
}
ModelSettings net_settings() {
  ModelSettings settings;
  settings.goal_nets.resize(1);
  settings.goal_nets[0].particles = {40, 80, 140};
  return settings;
}

void count_items(State& state, const char* name, std::size_t per_iteration) {
  state.counters[name] = Counter(static_cast<double>(per_iteration), Counter::kIsIterationInvariantRate);
}

void lattice_forces(State& state, std::int64_t target, int n) {
  Body cube(cube_settings(n));
  const parallel::LatticeStencil lattice(cube.model, cube.model.bodies[0]);
  parallel::Sweep sweep(lattice.plane_size(), lattice.row_size());
  parallel::ForceInput input = cube.input();
  const Only only(target);
  while (state.KeepRunning()) {
    parallel::begin_plane(lattice, input, sweep, 0);
    parallel::begin_plane(lattice, input, sweep, 1);
    for (std::size_t plane = 0; plane < lattice.planes(); ++plane) {
      if (plane + 2 < lattice.planes()) parallel::begin_plane(lattice, input, sweep, plane + 2);
      for (std::size_t i = 0; i < lattice.plane_size(); i += parallel::chunk_size)
        parallel::lattice_forces(lattice, input, sweep, plane,
                                 {i, std::min(parallel::chunk_size, lattice.plane_size() - i)},
                                 cube.forces());
    }
    benchmark::ClobberMemory();
  }
  count_items(state, "springs", count(cube.model).springs());
}

void listed_forces(State& state, std::int64_t target) {
  Body net(net_settings());
  const parallel::SpringLists lists(net.model, net.model.bodies[0]);
  const Only only(target);
  while (state.KeepRunning()) {
    net.for_each_piece(
        [&](parallel::Range range) { parallel::listed_forces(lists, net.input(), range, net.forces()); });
    benchmark::ClobberMemory();
  }
  count_items(state, "springs", count(net.model).springs());
}

void move(State& state, std::int64_t target) {
  Body cube(cube_settings(40));
  const Only only(target);
  const parallel::StageMove stage = {&cube.at, &cube.at, &cube.next, nullptr, cube.inverse_mass.data(), 0.0f,
                                     1.0f,     1e-3f,    false,      true,    Drift::stage_velocity};
  parallel::Moved moved(1e6f);
  while (state.KeepRunning()) {
    cube.for_each_piece([&](parallel::Range range) { parallel::move(stage, range, cube.forces(), moved); });
    benchmark::ClobberMemory();
  }
  count_items(state, "particles", cube.model.particle_count());
}

void box(State& state, std::int64_t target) {
  Body cube(cube_settings(40));
  const Only only(target);
  while (state.KeepRunning())
    cube.for_each_piece(
        [&](parallel::Range range) { benchmark::DoNotOptimize(parallel::box_of(cube.at.x, range)); });
  count_items(state, "particles", cube.model.particle_count());
}

void all_sound(State& state, std::int64_t target) {
  Body cube(cube_settings(40));
  const Only only(target);
  while (state.KeepRunning())
    cube.for_each_piece(
        [&](parallel::Range range) { benchmark::DoNotOptimize(parallel::all_sound(cube.at, range, 1e6f)); });
  count_items(state, "particles", cube.model.particle_count());
}

/// The question whether terrain is near, once for each piece, and the answer no.
void far_terrain(State& state) {
  const Body cube(cube_settings(40));
  std::vector<parallel::Box> boxes;
  cube.for_each_piece([&](parallel::Range range) { boxes.push_back(parallel::box_of(cube.at.x, range)); });
  while (state.KeepRunning())
    for (const parallel::Box& at : boxes) benchmark::DoNotOptimize(parallel::near_terrain(cube.model, at));
  count_items(state, "pieces", boxes.size());
}

/// Response to a plane at the end of a step, of particles near it.
void contact(State& state) {
  const Body cube(cube_settings(40));
  reference::Dynamics<float> dynamics(cube.model);
  dynamics.begin_step(0);
  while (state.KeepRunning()) {
    for (Eigen::Index i = 0; i < 1000; ++i) {
      const parallel::Vector start(0.0f, 1e-3f, 0.0f), v(0.1f, -1.0f, 0.0f);
      parallel::Vector x(0.0f, -1e-3f, 0.0f), after = v;
      dynamics.respond(i, start, v, x, after);
      benchmark::DoNotOptimize(x);
      benchmark::DoNotOptimize(after);
    }
  }
  count_items(state, "particles", 1000);
}

void reduction(State& state) {
  const std::vector<float> values(static_cast<std::size_t>(state.range(0)), 1.5f);
  while (state.KeepRunning()) benchmark::DoNotOptimize(physics::tree_sum(values));
  count_items(state, "numbers", values.size());
}

/// Lists of a body's springs by particle, as the gpu needs them.
void incident_lists(State& state) {
  const Body cube(cube_settings(static_cast<int>(state.range(0))));
  while (state.KeepRunning())
    benchmark::DoNotOptimize(incident_springs(cube.model, IncidentWords::neighbors));
  count_items(state, "springs", count(cube.model).springs());
}

/// As the benchmark STREAM counts: bytes read and bytes written.
void copy(State& state) {
  const auto bytes = static_cast<std::size_t>(state.range(0));
  const std::vector<float> from(bytes / 2 / sizeof(float), 1.0f);
  std::vector<float> to(from.size());
  while (state.KeepRunning()) {
    std::memcpy(to.data(), from.data(), from.size() * sizeof(float));
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

void rate(State& state, std::int64_t target, bench::Operation operation) {
  const Only only(target);
  std::size_t numbers = 0;
  while (state.KeepRunning()) numbers += bench::repeat(operation, 1000);
  state.counters["numbers"] = Counter(static_cast<double>(numbers), Counter::kIsRate);
}

void register_all() {
  using bench::Operation;
  constexpr std::pair<const char*, Operation> operations[] = {
      {"add", Operation::add},           {"multiply", Operation::multiply},
      {"fused", Operation::fused},       {"root", Operation::root},
      {"quotient", Operation::quotient}, {"reciprocal_root", Operation::reciprocal_root}};
  std::set<std::string> names;
  for (std::int64_t targets = hwy::SupportedTargets(); targets != 0; targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    const std::string set = [&] {
      const Only only(target);
      return std::string(parallel::instruction_set());
    }();
    // The kernels are not compiled for all that the processor has.
    if (set != hwy::TargetName(target) || !names.insert(set).second) continue;
    const auto add = [&](const std::string& name, auto run) {
      benchmark::RegisterBenchmark(fmt::format("{}/{}", name, set).c_str(), run);
    };
    for (const int n : {10, 20, 40, 100, 200})
      add(fmt::format("lattice_forces/{}", n), [=](State& s) { lattice_forces(s, target, n); });
    add("listed_forces", [=](State& s) { listed_forces(s, target); });
    add("move", [=](State& s) { move(s, target); });
    add("box", [=](State& s) { box(s, target); });
    add("all_sound", [=](State& s) { all_sound(s, target); });
    for (const auto& [name, operation] : operations)
      add(fmt::format("rate/{}", name), [=, op = operation](State& s) { rate(s, target, op); });
  }
  benchmark::RegisterBenchmark("far_terrain", far_terrain);
  benchmark::RegisterBenchmark("contact", contact);
  benchmark::RegisterBenchmark("reduction", reduction)->Arg(3000)->Arg(192'000);
  benchmark::RegisterBenchmark("incident_lists", incident_lists)->Arg(10)->Arg(40);
  for (const int bytes : {32 << 10, 1 << 20, 512 << 20})
    benchmark::RegisterBenchmark("copy", copy)->Arg(bytes);
  benchmark::RegisterBenchmark("copy", copy)->Arg(512 << 20)->Threads(2)->UseRealTime();
}

}  // namespace
}  // namespace aspic

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  aspic::register_all();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

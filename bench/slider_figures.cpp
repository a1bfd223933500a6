// What a slider of the window costs: constants that change in a run, of a cube of 40 particles along each
// edge.
//   build/release/bench/slider_figures --benchmark_repetitions=11 --benchmark_report_aggregates_only=true
// `solver`: Solver::set_constants(), and for comparison a new solver that loads the state. `window`: all that
// a slider's step costs the window's thread in a pause, but drawing; `rebuilt`: that of a change of another
// kind (of the contact model), for which solvers are made.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <memory>

#include "app/scene_editor.h"
#include "aspic/scene.h"
#include "checked.h"
#include "gpu/context.h"
#include "playback/playback_session.h"
#include "run/backends.h"
#include "run/window_host.h"
#include "scene/parameters.h"

namespace {

using namespace aspic;

Scene scene(std::string_view integrator) {
  const std::vector<std::string> large = {"cube[0].particles-per-edge=40",
                                          fmt::format("simulation.integrator={}", integrator)};
  return checked(load_scene("cube-plane", large));
}

gl::Context& context() {
  static const std::shared_ptr<gl::Context> made = checked(gl::Context::create_headless());
  return *made;
}

void solver(benchmark::State& state, const char* backend, const char* integrator, bool anew) {
  Scene one = scene(integrator), other = one;
  for (SpringSettings* const springs : {&other.model.cubes[0].structural, &other.model.cubes[0].shear})
    springs->stiffness *= 1.05;
  const SharedModel models[] = {shared(checked(build_model(one.model))),
                                shared(checked(build_model(other.model)))};
  BackendChoice choice;
  choice.row = find_backend(backend);
  auto made = checked(make_backend(choice, models[0], {&context(), nullptr, {}}));
  const State at = checked(made.solver->state());
  std::size_t n = 0;
  for (auto _ : state) {
    const SharedModel& next = models[++n % 2];
    if (anew) {
      auto fresh = checked(make_backend(choice, next, {&context(), gpu_of(made), {}}));
      check(fresh.solver->load(at));
      made = std::move(fresh);
    } else {
      check(made.solver->set_constants(next));
    }
  }
}

/// As a slider does: the editor takes the value, the simulation the scene.
void window(benchmark::State& state, const char* backend, const char* integrator, bool rebuilt) {
  const Scene start = scene(integrator);
  auto simulation = checked(PlaybackSession::create(context(), start, *find_backend(backend)));
  auto editor = checked(app::SceneEditor::open(
      "cube-plane", {"cube[0].particles-per-edge=40", fmt::format("simulation.integrator={}", integrator)}));
  const Parameter& stiffness = *find_parameter("cube[].structural.stiffness");
  const Parameter& contact = *find_parameter("contact.model");
  bool more = false;
  for (auto _ : state) {
    more = !more;
    const auto effect =
        rebuilt ? editor.set(contact, 0, Value(std::string(more ? "course" : "coulomb")), "slider")
                : editor.set(stiffness, 0, Value(more ? 2100.0 : 2000.0), "slider");
    if (!effect) check(effect.error());
    check(simulation->rebuild().change(editor.scene(), true));
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const char* const integrator : {"explicit-euler", "implicit-euler"}) {
    for (const char* const backend : {"gpu", "cpu", "reference"}) {
      const auto add = [&](const char* what, const auto& run) {
        benchmark::RegisterBenchmark(fmt::format("{}/{}/{}", what, backend, integrator).c_str(), run)
            ->Unit(benchmark::kMillisecond);
      };
      add("solver/set", [=](benchmark::State& s) { solver(s, backend, integrator, false); });
      add("solver/new", [=](benchmark::State& s) { solver(s, backend, integrator, true); });
      add("window", [=](benchmark::State& s) { window(s, backend, integrator, false); });
      add("window/rebuilt", [=](benchmark::State& s) { window(s, backend, integrator, true); });
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

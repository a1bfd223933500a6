// Runs of sweeps: their keys, figures and files.
#include <aspic/parameters.h>
#include <aspic/sweep.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "batch.h"
#include "reading.h"
#include "simulation.h"

namespace aspic::python {
namespace {

using Differences = std::vector<std::pair<std::string, std::string>>;
SweepRun run_of(const Scene& scene, const std::string& backend, std::optional<bool> doubles,
                const Differences& differences, std::optional<std::uint64_t> steps,
                std::optional<double> duration) {
  const Unlocked others;
  std::vector<Difference> all;
  for (const auto& [key, value] : differences) all.push_back({key, value});
  return sweep_run(scene, choice_of(backend, doubles, 0), {steps, duration}, all);
}

RunOutcome outcome_of(const std::string& name) {
  for (const RunOutcome outcome : {RunOutcome::ok, RunOutcome::diverged, RunOutcome::rejected})
    if (name_of(outcome) == name) return outcome;
  return RunOutcome::failed;
}

/// Takes the state of a simulation or an instance.
template <class T>
void take_state(RunFigures& figures, T& from) {
  const State state = from.state();
  const Unlocked others;
  figures.take(state);
}

}  // namespace

void bind_sweep(nb::module_& module) {
  nb::class_<SweepRun>(module, "SweepRun", "A run of a sweep.")
      .def_ro("key", &SweepRun::key, "32 hexadecimal digits, equal for equal runs on every machine.")
      .def_ro("scene", &SweepRun::scene, "Scene with the differences; undefined for a rejected run.")
      .def_prop_ro(
          "timestep", [](const SweepRun& run) { return run.scene.model.simulation.timestep; },
          "Time step [s].")
      .def_ro("backend", &SweepRun::backend_words, "Backend as requested.")
      .def_prop_ro(
          "doubles", [](const SweepRun& run) { return run.backend.precision == Precision::double_; },
          "True for double precision.")
      .def_ro("steps", &SweepRun::steps, "Steps of the run.")
      .def_ro("particles", &SweepRun::particles, "Particles that move.")
      .def_prop_ro(
          "error",
          [](const SweepRun& run) {
            std::optional<std::pair<int, std::string>> error;
            if (run.error)
              error.emplace(static_cast<int>(run.error->code), worded(*run.error, FrontEnd::python));
            return error;
          },
          "Code and message of a rejected run.")
      .def(
          "file",
          [](const SweepRun& run, const std::string& scene, const std::string& outcome, std::string reason,
             const RunFigures* figures, std::uint64_t steps, std::string hash, std::string solver,
             double seconds) {
            return run_file(run,
                            {outcome_of(outcome), std::move(reason), steps,
                             figures ? figures->figures() : std::vector<RunFigure>(), std::move(hash),
                             std::move(solver), seconds},
                            scene);
          },
          nb::arg("scene"), nb::arg("outcome"), nb::arg("reason"), nb::arg("figures").none() = nb::none(),
          nb::arg("steps") = 0, nb::arg("hash") = "", nb::arg("solver") = "", nb::arg("seconds") = 0.0,
          "Return the run's file as JSON; without metrics for a run that failed.");
  module.def("sweep_run", &run_of, nb::arg("scene"), nb::arg("backend"), nb::arg("doubles").none(),
             nb::arg("differences"), nb::arg("steps").none(), nb::arg("duration").none(),
             "Return the run of a scene with differences.");
  nb::class_<RunFolder>(module, "RunFolder", "Folder of finished runs, one file each.")
      .def(nb::init<std::string>(), nb::arg("path"))
      .def(
          "make", [](const RunFolder& folder, const Scene& scene) { check(folder.make(scene)); },
          nb::arg("scene"), "Create the folder and the file of its base scene.")
      .def("read", &RunFolder::read, nb::arg("key"),
           "Read a run; None if the file is missing, damaged or not regular.")
      .def(
          "write",
          [](const RunFolder& folder, const std::string& key, const std::string& ending, nb::bytes content) {
            const std::string_view bytes(content.c_str(), content.size());
            const Unlocked others;
            check(folder.write(key, ending, bytes));
          },
          nb::arg("key"), nb::arg("ending"), nb::arg("content"), "Write the file KEY.ENDING.")
      .def("file", &RunFolder::file, nb::arg("key"), nb::arg("ending"), "Return the path of a file.");
  module.def("scene_key", &scene_key, nb::arg("scene"), "Return the name of the complete file of a scene.");
  nb::class_<RunFigures>(module, "RunFigures", "Metrics of a run, computed from its states.")
      .def(
          "__init__", [](RunFigures* figures, Simulation& of) { new (figures) RunFigures(of.model()); },
          nb::arg("of"))
      .def(
          "__init__", [](RunFigures* figures, Instance& of) { new (figures) RunFigures(of.model()); },
          nb::arg("of"))
      .def_static("interval", &RunFigures::interval, nb::arg("timestep"), "Steps between samples.")
      .def("take", &take_state<Simulation>, nb::arg("of"), "Add the present state.")
      .def("take", &take_state<Instance>, nb::arg("of"), "Add the present state.")
      .def(
          "figures",
          [](const RunFigures& figures) {
            std::vector<std::pair<std::string, std::optional<double>>> all;
            for (const RunFigure& figure : figures.figures()) all.emplace_back(figure.name, figure.value);
            return all;
          },
          "Return names and values, in the order of columns.");
}

}  // namespace aspic::python

// Runs of sweeps: their keys and their figures.
#include <aspic/parameters.h>
#include <aspic/sweep.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "batch.h"
#include "reading.h"
#include "simulation.h"

namespace aspic::python {
namespace {

using Differences = std::vector<std::pair<std::string, std::string>>;
/// Key, scene, backend, whether in double precision, steps, particles, values, error.
using RunTuple =
    std::tuple<std::string, nb::object, std::string, bool, std::uint64_t, std::uint64_t,
               std::vector<std::pair<std::string, nb::object>>, std::optional<std::pair<int, std::string>>>;

RunTuple run_of(const Scene& scene, const std::string& backend, std::optional<bool> doubles,
                const Differences& differences, std::optional<std::uint64_t> steps,
                std::optional<double> duration) {
  SweepRun run;
  {
    const Unlocked others;
    std::vector<Difference> all;
    for (const auto& [key, value] : differences) all.push_back({key, value});
    run = sweep_run(scene, choice_of(backend, doubles, 0), {steps, duration}, all);
  }
  std::vector<std::pair<std::string, nb::object>> values;
  for (const auto& [key, value] : run.values) values.emplace_back(key, as_object(value));
  std::optional<std::pair<int, std::string>> error;
  if (run.error) error.emplace(static_cast<int>(run.error->code), worded(*run.error, FrontEnd::python));
  return {run.key,           run.error ? nb::none() : nb::cast(std::move(run.scene)),
          run.backend_words, run.backend.precision == Precision::double_,
          run.steps,         run.particles,
          std::move(values), std::move(error)};
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
  module.def(
      "sweep_run", &run_of, nb::arg("scene"), nb::arg("backend"), nb::arg("doubles").none(),
      nb::arg("differences"), nb::arg("steps").none(), nb::arg("duration").none(),
      "Key, scene (None: rejected), backend, whether in double precision, steps, particles, values of the "
      "differences, error.");
  module.def("scene_key", &scene_key, nb::arg("scene"), "The name of its complete file.");
  nb::class_<RunFigures>(module, "RunFigures", "The figures of a run, from its states.")
      .def(
          "__init__", [](RunFigures* figures, Simulation& of) { new (figures) RunFigures(of.model()); },
          nb::arg("of"))
      .def(
          "__init__", [](RunFigures* figures, Instance& of) { new (figures) RunFigures(of.model()); },
          nb::arg("of"))
      .def_static("interval", &RunFigures::interval, nb::arg("timestep"),
                  "Steps between the states it takes.")
      .def("take", &take_state<Simulation>, nb::arg("of"), "Takes the state as it is.")
      .def("take", &take_state<Instance>, nb::arg("of"), "Takes the state as it is.")
      .def(
          "figures",
          [](const RunFigures& figures) {
            std::vector<std::pair<std::string, std::optional<double>>> all;
            for (const RunFigure& figure : figures.figures()) all.emplace_back(figure.name, figure.value);
            return all;
          },
          "Names and values, in the order of columns.");
}

}  // namespace aspic::python

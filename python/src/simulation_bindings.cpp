// The class _aspic.Simulation.
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "reading.h"
#include "simulation.h"

namespace aspic::python {
namespace {

/// Keeps a simulation, and its state as it is, for as long as an array shows it.
struct Hold {
  nb::object self;
  Simulation* simulation;
};

nb::object view(const nb::object& self, std::size_t field) {
  check_field(field);
  auto& simulation = nb::cast<Simulation&>(self);
  const auto vectors = simulation.begin_view(field);
  if (!vectors) return nb::none();
  auto* const hold = new Hold{self, &simulation};
  const nb::capsule owner(hold, [](void* p) noexcept {
    auto* const held = static_cast<Hold*>(p);
    held->simulation->end_view();
    delete held;
  });
  return std::visit(
      [&]<class V>(const V& v) -> nb::object {
        if constexpr (std::is_same_v<V, std::monostate>) {
          return nb::none();
        } else {
          using T = std::remove_pointer_t<decltype(v.data)>;
          return nb::cast(nb::ndarray<nb::numpy, T>(v.data, {v.count, 3}, owner, {v.stride, v.component}));
        }
      },
      *vectors);
}

Array<std::uint8_t> image(Simulation& simulation, const std::vector<std::string>& view, int width, int height,
                          bool text) {
  std::vector<std::byte> rgb = simulation.image(view, {width, height}, text);
  auto* const held = new std::vector<std::byte>(std::move(rgb));
  const nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<std::byte>*>(p); });
  return Array<std::uint8_t>(reinterpret_cast<std::uint8_t*>(held->data()),
                             {static_cast<std::size_t>(height), static_cast<std::size_t>(width), 3}, owner);
}

Diverged video(Simulation& simulation, const std::string& path, std::uint64_t steps,
               std::optional<double> fps, double speed, int width, int height, bool text, bool overwrite) {
  return told(simulation.video({path, steps, fps, speed, {width, height}, text, overwrite}));
}

Diverged page(Simulation& simulation, const std::string& path, std::uint64_t steps, std::optional<double> fps,
              double speed, bool live, bool overwrite, const std::string& command) {
  return told(simulation.page({path, steps, fps, speed, live, overwrite, command}));
}

InputLog parsed(Simulation& simulation, const std::string& text, const std::string& name) {
  const Scene scene = simulation.scene();
  return take(parse_inputs(text, name, {scene.model, *simulation.model()}));
}

InputLog read_log(Simulation& simulation, const std::string& path) {
  const Scene scene = simulation.scene();
  return take(read_inputs(path, {scene.model, *simulation.model()}));
}

/// SolveStatistics without the latest step.
using SolveRow = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t,
                            std::uint64_t, double>;
using Resumed = std::tuple<Scene, State, std::string>;

Resumed read_resumed(const std::string& path) {
  Checkpoint checkpoint = take(read_checkpoint(path));
  return {take(parse_scene(checkpoint.scene, path)), std::move(checkpoint.state),
          std::move(checkpoint.inputs)};
}

}  // namespace

void bind_simulation(nb::module_& module) {
  module.def("read_checkpoint", &read_resumed, nb::arg("path"),
             "Return scene, state and inputs of a checkpoint.");
  nb::class_<InputLog>(module, "InputLog", "Inputs of a run by step.")
      .def_prop_ro(
          "hash", [](const InputLog& log) { return log.hash_text(); }, "Hash, 16 hexadecimal digits.");
  nb::class_<ActuatorWork>(module, "ActuatorWork",
                           "Work of actuators [J], accumulated over the states of a run.")
      .def(nb::init<>());
  nb::class_<Simulation> bound(module, "Simulation", "A scene, a solver and the inputs so far.");
  bind_reading(bound);
  bound
      .def(nb::init<Scene, const std::string&, std::optional<bool>, unsigned>(), nb::arg("scene"),
           nb::arg("backend"), nb::arg("doubles").none(), nb::arg("threads"))
      .def_prop_ro(
          "variant", [](const Simulation& s) { return s.backend().variant(); }, "Backend and options.")
      .def_prop_ro(
          "device", [](const Simulation& s) { return s.backend().device; }, "Name of the device.")
      .def_prop_ro(
          "reason", [](const Simulation& s) { return s.backend().reason; },
          "Reason for which auto selected the backend.")
      .def(
          "load", [](Simulation& s, const State& state, const InputLog* log) { s.load(state, log); },
          nb::arg("state"), nb::arg("log").none(), "Load a state and its inputs.")
      .def(
          "advance",
          [](Simulation& s, std::uint64_t steps) {
            const Advance made = s.advance(steps);
            return std::make_tuple(made.steps, told(made.divergence), made.stopped);
          },
          nb::arg("steps"), "Advance; return the steps made, the divergence, and whether stop() ended it.")
      .def("stop", &Simulation::stop, "Interrupt a run in another thread.")
      .def(
          "solves",
          [](Simulation& s) -> std::optional<SolveRow> {
            const auto all = s.solves();
            if (!all) return std::nullopt;
            return SolveRow(all->steps, all->converged, all->stagnated, all->not_converged,
                            all->newton_iterations, all->cg_iterations, all->worst_residual);
          },
          "Statistics of implicit Euler solves; None with other integrators.")
      .def("warnings", &Simulation::warnings, "Return kinds, bodies, steps and sentences of warnings.")
      .def("new_warnings", &Simulation::new_warnings, "Return the warnings since the last call.")
      .def("compare", &Simulation::compare, nb::arg("other"), nb::arg("steps"),
           "Return the first step that differs.")
      .def("view", &view, nb::arg("field"), "Return a field in the solver's memory; None on a device.")
      .def("image", &image, nb::arg("view"), nb::arg("width"), nb::arg("height"), nb::arg("text"),
           "Render the state, (height, width, 3) of uint8.")
      .def("video", &video, nb::arg("path"), nb::arg("steps"), nb::arg("fps").none(), nb::arg("speed"),
           nb::arg("width"), nb::arg("height"), nb::arg("text"), nb::arg("overwrite"),
           "Advance and record a video.")
      .def("page", &page, nb::arg("path"), nb::arg("steps"), nb::arg("fps").none(), nb::arg("speed"),
           nb::arg("live"), nb::arg("overwrite"), nb::arg("command"),
           "Advance and write a page for browsers.")
      .def("log", &Simulation::log, "Return the inputs of all steps.")
      .def("set_log", &Simulation::set_log, nb::arg("log"), "Replace the inputs.")
      .def("log_text", &Simulation::log_text, "Return the inputs as TOML.")
      .def("parse_log", &parsed, nb::arg("text"), nb::arg("name"), "Read inputs from TOML.")
      .def("read_log", &read_log, nb::arg("path"), "Read inputs from a file.")
      .def("write_state", &Simulation::write_state, nb::arg("path"), nb::arg("overwrite"),
           "Write the state in the format of the ending.")
      .def("write_checkpoint", &Simulation::write_checkpoint, nb::arg("path"), nb::arg("overwrite"),
           "Write a checkpoint.");
}

}  // namespace aspic::python

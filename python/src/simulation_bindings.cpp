// The class _aspic.Simulation.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "simulation.h"

namespace aspic::python {
namespace {

/// Step, particle or ball, whether it is a ball, and what happened, in words.
using Diverged = std::optional<std::tuple<std::uint64_t, std::uint32_t, bool, std::string>>;
/// Particle or ball, anchor, stiffness, damping, whether it is a ball.
using PullRow = std::tuple<std::uint32_t, std::tuple<double, double, double>, double, double, bool>;
using Indices = std::vector<std::uint32_t>;
using InputRows = std::tuple<std::vector<PullRow>, Indices, Indices, std::vector<double>>;

Diverged told(const std::optional<Divergence>& divergence) {
  if (!divergence) return std::nullopt;
  return std::make_tuple(divergence->step, divergence->particle, divergence->ball,
                         body_text(*divergence) + " " + fault_text(*divergence));
}

InputRows rows_of(const Inputs& inputs) {
  InputRows rows = {{}, inputs.pinned, inputs.released, inputs.channels};
  for (const Pull& p : inputs.pulls)
    std::get<0>(rows).emplace_back(p.particle, std::make_tuple(p.anchor.x, p.anchor.y, p.anchor.z),
                                   p.stiffness, p.damping, p.ball);
  return rows;
}

Inputs inputs_of_rows(const InputRows& rows) {
  Inputs inputs = {{}, std::get<1>(rows), std::get<2>(rows), std::get<3>(rows)};
  for (const auto& [particle, anchor, stiffness, damping, ball] : std::get<0>(rows)) {
    const auto& [x, y, z] = anchor;
    inputs.pulls.push_back({particle, {x, y, z}, stiffness, damping, ball});
  }
  return inputs;
}

void check_field(std::size_t field) {
  if (field >= state_fields.size()) throw nb::index_error("no such field");
}

/// Without a conversion, which would fill a copy.
template <class T>
using Place = nb::ndarray<T, nb::shape<-1, 3>, nb::device::cpu>;

template <class T>
std::uint64_t read_into(Simulation& simulation, std::size_t field, const Place<T>& array) {
  check_field(field);
  StateView view;
  view[field] = Strided<T>{array.data(), array.shape(0), static_cast<std::ptrdiff_t>(array.stride(0)),
                           static_cast<std::ptrdiff_t>(array.stride(1))};
  return simulation.alone([&] { return take(simulation.backend().solver->read_into(view)); });
}

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

Array<double> masses(Simulation& simulation) {
  std::vector<double> all = particle_masses(*simulation.model());
  const std::size_t count = all.size();
  return as_array(std::move(all), {count});
}

Array<std::uint32_t> pinned(Simulation& simulation) {
  std::vector<std::uint32_t> all = pinned_indices(*simulation.model());
  const std::size_t count = all.size();
  return as_array(std::move(all), {count});
}

using SpringArrays = std::tuple<Array<std::uint32_t>, Array<double>, Array<double>, Array<double>,
                                Array<std::uint8_t>, Array<std::uint8_t>>;

/// Ends, stiffness, damping, rest length, type, whether it is a cord: an array of each.
SpringArrays springs(Simulation& simulation) {
  const std::vector<SpringFacts> all = spring_facts(*simulation.model());
  std::vector<std::uint32_t> ends;
  std::vector<double> stiffness, damping, rest;
  std::vector<std::uint8_t> type, cord;
  for (const SpringFacts& s : all) {
    ends.insert(ends.end(), {s.a, s.b});
    stiffness.push_back(s.stiffness);
    damping.push_back(s.damping);
    rest.push_back(s.rest_length);
    type.push_back(static_cast<std::uint8_t>(s.type));
    cord.push_back(s.cord ? 1 : 0);
  }
  const std::size_t count = all.size();
  return SpringArrays(as_array(std::move(ends), {count, 2}), as_array(std::move(stiffness), {count}),
                      as_array(std::move(damping), {count}), as_array(std::move(rest), {count}),
                      as_array(std::move(type), {count}), as_array(std::move(cord), {count}));
}

Array<std::uint32_t> surface(Simulation& simulation, std::size_t body) {
  const SharedModel model = simulation.model();
  if (body >= particle_ranges(*model).size()) throw nb::index_error("no such body");
  const std::vector<Quad> quads = surface_quads(*model, body);
  std::vector<std::uint32_t> corners;
  for (const Quad& quad : quads) corners.insert(corners.end(), quad.begin(), quad.end());
  return as_array(std::move(corners), {quads.size(), 4});
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges(Simulation& simulation) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
  for (const ParticleRange& range : particle_ranges(*simulation.model()))
    all.emplace_back(range.first, range.count);
  return all;
}

std::vector<std::tuple<double, double, std::uint64_t>> balls(Simulation& simulation) {
  std::vector<std::tuple<double, double, std::uint64_t>> all;
  for (const BallFacts& ball : ball_facts(*simulation.model()))
    all.emplace_back(ball.radius, ball.mass, ball.launch_step);
  return all;
}

std::tuple<double, double, double, std::tuple<double, double, double>, double, double> measures(
    Simulation& simulation) {
  const Measures m = simulation.measures();
  return {m.kinetic,       m.elastic,
          m.gravitational, std::make_tuple(m.momentum.x, m.momentum.y, m.momentum.z),
          m.max_speed,     m.min_height};
}

Array<std::uint8_t> picture(Simulation& simulation, const std::vector<std::string>& view, int width,
                            int height, bool text) {
  std::vector<std::byte> rgb = simulation.picture(view, {width, height}, text);
  auto* const held = new std::vector<std::byte>(std::move(rgb));
  const nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<std::byte>*>(p); });
  return Array<std::uint8_t>(reinterpret_cast<std::uint8_t*>(held->data()),
                             {static_cast<std::size_t>(height), static_cast<std::size_t>(width), 3}, owner);
}

Diverged film(Simulation& simulation, const std::string& path, std::uint64_t steps, std::optional<double> fps,
              double speed, int width, int height, bool text, bool overwrite) {
  return told(simulation.film({path, steps, fps, speed, {width, height}, text, overwrite}));
}

InputLog parsed(Simulation& simulation, const std::string& text, const std::string& name) {
  const Scene scene = simulation.scene();
  return take(parse_inputs(text, name, {scene.model, *simulation.model()}));
}

InputLog read_log(Simulation& simulation, const std::string& path) {
  const Scene scene = simulation.scene();
  return take(read_inputs(path, {scene.model, *simulation.model()}));
}

using Resumed = std::tuple<Scene, State, std::string>;

Resumed read_resumed(const std::string& path) {
  Checkpoint checkpoint = take(read_checkpoint(path));
  return {take(parse_scene(checkpoint.scene, path)), std::move(checkpoint.state),
          std::move(checkpoint.inputs)};
}

}  // namespace

void bind_simulation(nb::module_& module) {
  module.def("read_checkpoint", &read_resumed, nb::arg("path"), "Scene, state and inputs of a file.");
  nb::class_<InputLog>(module, "InputLog", "The inputs of a run by step.")
      .def_prop_ro(
          "hash", [](const InputLog& log) { return log.hash_text(); }, "16 hexadecimal digits.");
  nb::class_<Simulation>(module, "Simulation", "A scene, a solver and the inputs so far.")
      .def(nb::init<Scene, const std::string&, std::optional<bool>, unsigned>(), nb::arg("scene"),
           nb::arg("backend"), nb::arg("doubles").none(), nb::arg("threads"))
      .def_prop_ro("scene", &Simulation::scene, "As it is simulated.")
      .def_prop_ro("step", &Simulation::step, "Steps since the start.")
      .def_prop_ro(
          "variant", [](const Simulation& s) { return s.backend().variant(); }, "Backend and options.")
      .def_prop_ro(
          "device", [](const Simulation& s) { return s.backend().device; }, "What computes.")
      .def_prop_ro(
          "reason", [](const Simulation& s) { return s.backend().reason; }, "Why auto took it.")
      .def_prop_ro(
          "doubles",
          [](const Simulation& s) { return s.backend().solver->precision() == Precision::double_; },
          "Whether it computes in double precision.")
      .def("state", &Simulation::state, "A copy.")
      .def(
          "load", [](Simulation& s, const State& state, const InputLog* log) { s.load(state, log); },
          nb::arg("state"), nb::arg("log").none(), "Takes over a state, with its inputs.")
      .def("measures", &measures, "Kinetic, elastic, gravitational, momentum, largest speed, lowest height.")
      .def(
          "advance", [](Simulation& s, std::uint64_t steps) { return told(s.advance(steps)); },
          nb::arg("steps"), "Steps; what diverged.")
      .def("compare", &Simulation::compare, nb::arg("other"), nb::arg("steps"),
           "The first step that differs.")
      .def("read_into", &read_into<float>, nb::arg("field"), nb::arg("out").noconvert(),
           "Reads a field; its step.")
      .def("read_into", &read_into<double>, nb::arg("field"), nb::arg("out").noconvert(),
           "Reads a field; its step.")
      .def("view", &view, nb::arg("field"), "A field in the solver's memory; None on a device.")
      .def("masses", &masses, "[kg].")
      .def("pinned", &pinned, "Indices that the scene pins.")
      .def("springs", &springs, "Arrays: ends, stiffness, damping, rest length, type, cord.")
      .def("surface", &surface, nb::arg("body"), "Four corners each.")
      .def("ranges", &ranges, "First particle and count of each body.")
      .def("balls", &balls, "Radius, mass and launch step of each ball.")
      .def("picture", &picture, nb::arg("view"), nb::arg("width"), nb::arg("height"), nb::arg("text"),
           "(height, width, 3).")
      .def("film", &film, nb::arg("path"), nb::arg("steps"), nb::arg("fps").none(), nb::arg("speed"),
           nb::arg("width"), nb::arg("height"), nb::arg("text"), nb::arg("overwrite"), "Steps and films.")
      .def("update", &Simulation::update, nb::arg("overrides"), "Other constants.")
      .def(
          "inputs", [](Simulation& s) { return rows_of(s.inputs()); }, "Pulls, pins, releases, channels.")
      .def(
          "set_inputs", [](Simulation& s, const InputRows& rows) { s.set_inputs(inputs_of_rows(rows)); },
          nb::arg("rows"), "From this step on.")
      .def("log", &Simulation::log, "Of all steps.")
      .def("set_log", &Simulation::set_log, nb::arg("log"), "Replaces it.")
      .def("log_text", &Simulation::log_text, "As TOML.")
      .def("parse_log", &parsed, nb::arg("text"), nb::arg("name"), "A log from TOML.")
      .def("read_log", &read_log, nb::arg("path"), "A log from a file.")
      .def("write_state", &Simulation::write_state, nb::arg("path"), nb::arg("overwrite"),
           "As its ending says.")
      .def("write_checkpoint", &Simulation::write_checkpoint, nb::arg("path"), nb::arg("overwrite"),
           "To be resumed.");
}

}  // namespace aspic::python

#pragma once
// What a simulation and an instance of a batch have in common for Python: both are read and steered alike.
#include <aspic/analysis.h>
#include <aspic/inputs.h>
#include <aspic/model.h>
#include <aspic/solver.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "convert.h"

namespace aspic::python {

/// Step, particle or ball, whether it is a ball, and what happened, in words.
using Diverged = std::optional<std::tuple<std::uint64_t, std::uint32_t, bool, std::string>>;
/// Particle or ball, anchor, stiffness, damping, whether it is a ball.
using PullRow = std::tuple<std::uint32_t, std::tuple<double, double, double>, double, double, bool>;
using Indices = std::vector<std::uint32_t>;
/// Pulls, pinned, released, channels.
using InputRows = std::tuple<std::vector<PullRow>, Indices, Indices, std::vector<double>>;
/// Kinetic, elastic, gravitational, momentum, largest speed, lowest height.
using MeasureRow = std::tuple<double, double, double, std::tuple<double, double, double>, double, double>;
/// Speed, mean strain, force, contact force, contact; strain, tension: in the order of _trajectory.py.
using QuantityArrays = std::tuple<Array<double>, Array<double>, Array<double>, Array<double>,
                                  Array<std::uint8_t>, Array<double>, Array<double>>;
/// Ends, stiffness, damping, rest length, type, whether it is a cord: an array of each.
using SpringArrays = std::tuple<Array<std::uint32_t>, Array<double>, Array<double>, Array<double>,
                                Array<std::uint8_t>, Array<std::uint8_t>>;
/// Of a mesh that is drawn on a body: particles and weights of vertices, vertices of triangles.
using MeshArrays = std::tuple<Array<std::uint32_t>, Array<double>, Array<std::uint32_t>>;

Diverged told(const std::optional<Divergence>& divergence);
InputRows rows_of(const Inputs& inputs);
Inputs inputs_of_rows(const InputRows& rows);
MeasureRow row_of(const Measures& measures);
QuantityArrays arrays_of(StateQuantities quantities);
Array<double> masses(const Model& model);
Array<std::uint32_t> pinned(const Model& model);
SpringArrays springs(const Model& model);
/// Raises IndexError for a body that there is not.
Array<std::uint32_t> surface(const Model& model, std::size_t body);
/// Corners, weights and triangles. Raises IndexError for a body that there is not.
MeshArrays mesh(const Model& model, std::size_t body);
std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges(const Model& model);
std::vector<std::tuple<double, double, std::uint64_t>> balls(const Model& model);

/// Raises IndexError.
void check_field(std::size_t field);

/// Without a conversion, which would fill a copy.
template <class T>
using Place = nb::ndarray<T, nb::shape<-1, 3>, nb::device::cpu>;

template <class T>
StateView view_at(std::size_t field, const Place<T>& array) {
  check_field(field);
  StateView view;
  view[field] = Strided<T>{array.data(), array.shape(0), static_cast<std::ptrdiff_t>(array.stride(0)),
                           static_cast<std::ptrdiff_t>(array.stride(1))};
  return view;
}

/// Binds what class T has by these names.
template <class T>
void bind_reading(nb::class_<T>& bound) {
  bound.def_prop_ro("scene", &T::scene, "As it is simulated.")
      .def_prop_ro("step", &T::step, "Steps since the start.")
      .def_prop_ro("doubles", &T::doubles, "Whether it computes in double precision.")
      .def("state", &T::state, "Return a copy of the state.")
      .def(
          "measures", [](T& t) { return row_of(t.measures()); },
          "Return kinetic, elastic and gravitational energy, momentum, largest speed and lowest height.")
      .def(
          "motion", [](T& t) { return row_of(t.motion()); },
          "Return the measures with an elastic energy of 0, without a pass over springs and contacts.")
      .def("add_work", &T::add_work, nb::arg("work"), "Return the work of actuators so far [J].")
      .def(
          "quantities", [](T& t) { return arrays_of(t.quantities()); },
          "Return speed, mean strain, force, contact force and contact of particles; strain and tension of "
          "springs.")
      .def(
          "read_into",
          [](T& t, std::size_t field, const Place<float>& out) { return t.read_into(view_at(field, out)); },
          nb::arg("field"), nb::arg("out").noconvert(), "Read a field into an array; return its step.")
      .def(
          "read_into",
          [](T& t, std::size_t field, const Place<double>& out) { return t.read_into(view_at(field, out)); },
          nb::arg("field"), nb::arg("out").noconvert(), "Read a field into an array; return its step.")
      .def(
          "masses", [](T& t) { return masses(*t.model()); }, "Return the masses, (n,) [kg].")
      .def(
          "pinned", [](T& t) { return pinned(*t.model()); },
          "Return the indices of particles that the scene pins.")
      .def(
          "springs", [](T& t) { return springs(*t.model()); },
          "Return arrays of springs: ends, stiffness, damping, rest length, type, cord.")
      .def(
          "surface", [](T& t, std::size_t body) { return surface(*t.model(), body); }, nb::arg("body"),
          "Return quads of the surface, (m, 4).")
      .def(
          "mesh", [](T& t, std::size_t body) { return mesh(*t.model(), body); }, nb::arg("body"),
          "Return corners and weights of vertices, and vertices of triangles.")
      .def(
          "ranges", [](T& t) { return ranges(*t.model()); }, "Return first particle and count of each body.")
      .def(
          "input_names", [](T& t) { return input_names(*t.model()); },
          "Return the names of the actuators that read channels.")
      .def(
          "balls", [](T& t) { return balls(*t.model()); },
          "Return radius, mass and launch step of each ball.")
      .def("update", &T::update, nb::arg("overrides"), "Change constants.")
      .def(
          "inputs", [](T& t) { return rows_of(t.inputs()); }, "Return pulls, pins, releases and channels.")
      .def(
          "set_inputs", [](T& t, const InputRows& rows) { t.set_inputs(inputs_of_rows(rows)); },
          nb::arg("rows"), "Set the inputs from this step on.");
}

}  // namespace aspic::python

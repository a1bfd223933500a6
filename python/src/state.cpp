// States, and where two of them differ.
#include <aspic/analysis.h>
#include <aspic/state.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "convert.h"

namespace aspic::python {
namespace {

using Vectors = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;

std::vector<Vec3>& field_of(State& state, std::size_t field) {
  if (field >= state_fields.size()) throw nb::index_error("no such field");
  return state.*state_fields[field].vectors;
}

Array<double> read_field(State& state, std::size_t field) {
  const std::vector<Vec3>& vectors = field_of(state, field);
  std::vector<double> numbers;
  numbers.reserve(3 * vectors.size());
  for (const Vec3& v : vectors) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  return as_array(std::move(numbers), {vectors.size(), 3});
}

void write_field(State& state, std::size_t field, const Vectors& numbers) {
  std::vector<Vec3> vectors;
  vectors.reserve(numbers.shape(0));
  const double limit = state.precision == Precision::single ? std::numeric_limits<float>::max()
                                                            : std::numeric_limits<double>::max();
  for (std::size_t n = 0; n < 3 * numbers.shape(0); ++n)
    if (!(std::abs(numbers.data()[n]) <= limit))
      throw LibraryError({ErrorCode::usage, "the " + std::string(state_fields[field].name) + " of " +
                                                std::to_string(n / 3) + " is not a finite number"});
  for (std::size_t i = 0; i < numbers.shape(0); ++i)
    vectors.push_back({numbers.data()[3 * i], numbers.data()[3 * i + 1], numbers.data()[3 * i + 2]});
  field_of(state, field) = std::move(vectors);
}

/// Quantity, largest difference and where, largest distance in ULP and where.
using QuantityRow = std::tuple<std::string, double, std::uint32_t, std::uint64_t, std::uint32_t>;

std::vector<QuantityRow> compare(const State& a, const State& b) {
  const StateDifference difference = take(compare_states(a, b));
  const QuantityDifference* const parts[] = {&difference.position, &difference.velocity,
                                             &difference.ball_position, &difference.ball_velocity,
                                             &difference.ball_angular_velocity};
  std::vector<QuantityRow> rows;
  for (std::size_t f = 0; f < state_fields.size(); ++f) {
    const QuantityDifference& q = *parts[f];
    rows.emplace_back(state_fields[f].name, q.absolute, q.absolute_index, q.ulp, q.ulp_index);
  }
  return rows;
}

}  // namespace

void bind_state(nb::module_& module) {
  module.def("compare_states", &compare, nb::arg("a"), nb::arg("b"), "Return where two states differ most.");
  nb::class_<State>(module, "State", "Positions and velocities after a number of steps.")
      .def(
          "__init__",
          [](State* place, std::uint64_t step, bool doubles) {
            new (place) State();
            place->step = step;
            place->precision = doubles ? Precision::double_ : Precision::single;
          },
          nb::arg("step"), nb::arg("doubles"))
      .def(
          "copy", [](const State& state) { return state; }, "Return a copy.")
      .def("read", &read_field, nb::arg("field"), "Return a field, (n, 3) of float64.")
      .def("write", &write_field, nb::arg("field"), nb::arg("numbers"), "Replace a field, (n, 3).")
      .def_rw("step", &State::step, "Steps since the start.")
      .def_prop_ro(
          "doubles", [](const State& state) { return state.precision == Precision::double_; },
          "True for states of double precision.")
      .def_prop_ro(
          "hash", [](const State& state) { return state_hash_text(state); },
          "State hash, 16 hexadecimal digits.");
}

}  // namespace aspic::python

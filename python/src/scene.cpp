// Scenes: text, keys and values.
#include <aspic/analysis.h>
#include <aspic/parameters.h>
#include <aspic/run.h>
#include <aspic/scene.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "convert.h"

namespace aspic::python {

nb::object as_object(const ParameterValue& value) {
  return std::visit(
      []<class T>(const T& v) -> nb::object {
        if constexpr (std::is_same_v<T, Vec3>) {
          return nb::make_tuple(v.x, v.y, v.z);
        } else if constexpr (std::is_same_v<T, PinnedSettings>) {
          nb::list all;
          for (const std::string& name : v.names) all.append(name);
          for (const std::int64_t index : v.indices) all.append(index);
          return all;
        } else if constexpr (std::is_same_v<T, std::vector<int>> || std::is_same_v<T, std::vector<double>>) {
          return nb::tuple(nb::cast(v));
        } else {
          return nb::cast(v);
        }
      },
      value);
}

namespace {

using Words = std::vector<std::string>;

/// A scene, and what was repaired in meshes on the way to it.
using Read = std::pair<Scene, Words>;

/// Of what reads a scene with options.
template <class Reading>
Read read(const Reading& reading) {
  Read made;
  made.first = take(reading(LoadOptions{.notes = &made.second}));
  return made;
}

using Text = std::tuple<std::string, std::string, std::string>;

std::vector<Text> builtin_scenes() {
  std::vector<Text> all;
  for (const BuiltinScene& scene : list_builtin_scenes())
    all.emplace_back(scene.name, scene.description, scene.group);
  return all;
}

using Row = std::tuple<std::string, std::string, std::string, std::string, std::string, bool>;

std::vector<Row> rows() {
  std::vector<Row> all;
  for (const ParameterInfo& p : list_parameters())
    all.emplace_back(p.path, p.meaning, p.unit, p.allowed, p.by_default, p.live);
  return all;
}

/// Nothing: every step grows some mode; whether it is exact.
std::tuple<std::optional<double>, bool> stable_step(const Scene& scene, bool thorough) {
  StabilityLimit limit;
  {
    const Unlocked others;
    const SharedModel model = take(make_model(scene.model));
    limit = stability_limit(*model, scene.model.simulation.integrator,
                            thorough ? StabilityEffort::thorough : StabilityEffort::quick);
  }
  return {limit.step, limit.exact};
}

}  // namespace

void bind_scene(nb::module_& module) {
  module.def("builtin_scenes", &builtin_scenes,
             "Return name, description and heading of each built-in scene.");
  module.def("parameters", &rows,
             "Return path, meaning, unit, allowed values, default and live of each key.");
  module.def("backend_words", &backend_words, "Return the names of backends.");
  nb::class_<Scene>(module, "Scene", "An immutable scene of the library.")
      .def_static(
          "load",
          [](const std::string& name, const Words& overrides) {
            return read([&](const LoadOptions& options) { return load_scene(name, overrides, options); });
          },
          nb::arg("name"), nb::arg("overrides"), "Read a file or a built-in scene; return it with notes.")
      .def_static(
          "parse",
          [](const std::string& text, const std::string& name, const Words& overrides) {
            return read(
                [&](const LoadOptions& options) { return parse_scene(text, name, overrides, options); });
          },
          nb::arg("text"), nb::arg("name"), nb::arg("overrides"), "Read TOML; return a scene with notes.")
      .def(
          "with_overrides",
          [](const Scene& scene, const Words& overrides) {
            return read(
                [&](const LoadOptions& options) { return with_overrides(scene, overrides, options); });
          },
          nb::arg("overrides"), "Return the scene with arguments of --set, and notes.")
      .def(
          "with_view", [](const Scene& scene, const Words& keys) { return take(with_view(scene, keys)); },
          nb::arg("arguments"), "Return the scene with arguments of --view.")
      .def(
          "value",
          [](const Scene& scene, const std::string& key) {
            const auto value = take(value_of(scene, key));
            return value ? as_object(*value) : nb::none();
          },
          nb::arg("key"), "Return the value of a key; None where it is absent.")
      .def(
          "keys", [](const Scene& scene) { return list_keys(scene); },
          "Keys that have a meaning in the scene.")
      .def(
          "bodies", [](const Scene& scene) { return body_names(scene.model); }, "Names of the bodies.")
      .def(
          "to_toml", [](const Scene& scene) { return to_toml(scene); }, "A complete scene file.")
      .def("stable_step", &stable_step, nb::arg("thorough"),
           "The largest stable time step [s], and whether it is exact.")
      .def_prop_ro(
          "name", [](const Scene& scene) { return scene.name; }, "Name of the scene.")
      .def_prop_ro(
          "timestep", [](const Scene& scene) { return scene.model.simulation.timestep; }, "Time step h [s].")
      .def_prop_ro(
          "duration", [](const Scene& scene) { return scene.model.simulation.duration; }, "Duration [s].");
}

}  // namespace aspic::python

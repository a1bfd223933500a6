// Rows of [[actuator]].
#include "scene/parameter_rows.h"

namespace aspic {
namespace {

using namespace rows;

Parameter belonging(Belonging when, Parameter p) {
  p.belonging = when;
  return p;
}

/// A word of a table whose values have other names elsewhere.
template <const auto& Table, class Access>
Parameter axis_word(std::string_view path, Access, std::string_view meaning) {
  Parameter p = fixed(Parameter());
  p.path = path;
  p.type = ParameterType::word;
  p.meaning = meaning;
  for (const auto& entry : Table) p.words.push_back(entry.name);
  p.read = [](const Parameter&, const Scene& scene, std::size_t i) -> std::optional<Value> {
    for (const auto& entry : Table)
      if (entry.value == Access{}(scene, i)) return Value(std::string(entry.name));
    return std::nullopt;
  };
  p.write = [](const Parameter&, Scene& scene, std::size_t i, const Value& value) {
    for (const auto& entry : Table)
      if (entry.name == std::get<std::string>(value)) Access{}(scene, i) = entry.value;
  };
  return p;
}

/// A file that takes the place of another key when the scene is read: no scene has the key.
Parameter file_row(std::string_view path, std::string_view meaning) {
  Parameter p = fixed(Parameter());
  p.path = path;
  p.type = ParameterType::text;
  p.when_absent = "none";
  p.meaning = meaning;
  p.read = [](const Parameter&, const Scene&, std::size_t) { return std::optional<Value>(); };
  p.write = [](const Parameter&, Scene&, std::size_t, const Value&) {};
  return p;
}

Rows select_rows() {
  Parameter springs = unless_empty("springs of every type", "actuator[].select.springs",
                                   FIELD(model.actuators[i].select.springs), "Types of springs to act on.");
  springs.type = ParameterType::words;
  springs.words = {"structural", "shear", "bending"};
#define SELECT_BOX(field) FIELD_IN(model.actuators[i].select.box, field)
  Rows box = {
      fixed(row("actuator[].select.box.min", "m", within(far), SELECT_BOX(min),
                "Lower corner of a box around the centers of the cells, in the body's unrotated frame.")),
      fixed(
          row("actuator[].select.box.max", "m", within(far), SELECT_BOX(max), "Upper corner of that box."))};
  box[0].read = [](const Parameter&, const Scene& scene, std::size_t i) -> std::optional<Value> {
    const auto& chosen = scene.model.actuators[i].select.box;
    return chosen ? std::optional<Value>(chosen->min) : std::nullopt;
  };
  box[1].read = [](const Parameter&, const Scene& scene, std::size_t i) -> std::optional<Value> {
    const auto& chosen = scene.model.actuators[i].select.box;
    return chosen ? std::optional<Value>(chosen->max) : std::nullopt;
  };
  // One corner alone leaves the other side open.
  box[0].write = [](const Parameter&, Scene& scene, std::size_t i, const Value& value) {
    auto& chosen = scene.model.actuators[i].select.box;
    if (!chosen) chosen = BoxSettings{{}, {far, far, far}};
    chosen->min = std::get<Vec3>(value);
  };
  box[1].write = [](const Parameter&, Scene& scene, std::size_t i, const Value& value) {
    auto& chosen = scene.model.actuators[i].select.box;
    if (!chosen) chosen = BoxSettings{{-far, -far, -far}, {}};
    chosen->max = std::get<Vec3>(value);
  };
  for (Parameter& p : box) p.when_absent = "without a box";
  return joined(
      {{unless_empty("cells of any", "actuator[].select.material", FIELD(model.actuators[i].select.materials),
                     "Names of the [[material]]s of the cells: one, or an array.")},
       box,
       {unless_empty("all cells", "actuator[].select.voxels", FIELD(model.actuators[i].select.voxels),
                     "Mask of cells, written like `layers` of [[voxels]] or the name of a .npy file of such "
                     "an array: selects non-empty cells."),
        file_row("actuator[].select.file", "The mask as a .npy file; short: `voxels = \"mask.npy\"`."),
        springs}});
}

Rows phase_rows() {
  return {
      row("actuator[].phase.offset", "cycles", within(1e6), FIELD(model.actuators[i].phase.offset),
          "Phase φ of the signal; short: `phase = 0.25`."),
      axis_word<phase_axes>("actuator[].phase.along", FIELD(model.actuators[i].phase.along),
                            "Axis of a phase wave: the phase changes by −x/wavelength, x from the body's "
                            "center in its unrotated frame."),
      belonging(Belonging::wave, row("actuator[].phase.wavelength", "m", within(far),
                                     FIELD(model.actuators[i].phase.wavelength),
                                     "Wavelength; a negative one reverses the wave.")),
      unless_empty("the same in all cells", "actuator[].phase.cells", FIELD(model.actuators[i].phase.cells),
                   "Phase in cycles to add in each cell: \"nx ny nz: …\", ordered by x, y and z."),
      file_row("actuator[].phase.file",
               "These phases as a .npy file, one number per cell; short: `phase = \"phase.npy\"`."),
  };
}

/// Either takes the other's place.
Rows amplitude_rows() {
  Parameter amplitude = belonging(
      Belonging::amplitude, row("actuator[].amplitude", "", within(0.99), FIELD(model.actuators[i].amplitude),
                                "Amplitude a: rest lengths are r₀·(1 + a·w)."));
  amplitude.write = [](const Parameter& p, Scene& scene, std::size_t i, const Value& value) {
    from_value(p, scene.model.actuators[i].amplitude, value);
    scene.model.actuators[i].volume_change.reset();
  };
  return {amplitude,
          absent("amplitude is given",
                 row("actuator[].volume-change", "", {-0.9, 6.8}, FIELD(model.actuators[i].volume_change),
                     "Change of volume v at w = 1, instead of the amplitude: a = (1 + v)^(1/3) − 1, along "
                     "one axis a = v."))};
}

Parameter table_row() {
  return belonging(Belonging::signal_table,
                   row("actuator[].table", "", within(far), FIELD(model.actuators[i].table),
                       "Points [t, w] of the signal `table`, t in periods from 0 on; w is linear between "
                       "points and repeats after the last."));
}

}  // namespace

std::vector<Parameter> actuator_parameters() {
  return joined(
      {{unless_empty("none", "actuator[].name", FIELD(model.actuators[i].name),
                     "Unique name of the actuator."),
        unless_empty("every body of particles", "actuator[].body", FIELD(model.actuators[i].bodies),
                     "Bodies to act on: names, or \"cube[0]\"; one, or an array.")},
       select_rows(),
       {axis_word<actuator_axes>("actuator[].axis", FIELD(model.actuators[i].axis),
                                 "Direction in which cells stretch: all, or an axis of the unrotated body.")},
       amplitude_rows(),
       {word<actuator_signals>(
            "actuator[].signal", FIELD(model.actuators[i].signal),
            "Signal w over time: a function between −1 and 1, a table, or a channel of the inputs."),
        row("actuator[].frequency", "Hz", {0.0, 1e4}, FIELD(model.actuators[i].frequency),
            "Frequency f of the signal."),
        table_row()},
       phase_rows(),
       {row("actuator[].start", "s", {0.0, longest}, FIELD(model.actuators[i].start),
            "Time at which the signal begins; before, w is 0."),
        row("actuator[].ramp", "s", {0.0, longest}, FIELD(model.actuators[i].ramp),
            "Time in which w grows smoothly to its full amplitude.")}});
}

}  // namespace aspic

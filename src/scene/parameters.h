#pragma once
// THE parameter table: every key of a scene file, once. Parser, validator, --set, `scene show`, the window's
// widgets and docs/scene-reference.md are all driven by it.
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "aspic/parameters.h"
#include "aspic/scene.h"
#include "model/pins.h"

namespace aspic {

/// What a key's value looks like in the file.
enum class ParameterType {
  boolean,  ///< bool
  integer,  ///< std::int64_t
  number,   ///< double; whole numbers are accepted too
  text,     ///< std::string, free
  word,     ///< std::string, one of Parameter::words
  words,    ///< std::vector<std::string>, each one of Parameter::words, at most once
  vector,   ///< Vec3; the range holds for each component
  counts,   ///< std::vector<int>, Parameter::components of them; the range holds for each
  numbers,  ///< std::vector<double>, Parameter::components of them; the range holds for each
  pinned,   ///< PinnedSettings: names of sides and corners, local indices
  layers,   ///< CellLayers
  palette,  ///< CellPalette
  names,    ///< std::vector<std::string>, free; in files one string is a list of one
  points    ///< SignalTable; the range holds for each number
};

/// A parameter's value, in the alternative its type names.
using Value = ParameterValue;

inline Value as_value(const GeometryValue& value) {
  return std::visit([](const auto& x) { return Value(x); }, value);
}

/// Legal numbers, both ends included unless said otherwise.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_excluded = false;
};

/// When a key has a meaning. Geometry belongs to the shapes that have the key (terrain_shapes), the keys of a
/// motion to terrain that has one; keys of explicit springs and of a material exclude each other by what the
/// body is made of, a material's numbers and its name by whether it is one of [[material]], and those of
/// equal edges and of a box by how many particles are along its edges. An actuator has an amplitude unless it
/// has a volume change, a wavelength if its phase is that of a wave, a table if that is its signal.
enum class Belonging {
  always,
  geometry,
  motion,
  explicit_springs,
  material,
  material_numbers,
  material_name,
  equal_edges,
  box,
  amplitude,
  wave,
  signal_table
};

/// One key.
struct Parameter {
  std::string_view path;  ///< `simulation.timestep`, `cube[].shear.stiffness`; [] is an index
  ParameterType type = ParameterType::number;
  std::string_view unit;                ///< empty: a pure number or not a number
  Range range;                          ///< integer, number, vector, counts, numbers
  std::size_t components = 3;           ///< vector, counts, numbers: how many there are, 2 or 3
  std::vector<std::string_view> words;  ///< word, words: those allowed; pinned: the sides
  const PinNames* pins = nullptr;       ///< pinned: the names allowed
  Belonging belonging = Belonging::always;
  bool direction = false;        ///< vector: any length but zero
  bool live = true;              ///< may change while the simulation runs, without a restart
  std::string_view when_absent;  ///< what an absent value means; empty: the default is a value
  std::string_view meaning;      ///< one sentence

  /// The table it belongs to, `cube[]`, empty at the top of the file, and its key there, `shear.stiffness`.
  std::string_view section() const {
    return path.substr(0, path.find('.') == std::string_view::npos ? 0 : path.find('.'));
  }
  std::string_view key() const { return path.substr(path.find('.') + 1); }
  /// Whether it leaves the motion as it is: names, and what is drawn.
  bool only_shown() const { return path == "name" || path == "author" || path.starts_with("view."); }
  /// The value in a scene; `index` picks the element of its list (0 for other keys) and must exist. Absent
  /// terrain geometry reads as the shape's default. Nothing if the key is absent or does not apply
  /// (Belonging).
  std::optional<Value> get(const Scene& scene, std::size_t index) const;
  /// Stores a value that check_value passed.
  void set(Scene& scene, std::size_t index, const Value& value) const { write(*this, scene, index, value); }

  /// Whether the key may be absent, and clear() makes it so; for the other keys clear() is illegal.
  bool can_be_absent() const { return erase != nullptr; }
  void clear(Scene& scene, std::size_t index) const { erase(*this, scene, index); }

  std::optional<Value> (*read)(const Parameter&, const Scene&, std::size_t) = nullptr;  ///< for get()
  void (*write)(const Parameter&, Scene&, std::size_t, const Value&) = nullptr;         ///< for set()
  void (*erase)(const Parameter&, Scene&, std::size_t) = nullptr;                       ///< for clear()
};

/// The table, in the order in which files are written.
std::span<const Parameter> parameters();

/// A name that keys had before 0.3, accepted until 0.4.
struct FormerKey {
  std::string_view path;                     ///< `contact.epsilon`
  std::vector<std::string_view> successors;  ///< the keys of the same table that it sets
};
/// The row of a path (with [] for indices), or nullptr.
const FormerKey* find_former_key(std::string_view path);
/// The word of a key; one that it had before 0.3 is accepted until 0.4.
std::string_view present_word(std::string_view path, std::string_view word);

/// The row of a path (with [] for indices), or nullptr. A former name means the first key that it sets.
const Parameter* find_parameter(std::string_view path);

/// The path as messages write it, without brackets: `cube.shear.stiffness`.
std::string key_text(const Parameter& parameter);

/// A path with its index in the brackets: `cube[1].shear.stiffness`.
std::string path_text(std::string_view path, std::size_t index);

/// What a path means to the file format.
enum class PathKind { unknown, parameter, table, list };

/// Kind of a path such as `simulation` (table), `cube` (list), `cube[]` (table), `cube[].shear` (table).
PathKind path_kind(std::string_view path);

/// Names of the keys directly below a table path ("" is the file itself), in table order.
std::vector<std::string_view> child_keys(std::string_view table_path);

/// Whether a key has a meaning in this scene at this index.
bool applies(const Parameter& parameter, const Scene& scene, std::size_t index);

/// Whether terrain of a shape has this key (always true outside `terrain`).
bool belongs_to_shape(const Parameter& parameter, TerrainShape shape);

/// Where the bodies of a section, `cube[]`, have the material that takes the place of masses and springs;
/// nullptr: they have none.
std::optional<MaterialSettings>* material_place(ModelSettings& settings, std::string_view section,
                                                std::size_t index);
/// The material that an element of a section is made of; nullptr: it has springs of its own, or a palette, or
/// the section is of no bodies.
const MaterialSettings* made_of(const ModelSettings& settings, std::string_view section, std::size_t index);

/// How many elements the scene has in the list of an indexed path, 1 for other paths.
std::size_t index_count(const Parameter& parameter, const Scene& scene);

/// Names of the elements of a list whose table has the key `name`, without those that are empty.
std::vector<std::string> element_names(const Scene& scene, std::string_view list);
/// The first element of that name.
std::optional<std::size_t> element_named(const Scene& scene, std::string_view list, std::string_view name);

/// A value that is not allowed.
struct Complaint {
  std::string message;  ///< a sentence that names the key and the values allowed
  /// Of a vector or list, the element to blame; of pinned, names come before indices.
  std::optional<std::size_t> element = {};
};

/// Checks range, finiteness, words and direction of a value of the parameter's type; nothing if it is legal.
std::optional<Complaint> check_value(const Parameter& parameter, const Value& value);

/// What is allowed, in words: `a number > 0 and ≤ 1 s`.
std::string allowed_text(const Parameter& parameter);

/// The default as TOML, or a phrase where it depends on the shape or is absent.
std::string default_text(const Parameter& parameter);

}  // namespace aspic

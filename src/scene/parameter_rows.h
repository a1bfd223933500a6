#pragma once
// How rows of the parameter table are written: a field of the scene, its type and range, one sentence.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <type_traits>
#include <utility>
#include <vector>

#include "model/model.h"
#include "scene/parameters.h"

namespace aspic::rows {

// ---- conversions between a field of the settings and a Value ----

template <class T>
std::optional<Value> to_value(const Parameter&, const T& field) {
  if constexpr (std::is_same_v<T, int>) {
    return Value(std::int64_t{field});
  } else {
    return Value(field);
  }
}
template <class T>
std::optional<Value> to_value(const Parameter&, const std::optional<T>& field) {
  return field ? std::optional<Value>(*field) : std::nullopt;
}
template <class T, std::size_t N>
std::optional<Value> to_value(const Parameter&, const std::optional<std::array<T, N>>& field) {
  return field ? std::optional<Value>(std::vector<T>(field->begin(), field->end())) : std::nullopt;
}
/// The members of a set of words, in the order in which its row names them.
inline std::array<bool DrawSettings::*, 5> members_of(const DrawSettings&) {
  return {&DrawSettings::solid, &DrawSettings::particles, &DrawSettings::structural, &DrawSettings::shear,
          &DrawSettings::bending};
}
inline std::array<bool ArrowSettings::*, 4> members_of(const ArrowSettings&) {
  return {&ArrowSettings::contacts, &ArrowSettings::springs, &ArrowSettings::external, &ArrowSettings::net};
}
template <class T>
inline constexpr bool is_set_of_words = std::is_same_v<T, DrawSettings> || std::is_same_v<T, ArrowSettings>;

template <class T>
requires is_set_of_words<T> std::optional<Value> to_value(const Parameter& p, const T& field) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < p.words.size(); ++i) {
    if (field.*members_of(field)[i]) words.emplace_back(p.words[i]);
  }
  return Value(words);
}

template <class T, std::size_t N>
std::optional<Value> to_value(const Parameter&, const std::array<T, N>& field) {
  return Value(std::vector<T>(field.begin(), field.end()));
}

template <class T>
void from_value(const Parameter&, T& field, const Value& value) {
  if constexpr (std::is_same_v<T, int>) {
    field = static_cast<int>(std::get<std::int64_t>(value));
  } else {
    field = std::get<T>(value);
  }
}
template <class T>
void from_value(const Parameter&, std::optional<T>& field, const Value& value) {
  field = std::get<T>(value);
}
template <class T>
requires is_set_of_words<T>
void from_value(const Parameter& p, T& field, const Value& value) {
  const auto& words = std::get<std::vector<std::string>>(value);
  for (std::size_t i = 0; i < p.words.size(); ++i) {
    field.*members_of(field)[i] = std::find(words.begin(), words.end(), p.words[i]) != words.end();
  }
}

template <class T, std::size_t N>
void from_value(const Parameter&, std::array<T, N>& field, const Value& value) {
  std::ranges::copy(std::get<std::vector<T>>(value), field.begin());
}
template <class T, std::size_t N>
void from_value(const Parameter& p, std::optional<std::array<T, N>>& field, const Value& value) {
  from_value(p, field.emplace(), value);
}

/// Value and name of a table's row; a row may be the enumerator alone.
template <class Row>
constexpr auto value_of(const Row& row) {
  if constexpr (std::is_enum_v<Row>) {
    return row;
  } else {
    return row.value;
  }
}

// ---- rows ----

template <class T, class Field>
inline constexpr bool is_array_of = false;
template <class T, std::size_t N>
inline constexpr bool is_array_of<T, std::array<T, N>> = true;

/// The type a field has in the file.
template <class Field>
constexpr ParameterType type_of() {
  if constexpr (std::is_same_v<Field, bool>) return ParameterType::boolean;
  if constexpr (std::is_same_v<Field, int> || std::is_same_v<Field, std::int64_t>)
    return ParameterType::integer;
  if constexpr (std::is_same_v<Field, std::string>) return ParameterType::text;
  if constexpr (is_set_of_words<Field>) return ParameterType::words;
  if constexpr (std::is_same_v<Field, Vec3>) return ParameterType::vector;
  if constexpr (is_array_of<int, Field>) return ParameterType::counts;
  if constexpr (is_array_of<double, Field>) return ParameterType::numbers;
  if constexpr (std::is_same_v<Field, PinnedSettings>) return ParameterType::pinned;
  if constexpr (std::is_same_v<Field, CellLayers>) return ParameterType::layers;
  if constexpr (std::is_same_v<Field, CellPalette>) return ParameterType::palette;
  if constexpr (std::is_same_v<Field, std::vector<std::string>>) return ParameterType::names;
  if constexpr (std::is_same_v<Field, SignalTable>) return ParameterType::points;
  return ParameterType::number;
}

/// A row whose field `Access` finds in a scene: a stateless generic lambda (scene, index) -> field&.
template <class Access>
Parameter row(std::string_view path, std::string_view unit, const Range& range, Access,
              std::string_view meaning) {
  Parameter p;
  p.path = path;
  p.unit = unit;
  p.range = range;
  p.meaning = meaning;
  p.read = [](const Parameter& self, const Scene& scene, std::size_t index) {
    return to_value(self, Access{}(scene, index));
  };
  p.write = [](const Parameter& self, Scene& scene, std::size_t index, const Value& value) {
    from_value(self, Access{}(scene, index), value);
  };
  using Field = std::remove_cvref_t<decltype(Access{}(std::declval<Scene&>(), std::size_t{}))>;
  if constexpr (requires(Field field) { field.reset(); }) {
    p.type = type_of<typename Field::value_type>();
    p.erase = [](const Parameter&, Scene& scene, std::size_t index) { Access{}(scene, index).reset(); };
  } else {
    p.type = type_of<Field>();
  }
  if constexpr (is_array_of<int, Field> || is_array_of<double, Field>)
    p.components = std::tuple_size_v<Field>;
  return p;
}
template <class Access>
Parameter row(std::string_view path, Access access, std::string_view meaning) {
  return row(path, "", {}, access, meaning);
}

/// One of the values of a table: terrain_shapes, contact_models, …
template <const auto& Table, class Access>
Parameter word(std::string_view path, Access, std::string_view meaning) {
  Parameter p;
  p.path = path;
  p.type = ParameterType::word;
  p.meaning = meaning;
  for (const auto& entry : Table) p.words.push_back(name_of(value_of(entry)));
  p.read = [](const Parameter&, const Scene& scene, std::size_t index) {
    return std::optional<Value>(std::string(name_of(Access{}(scene, index))));
  };
  p.write = [](const Parameter&, Scene& scene, std::size_t index, const Value& value) {
    for (const auto& entry : Table) {
      if (name_of(value_of(entry)) == std::get<std::string>(value)) Access{}(scene, index) = value_of(entry);
    }
  };
  return p;
}

/// Components of at most this size.
constexpr Range within(double largest) {
  return {-largest, largest};
}

inline Parameter direction(Parameter p) {
  p.range = within(1e6);
  p.direction = true;
  return p;
}

inline Parameter fixed(Parameter p) {
  p.live = false;
  return p;
}

using Rows = std::vector<Parameter>;

inline Rows of(Belonging belonging, Rows rows) {
  for (Parameter& p : rows) p.belonging = belonging;
  return rows;
}

/// The rows of several groups, one after the other.
inline Rows joined(std::initializer_list<Rows> groups) {
  Rows all;
  for (const Rows& group : groups) all.insert(all.end(), group.begin(), group.end());
  return all;
}

inline Parameter absent(std::string_view meaning_of_absence, Parameter p) {
  p.when_absent = meaning_of_absence;
  return p;
}

/// A row of a text, list or table whose emptiness is the absence of the key.
template <class Access>
Parameter unless_empty(std::string_view meaning_of_absence, std::string_view path, Access access,
                       std::string_view meaning) {
  Parameter p = fixed(absent(meaning_of_absence, row(path, access, meaning)));
  p.read = [](const Parameter& self, const Scene& scene, std::size_t index) -> std::optional<Value> {
    const auto& field = Access{}(scene, index);
    return field.empty() ? std::nullopt : to_value(self, field);
  };
  return p;
}

// Ends of ranges that a formula does not give keep every product the solvers form far inside single
// precision.
inline constexpr double far = 1e6;        // m
inline constexpr double longest = 1e6;    // s
inline constexpr double stiffest = 1e12;  // N/m, Pa
inline constexpr double heaviest = 1e9;   // kg, kg/m³
inline constexpr Range positive_length = {0.0, far, true};
inline constexpr Range positive_mass = {0.0, heaviest, true};
inline constexpr Range fraction = {0.0, 1.0};
inline constexpr Range friction = {0.0, 1e6};
inline constexpr Range stiffness = {0.0, stiffest};
inline constexpr Range damping = {0.0, 1e9};

// A stateless lambda that finds a field in a const or mutable scene; `i` is the index in its list.
#define FIELD(expression)                                    \
  [](auto& scene, [[maybe_unused]] std::size_t i) -> auto& { \
    return scene.expression;                                 \
  }
// The same of a field in an optional table, which is made where the scene may change.
#define FIELD_IN(table, field)                                                   \
  [](auto& scene, std::size_t i) -> auto& {                                      \
    auto& chosen = scene.table;                                                  \
    if constexpr (!std::is_const_v<std::remove_reference_t<decltype(chosen)>>) { \
      if (!chosen) chosen.emplace();                                             \
    }                                                                            \
    return chosen->field;                                                        \
  }

}  // namespace aspic::rows

namespace aspic {

/// Rows of the table of materials that have names.
std::vector<Parameter> material_parameters();

/// Rows of the tables that describe actuators.
std::vector<Parameter> actuator_parameters();

/// Rows of the tables that describe bodies, kind by kind as in body_rows().
std::vector<Parameter> body_parameters();

}  // namespace aspic

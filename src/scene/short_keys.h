#pragma once
// Short names for commonly varied values: each means one or more keys of the current scene.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"
#include "scene/parameters.h"

namespace aspic {

/// A key that a short name means in a scene.
struct ShortKeyTarget {
  std::string path;     ///< `cube[0].shear.stiffness`
  double factor = 1.0;  ///< its value over that of the first target; 1 where values are no numbers
};

struct ShortKey {
  std::string_view name;     ///< "k"
  std::string_view title;    ///< of axes: "stiffness k"
  std::string_view unit;     ///< empty: a pure number or a word
  std::string_view meaning;  ///< what it sets
  std::vector<ShortKeyTarget> (*targets)(const Scene& scene);
};

/// All short names, in the order of documents.
std::span<const ShortKey> short_keys();
const ShortKey* find_short_key(std::string_view name);

/// KEY=VALUE arguments that set `key`, a short name or a path of the parameter table, in a scene. Of a short
/// name with several targets that are numbers, each keeps its ratio to the first. Error (usage): the scene
/// has nothing that the short name means, a number is needed, or a short name is mistyped.
Result<std::vector<std::string>> assignments(const Scene& scene, std::string_view key,
                                             const std::string& value);

/// A row of the parameter table with the element of its list that a key means.
struct KeyPlace {
  const Parameter* parameter = nullptr;
  std::string_view path = {};  ///< the row's, or a former name of it
  std::size_t index = 0;       ///< 0 for keys of no list; the scene may have no such element
};
/// Of a path such as `cube[1].shear.stiffness`, or of a former name; nothing where the table has no such row.
std::optional<KeyPlace> place_of(std::string_view path);
/// Of a short name's first target; nothing where the scene has none.
std::optional<KeyPlace> place_of(const Scene& scene, const ShortKey& key);

/// The present value of a short name's first target, if it has a number.
std::optional<double> present_value(const Scene& scene, const ShortKey& key);

/// Whether the values of a key, short or a path, are whole numbers.
bool takes_whole_numbers(const Scene& scene, std::string_view key);

}  // namespace aspic

#pragma once
// The table of bodies: what a scene may list, and what the model makes of each element.
#include <cstddef>
#include <span>
#include <string_view>

#include "base/result.h"
#include "model/model.h"

namespace aspic {

/// A list of tables in a scene file, [[key]], and where the settings hold its elements.
struct SettingsList {
  std::string_view key;
  std::size_t (*size)(const ModelSettings&);
  void (*append)(ModelSettings&);  ///< an element with default values
};

/// One kind of body. Model, parser, checks, --set and window iterate the table.
struct BodyRow {
  SettingsList list;
  std::string_view size_key;  ///< key that decides how many particles or balls there are; empty: none does
  ModelCounts (*counts)(const ModelSettings&, std::size_t);
  /// Appends an element to the model. Error (scene_rejected): begins with the key it is about.
  Status (*add)(Model&, const ModelSettings&, std::size_t);
};

/// Every kind of body, in the order in which the model makes them.
std::span<const BodyRow> body_rows();

/// Every list of a scene file: terrain, then the bodies.
std::span<const SettingsList> settings_lists();

}  // namespace aspic

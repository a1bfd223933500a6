#pragma once
// The table of bodies: the kinds that a scene may list, and how the model is built from each.
#include <array>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/result.h"
#include "model/counts.h"
#include "model/model.h"
#include "model/pins.h"

namespace aspic {

/// A list of tables in a scene file, [[key]], and where the settings hold its elements.
struct SettingsList {
  std::string_view key;
  std::size_t (*size)(const ModelSettings&);
  void (*append)(ModelSettings&);               ///< an element with default values
  void (*remove)(ModelSettings&, std::size_t);  ///< one of them, by index
};

/// One kind of body. Model, parser, checks, --set and window iterate the table.
struct BodyRow {
  SettingsList list;
  /// Keys of which one, that which a body has, decides how many particles or balls there are; none: no key
  /// does.
  std::vector<std::string_view> size_keys;
  ModelCounts (*counts)(const ModelSettings&, std::size_t);
  /// Appends an element to the model. Error (scene_rejected): begins with the key it is about.
  Status (*add)(Model&, const ModelSettings&, std::size_t);
  const PinNames* pins = nullptr;  ///< what its key `pinned` may name; null: it has no such key
  const PinnedSettings* (*pinned)(const ModelSettings&, std::size_t) = nullptr;  ///< null where `pins` is
  /// Which of a body's particles such names and indices speak of, by local index; errors as
  /// pinned_particles(). Null where `pins` is.
  Result<std::vector<bool>> (*named)(const PinNames&, const ModelSettings&, std::size_t,
                                     const PinnedSettings&) = nullptr;
};

/// A list that is a vector of the settings.
template <auto Member>
SettingsList settings_list(std::string_view key) {
  return {key, [](const ModelSettings& s) { return (s.*Member).size(); },
          [](ModelSettings& s) { (s.*Member).emplace_back(); },
          [](ModelSettings& s, std::size_t i) {
            (s.*Member).erase((s.*Member).begin() + static_cast<std::ptrdiff_t>(i));
          }};
}

/// The row of bodies in a vector of the settings: `Counts` takes the settings of one and returns its
/// ModelCounts, `Add` takes the model and the settings of one and returns a Status; with all settings before
/// it where the body may be of a named material.
template <auto Member, auto Counts, auto Add>
BodyRow body_row(std::string_view key, std::string_view size_key, const PinNames* pins = nullptr) {
  BodyRow row = {settings_list<Member>(key),
                 size_key.empty() ? std::vector<std::string_view>() : std::vector{size_key},
                 [](const ModelSettings& s, std::size_t i) -> ModelCounts { return Counts((s.*Member)[i]); },
                 [](Model& model, const ModelSettings& s, std::size_t i) -> Status {
                   if constexpr (std::is_invocable_v<decltype(Add), Model&, const ModelSettings&,
                                                     decltype((s.*Member)[i])>)
                     return Add(model, s, (s.*Member)[i]);
                   else
                     return Add(model, (s.*Member)[i]);
                 },
                 pins};
  if constexpr (requires(const ModelSettings& s) { (s.*Member)[0].pinned; }) {
    row.pinned = [](const ModelSettings& s, std::size_t i) { return &(s.*Member)[i].pinned; };
    if constexpr (requires(const ModelSettings& s) { (s.*Member)[0].lattice(); })
      row.named = [](const PinNames& names, const ModelSettings& s, std::size_t i,
                     const PinnedSettings& pinned) {
        return pinned_particles(names, pinned, (s.*Member)[i].lattice());
      };
  }
  return row;
}

/// All of them, in the order of body_lists.
std::span<const BodyRow> body_rows();

/// Every list of a scene file: terrain, materials, the bodies, then actuators.
std::span<const SettingsList> settings_lists();

}  // namespace aspic

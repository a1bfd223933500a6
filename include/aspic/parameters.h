#pragma once
// The keys of a scene file, as --set names them: what there are, what they mean, and their values in a scene.
// They are set by with_overrides().
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "aspic/error.h"
#include "aspic/export.h"
#include "aspic/scene.h"
#include "aspic/settings.h"
#include "aspic/vec.h"

namespace aspic {

/// A key's value: what it is in a file decides the alternative.
using ParameterValue =
    std::variant<bool, std::int64_t, double, std::string, std::vector<std::string>, Vec3, std::vector<int>,
                 std::vector<double>, PinnedSettings, CellLayers, CellPalette, SignalTable>;

/// A row of docs/scene-reference.md.
struct ParameterInfo {
  std::string path;        ///< `simulation.timestep`, `cube[].shear.stiffness`; [] is an index
  std::string meaning;     ///< a sentence
  std::string unit;        ///< empty: a pure number, or no number
  std::string allowed;     ///< in words: `a number > 0 and ≤ 1 s`
  std::string by_default;  ///< a TOML value, or in words
  bool live = false;       ///< may change while a simulation runs (Solver::set_constants())
};
/// Every key, in the order in which files are written.
ASPIC_API std::vector<ParameterInfo> list_parameters();

/// The keys that have a meaning in a scene, each element of its lists by index: `cube[0].shear.stiffness`.
ASPIC_API std::vector<std::string> list_keys(const Scene& scene);

/// The value of a key, a path with an index for each list, or the name of an element that has one
/// (`material[fat].density`). Nothing where the key is absent, or has no meaning
/// in this scene: a material's density for a cube that has none. Error (scene_rejected): an unknown key, with
/// the nearest one; an index that the scene does not have.
ASPIC_API Result<std::optional<ParameterValue>> value_of(const Scene& scene, const std::string& key);

/// The names of the bodies at the indices of particle_ranges(): `cube[0]`, `goal-net[1]`.
ASPIC_API std::vector<std::string> body_names(const ModelSettings& settings);

}  // namespace aspic

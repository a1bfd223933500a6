#pragma once
// A scene: what one TOML file says.
#include <string>

#include "model/settings.h"
#include "scene/view_settings.h"

namespace aspic {

/// Physics and picture of one scene. Default-constructed it has no terrain and no bodies, as an empty file
/// would.
struct Scene {
  std::string name;  ///< for titles and reports; the file's name without extension if the file gives none
  ModelSettings model;
  ViewSettings view;
};

/// Version of the scene file format that this program reads and writes.
inline constexpr int scene_schema = 1;

}  // namespace aspic

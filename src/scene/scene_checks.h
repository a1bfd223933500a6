#pragma once
// Checks that need more than one key.
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/document.h"
#include "scene/scene.h"

namespace aspic::reader {

/// Adds the problems that only the whole scene shows. `root` is the document the scene was read from.
void check_whole_scene(const document::Node& root, const Scene& scene,
                       std::optional<std::uint64_t> memory_bytes, std::vector<document::Problem>& problems);

}  // namespace aspic::reader

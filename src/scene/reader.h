#pragma once
// From document to Scene, along the parameter table.
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/document.h"
#include "scene/scene.h"

namespace aspic::reader {

/// Reads every key of the document into a scene and adds to `problems` whatever is wrong with it: unknown
/// keys, types, ranges, and what only the whole scene shows (keys of another shape, both material and
/// springs, pinned indices, an empty scene, more than `memory_bytes`). The scene is only good if no problem
/// was added.
Scene read(const document::Node& root, std::optional<std::uint64_t> memory_bytes,
           std::vector<document::Problem>& problems);

}  // namespace aspic::reader

#pragma once
// .npy files that keys of a scene name: numbers for the cells of bodies.
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/npy.h"
#include "scene/reader.h"

namespace aspic::reader {

/// An array with an axis each for x, y and z, no longer than bodies may be. Errors: io, scene_rejected.
Result<NpyArray> read_cell_array(const std::string& path);

/// Gives `take` the path of the file that the key `key` names, if one is written and in order: names in the
/// scene's file are relative to its folder. Blames the key for an error, in words that call it `shown`.
void take_named_file(Reader& reader, const std::vector<diagnostics::Source>& sources, const std::string& key,
                     std::string_view shown, const std::function<Status(const std::string&)>& take);

}  // namespace aspic::reader

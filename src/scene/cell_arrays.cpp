#include "scene/cell_arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <variant>

#include "base/files.h"
#include "base/printable.h"
#include "model/voxels.h"

namespace aspic::reader {
namespace {

/// Numpy's array of as many corners as a body may have, of 8 bytes an element.
constexpr std::uint64_t largest_file = 8 * most_lattice_points + 65536;

}  // namespace

Result<NpyArray> read_cell_array(const std::string& path) {
  ASPIC_TRY(auto start, read_regular_file(path, largest_file));
  if (start.size > largest_file)
    return fail(ErrorCode::scene_rejected, "it has {} bytes; allowed: {}", start.size, largest_file);
  ASPIC_TRY(auto array, NpyArray::read(std::move(start.content)));
  const auto& shape = array.shape();
  if (shape.size() != 3)
    return fail(ErrorCode::scene_rejected, "it must be an array with three axes, x, y and z; it has {}",
                shape.size());
  if (std::ranges::max(shape) > static_cast<std::size_t>(most_cells_along))
    return fail(ErrorCode::scene_rejected, "it has {} × {} × {} cells; allowed: {} along each axis", shape[0],
                shape[1], shape[2], most_cells_along);
  return array;
}

void take_named_file(Reader& reader, const std::vector<diagnostics::Source>& sources, const std::string& key,
                     std::string_view shown, const std::function<Status(const std::string&)>& take) {
  const auto written = reader.written().find(key);
  const auto name = reader.cell_sources().find(key);
  if (written == reader.written().end() || written->second.problem || name == reader.cell_sources().end())
    return;
  const bool in_file = written->second.key.source == 0;
  const std::filesystem::path folder =
      in_file ? std::filesystem::path(sources.front().label).parent_path() : std::filesystem::path();
  const auto& file = std::get<std::string>(name->second);
  const Status taken = take((folder / file).string());
  if (taken) return;
  const std::string& what = taken.error().what;
  reader.blame(key, taken.error().code == ErrorCode::io
                        ? fmt::format("'{}': {}", shown, what)
                        : fmt::format("'{}' \"{}\": {}", shown, excerpt(file, 60), what));
}

}  // namespace aspic::reader

// Masks and phases of .npy files as scenes keep them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "base/files.h"
#include "base/npy.h"
#include "base/printable.h"
#include "model/actuators.h"
#include "model/voxels.h"
#include "scene/reader.h"

namespace aspic::reader {
namespace {

constexpr std::uint64_t largest_array = 8 * most_lattice_points + 65536;

Result<NpyArray> read_array(const std::string& path) {
  ASPIC_TRY(auto start, read_regular_file(path, largest_array));
  if (start.size > largest_array)
    return fail(ErrorCode::scene_rejected, "it has {} bytes; allowed: {}", start.size, largest_array);
  ASPIC_TRY(auto array, NpyArray::read(std::move(start.content)));
  if (array.shape().size() != 3)
    return fail(ErrorCode::scene_rejected, "it must be an array with three axes, x, y and z; it has {}",
                array.shape().size());
  if (std::ranges::max(array.shape()) > static_cast<std::size_t>(most_cells_along))
    return fail(ErrorCode::scene_rejected, "it has {} × {} × {} cells; allowed: {} along each axis",
                array.shape()[0], array.shape()[1], array.shape()[2], most_cells_along);
  return array;
}

Status take_phases(const std::string& path, ActuatorSettings& into) {
  ASPIC_TRY(const NpyArray array, read_array(path));
  CellNumbers cells;
  for (std::size_t axis = 0; axis < 3; ++axis) cells.count[axis] = static_cast<int>(array.shape()[axis]);
  for (std::size_t i = 0; i < array.size(); ++i) {
    cells.numbers.push_back(array.number(i));
    if (!std::isfinite(cells.numbers.back()))
      return fail(ErrorCode::scene_rejected, "number {} of it is {}; phases are finite, in cycles", i,
                  cells.numbers.back());
  }
  into.phase.cells = to_cell_text(cells);
  return {};
}

Status take_mask(const std::string& path, ActuatorSettings& into) {
  ASPIC_TRY(const NpyArray array, read_array(path));
  if (!array.whole_numbers())
    return fail(ErrorCode::scene_rejected, "it must be an array of truth values or whole numbers");
  const std::size_t nx = array.shape()[0], ny = array.shape()[1], nz = array.shape()[2];
  into.select.voxels.assign(ny, std::vector<std::string>(nz, std::string(nx, '.')));
  for (std::size_t i = 0; i < array.size(); ++i)
    if (array.whole(i) != 0) into.select.voxels[i / nz % ny][i % nz][i / (ny * nz)] = '1';
  return {};
}

}  // namespace

bool is_actuator_source(std::string_view path) {
  return path == "actuator[].phase.file" || path == "actuator[].select.file";
}

void choose_signals(Reader& reader) {
  for (std::size_t i = 0; i < reader.scene().model.actuators.size(); ++i) {
    const auto table = reader.written().find(path_text("actuator[].table", i));
    const auto signal = reader.written().find(path_text("actuator[].signal", i));
    if (table == reader.written().end()) continue;
    if (signal == reader.written().end() || signal->second.key.source < table->second.key.source)
      reader.scene().model.actuators[i].signal = Signal::table;
  }
}

void read_actuator_files(Reader& reader, const std::vector<diagnostics::Source>& sources) {
  using Take = Status (*)(const std::string&, ActuatorSettings&);
  constexpr std::pair<std::string_view, Take> keys[] = {{"actuator[].phase.file", take_phases},
                                                        {"actuator[].select.file", take_mask}};
  for (std::size_t i = 0; i < reader.scene().model.actuators.size(); ++i) {
    for (const auto& [key, take] : keys) {
      const std::string path = path_text(key, i);
      const auto written = reader.written().find(path);
      const auto name = reader.cell_sources().find(path);
      if (written == reader.written().end() || written->second.problem || name == reader.cell_sources().end())
        continue;
      const bool in_file = written->second.key.source == 0;
      const std::filesystem::path folder =
          in_file ? std::filesystem::path(sources.front().label).parent_path() : std::filesystem::path();
      const auto& file = std::get<std::string>(name->second);
      const Status taken = take((folder / file).string(), reader.scene().model.actuators[i]);
      if (taken) continue;
      const std::string shown = key == keys[0].first ? "actuator.phase" : "actuator.select.voxels";
      const std::string& what = taken.error().what;
      reader.blame(path, taken.error().code == ErrorCode::io
                             ? fmt::format("'{}': {}", shown, what)
                             : fmt::format("'{}' \"{}\": {}", shown, excerpt(file, 60), what));
    }
  }
}

}  // namespace aspic::reader

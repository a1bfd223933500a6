// Masks and phases of .npy files as scenes keep them.
#include <cmath>
#include <string>

#include "model/actuators.h"
#include "scene/cell_arrays.h"

namespace aspic::reader {
namespace {

Status take_phases(const std::string& path, ActuatorSettings& into) {
  ASPIC_TRY(const NpyArray array, read_cell_array(path));
  CellNumbers cells;
  for (std::size_t axis = 0; axis < 3; ++axis) cells.count[axis] = static_cast<int>(array.shape()[axis]);
  for (std::size_t i = 0; i < array.size(); ++i) {
    cells.numbers.push_back(array.number(i));
    if (!std::isfinite(cells.numbers.back()))
      return fail(ErrorCode::scene_rejected, "number {} of it is {}; phases must be finite, in cycles", i,
                  cells.numbers.back());
  }
  into.phase.cells = to_cell_text(cells);
  return {};
}

Status take_mask(const std::string& path, ActuatorSettings& into) {
  ASPIC_TRY(const NpyArray array, read_cell_array(path));
  if (!array.whole_numbers())
    return fail(ErrorCode::scene_rejected, "it must be an array of truth values or integers");
  const std::size_t nx = array.shape()[0], ny = array.shape()[1], nz = array.shape()[2];
  into.select.voxels.assign(ny, std::vector<std::string>(nz, std::string(nx, '.')));
  for (std::size_t i = 0; i < array.size(); ++i)
    if (array.whole(i) != 0) into.select.voxels[i / nz % ny][i % nz][i / (ny * nz)] = '1';
  return {};
}

}  // namespace

void read_actuator_files(Reader& reader, const std::vector<diagnostics::Source>& sources) {
  for (std::size_t i = 0; i < reader.scene().model.actuators.size(); ++i) {
    ActuatorSettings& into = reader.scene().model.actuators[i];
    take_named_file(reader, sources, path_text("actuator[].phase.file", i), "actuator.phase",
                    [&](const std::string& file) { return take_phases(file, into); });
    take_named_file(reader, sources, path_text("actuator[].select.file", i), "actuator.select.voxels",
                    [&](const std::string& file) { return take_mask(file, into); });
  }
}

}  // namespace aspic::reader

#pragma once
// The state as a table: header kind,index,x,y,z,vx,vy,vz,wx,wy,wz, one line per particle, then one
// per ball, each in index order.
#include <string>
#include <string_view>

#include "aspic/state.h"
#include "base/result.h"
#include "io/atomic_file.h"

namespace aspic {

/// The header line, without its line end.
inline constexpr std::string_view state_csv_header = "kind,index,x,y,z,vx,vy,vz,wx,wy,wz";

/// Error (diverged): a number of the state is not finite, so that `path` shall not hold it.
Status check_finite(const State& state, const std::string& path);

/// Writes every particle, then every ball; positions [m], velocities [m/s], angular velocities [rad/s], 0 for
/// particles. A ball that is not launched yet has its start and its launch velocity. Each
/// number is the shortest decimal that reads back to the same bits in the state's own precision. Errors: io
/// from the file; diverged if a value is not finite, before anything is written.
Status write_state_csv(AtomicFile& file, const State& state);

}  // namespace aspic

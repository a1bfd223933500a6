#pragma once
// The state as a table: header kind,index,x,y,z,vx,vy,vz,wx,wy,wz, one line per particle, then one
// per ball, each in index order.
#include <string>
#include <string_view>

#include "base/result.h"
#include "io/atomic_file.h"
#include "model/state.h"

namespace aspic {

/// The header line, without its line end.
inline constexpr std::string_view state_csv_header = "kind,index,x,y,z,vx,vy,vz,wx,wy,wz";

/// Error (diverged): a number of the state is not finite, so that `path` shall not hold it.
Status check_finite(const State& state, const std::string& path);

/// Writes every particle, then every ball; positions [m], velocities [m/s], angular velocities [rad/s], 0 for
/// particles. A ball that is not launched yet stands at its start, with the velocity it will have. Each
/// number is the shortest decimal that reads back to the same bits in the state's own precision. Errors: io
/// from the file; diverged if a value is not finite, before anything is written.
Status write_state_csv(AtomicFile& file, const State& state);

/// Reads what write_state_csv wrote, as `precision`. `name` is for messages. The step number is not in the
/// table: it is 0. Error (io) with the line number: wrong header, wrong number of fields, an index out of
/// order, no number, a number that is not finite or not representable in `precision`.
Result<State> parse_state_csv(std::string_view text, const std::string& name, Precision precision);

/// The same from a file.
Result<State> read_state_csv(const std::string& path, Precision precision);

}  // namespace aspic

#pragma once
// A motion for ParaView: each sample as VTK PolyData, and a collection that says their times.
#include <memory>

#include "io/state_sink.h"

namespace aspic {

/// "run.pvd" names "run-00000040.vtp" and so on. Each file appears complete, the collection with those so
/// far: a run that is killed leaves what can be read. Errors: usage, a device or a pipe; AtomicFile::create.
Result<std::unique_ptr<StateSink>> open_pvd(const std::string& path, std::uint64_t every, Overwrite overwrite,
                                            const RunFacts& facts);

}  // namespace aspic

#pragma once
// A motion for Blender: the shape as Wavefront OBJ, and where its vertices are over time as a point cache
// (PC2).
#include <memory>

#include "io/state_sink.h"

namespace aspic {

/// "run.pc2", with "run.obj" next to it. Samples are equally far apart in time: a last state between two is
/// left out. docs/exports.md describes both files. Errors: usage, a device or a pipe; AtomicFile::create.
Result<std::unique_ptr<StateSink>> open_pc2(const std::string& path, std::uint64_t every, Overwrite overwrite,
                                            const RunFacts& facts);

}  // namespace aspic

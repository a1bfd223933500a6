#pragma once
// A motion as arrays of numpy.
#include <memory>

#include "io/state_sink.h"

namespace aspic {

/// Arrays over time, the sample first, and arrays of the model, `model.…`; docs/exports.md names them. The
/// archive appears with the last sample; on the way the samples lie in a file without a name. Errors: usage,
/// a device or a pipe; AtomicFile::create.
Result<std::unique_ptr<StateSink>> open_npz(const std::string& path, std::uint64_t every, Overwrite overwrite,
                                            const RunFacts& facts);

}  // namespace aspic

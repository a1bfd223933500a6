#pragma once
// A process that draws pictures for a run in another one.
#include "base/result.h"

namespace aspic {

/// Serves the process that started this one (run/drawers.h) until that closes its end: messages come through
/// standard input, answers go to standard output, states and pixels are in the memory behind
/// ChildProcess::shared_descriptor. Errors: io, what was started is no drawer of this program; those of
/// contexts and renderers.
Status serve_pictures();

}  // namespace aspic

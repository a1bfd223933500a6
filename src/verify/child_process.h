#pragma once
// The program as its own child, where a driver setting is read at start alone.
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"

namespace aspic::verify {

/// What `program` prints on stdout with these words and environment variables; its stderr is discarded. Error
/// (io): it cannot be started; check_failed: it ended with another code than 0.
Result<std::string> output_of(const std::string& program, const std::vector<std::string>& words,
                              const std::vector<std::pair<std::string, std::string>>& environment);

}  // namespace aspic::verify

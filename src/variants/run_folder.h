#pragma once
// Results of runs out of their files.
#include <optional>
#include <string>
#include <string_view>

#include "aspic/sweep.h"

namespace aspic {

/// The outcome of that name; nothing if there is none.
std::optional<RunOutcome> outcome_named(std::string_view name);

/// The result in the file of a run. Nothing where the file is damaged, and where the run failed: it may
/// succeed another time.
std::optional<RunRow> row_in(const std::string& file);

}  // namespace aspic

#pragma once
// Names of many files of one run, told apart by the step.
#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"

namespace aspic {

/// "end.csv" with "00000040" for the step: "end-00000040.csv".
std::string numbered(const std::string& path, std::string_view step);
/// The same with the step's number, in eight digits or more.
std::string numbered(const std::string& path, std::uint64_t step);
/// A path with another ending than it has.
std::string with_ending(const std::string& path, std::string_view ending);

/// Files of an earlier run that this one would come to later than `step`, perhaps after hours; `pattern`: the
/// name before it is numbered. Error (io).
Status refuse_later_files(const std::string& pattern, std::uint64_t step);

}  // namespace aspic

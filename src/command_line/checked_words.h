#pragma once
// Words of a command line that are numbers, checked before they are converted.
#include <cstdint>
#include <string>

namespace aspic {

/// Whole numbers that an option takes, both ends included.
struct WholeRange {
  std::uint64_t least = 0, most = 0;
};

/// Whether the text is a whole number of the range, digits alone; if so it is left without leading zeros and
/// the answer is empty. Otherwise a sentence: the parser itself would take `-1` for the largest number there
/// is and 2⁶⁴ for 2⁶⁴ − 1.
std::string check_whole(std::string& text, const WholeRange& range);

/// The name of a file or scene: one that is empty, as of a variable that is not set, would mean none.
std::string check_name(const std::string& text);

/// Whether the text is a number that double precision holds, infinite and NaN included: those are refused
/// where the option's range is known. Otherwise a sentence.
std::string check_number(const std::string& text);

}  // namespace aspic

#pragma once
// Checks on the text of options that are numbers, before it becomes one.
#include <cstdint>
#include <string>

namespace aspic {

/// Largest number of steps: beyond 2⁵³ time, which is step·h in double precision, no longer tells
/// steps apart.
inline constexpr std::uint64_t most_steps = std::uint64_t{1} << 53;

/// Whether the text is a whole number from 0 to `most`, digits alone; if so it is left without leading zeros.
/// Otherwise a sentence: the parser itself would take `-1` for the largest number there is and 2⁶⁴ for 2⁶⁴
/// − 1.
std::string check_whole(std::string& text, std::uint64_t most);

/// Whether the text is a number that double precision holds, infinite and NaN included: those are refused
/// where the option's range is known. Otherwise a sentence.
std::string check_number(std::string& text);

}  // namespace aspic

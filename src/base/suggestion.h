#pragma once
// What was probably meant by a word that nobody knows.
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace aspic::diagnostics {

/// Damerau–Levenshtein distance in its restricted form (optimal string alignment): insertions, deletions,
/// substitutions and swaps of neighbors. Damerau, Communications of the ACM 7 (1964); Levenshtein (1966).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate that was probably meant, or empty: one that differs by a letter; else one that the word
/// shortens, by its beginning, by its initials ("rk4") or to one of its parts; else the nearest, of whose
/// letters at most a third may be wrong. The first wins among equals.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

/// "; did you mean 'x'?" or "" if x is empty.
std::string did_you_mean(std::string_view suggestion);

}  // namespace aspic::diagnostics

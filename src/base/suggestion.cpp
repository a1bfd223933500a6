#include "base/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace aspic::diagnostics {
namespace {

std::vector<std::string_view> parts_of(std::string_view name) {
  std::vector<std::string_view> parts;
  for (std::size_t start = name.find_first_not_of('-'); start < name.size();) {
    const std::size_t end = std::min(name.find('-', start), name.size());
    parts.push_back(name.substr(start, end - start));
    start = name.find_first_not_of('-', end);
  }
  return parts;
}

/// "rk4" of "runge-kutta-4".
bool are_initials(std::string_view word, std::string_view name) {
  const auto parts = parts_of(name);
  return parts.size() > 1 && parts.size() == word.size() &&
         std::ranges::equal(parts, word, {}, [](std::string_view part) { return part.front(); });
}

/// The candidate that a word shortens: the shortest that begins with it, that of which it has the initials,
/// or the only one of whose parts it is one. Empty: none.
std::string_view spelt_out(std::string_view word, std::span<const std::string_view> candidates) {
  constexpr std::size_t least = 3;  // fewer letters begin many words
  std::string_view begun, initials, part;
  bool several = false;
  for (const std::string_view candidate : candidates) {
    if (word.size() >= least && candidate.starts_with(word) &&
        (begun.empty() || candidate.size() < begun.size()))
      begun = candidate;
    if (initials.empty() && are_initials(word, candidate)) initials = candidate;
    const auto parts = parts_of(candidate);
    if (word.size() < least || std::ranges::find(parts, word) == parts.end()) continue;
    several = several || !part.empty();
    part = candidate;
  }
  return !begun.empty() ? begun : !initials.empty() ? initials : several ? std::string_view() : part;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  std::vector<std::size_t> before_last(columns), last(columns), current(columns);
  for (std::size_t j = 0; j < columns; ++j) current[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(current);
    current[0] = i;
    for (std::size_t j = 1; j < columns; ++j) {
      const std::size_t substituted = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({last[j] + 1, current[j - 1] + 1, substituted});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before_last[j - 2] + 1);
      }
    }
  }
  return current[b.size()];
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
  std::string_view best;
  std::size_t best_distance = 0;
  for (const std::string_view candidate : candidates) {
    const std::size_t longer = std::max(word.size(), candidate.size());
    // Nothing longer than any key by so much can be near, and huge keys would cost time.
    if (longer > 100) continue;
    const std::size_t distance = edit_distance(word, candidate);
    if (3 * distance > std::max<std::size_t>(longer, 3)) continue;
    if (best.empty() || distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  if (!best.empty() && best_distance <= 1) return best;
  const std::string_view shortened = spelt_out(word, candidates);
  return shortened.empty() ? best : shortened;
}

std::string did_you_mean(std::string_view suggestion) {
  return suggestion.empty() ? "" : fmt::format("; did you mean '{}'?", suggestion);
}

}  // namespace aspic::diagnostics

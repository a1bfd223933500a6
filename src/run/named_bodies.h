#pragma once
// Names of bodies in sentences.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "scene/follow.h"

namespace aspic {

inline std::vector<std::string> followable_bodies(const ModelSettings& settings) {
  return followable(settings, 0);
}

/// "a; b; c; d; and 3 more"
inline std::string listed(const std::vector<std::string>& parts) {
  constexpr std::size_t most_named = 4;
  std::string text;
  for (std::size_t n = 0; n < std::min(parts.size(), most_named); ++n) text += (n > 0 ? "; " : "") + parts[n];
  if (parts.size() > most_named) text += fmt::format("; and {} more", parts.size() - most_named);
  return text;
}

}  // namespace aspic

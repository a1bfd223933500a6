#pragma once
// Runs of one scene for a comparison, each with one difference, and their names.
#include <cstddef>
#include <string>
#include <vector>

#include "base/result.h"
#include "render/overlay.h"
#include "variants/variant.h"

namespace aspic {

/// KEY=VALUE as a difference. Error (usage): a part is missing.
Result<Difference> parse_difference(const std::string& text);

/// The run of the scene itself, and a variant for each KEY=VALUE, each with that difference alone. Errors:
/// usage, more than most_compared runs, or no KEY=VALUE; those of varied(), which then say which one it is.
Result<std::vector<Variant>> variants_of(const Scene& scene, const BackendChoice& backend,
                                         const std::vector<Difference>& differences);

/// How a run differs from the others: a line for each key that differs in one of them, once.
/// `backend`: what computes this one.
std::vector<OverlayLine> label_of(const std::vector<Difference>& differences, const Scene& scene,
                                  const std::string& backend);

/// What distinguishes run `run` from the others, in few words: "implicit Euler", "h 0.0005 s". Of the first
/// all values that others differ in. `scene` and `backend` are its own; run ≤ differences.size().
std::string short_name(std::size_t run, const std::vector<Difference>& differences, const Scene& scene,
                       const std::string& backend);

/// FILE with a run's number before its ending: `energy-2.csv`.
std::string numbered_path(const std::string& path, std::size_t number);

}  // namespace aspic

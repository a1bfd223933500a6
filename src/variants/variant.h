#pragma once
// A run that differs from another in some values: of its scene, or in its backend.
#include <span>
#include <string>
#include <string_view>

#include "aspic/scene.h"
#include "aspic/sweep.h"
#include "base/result.h"
#include "run/backends.h"

namespace aspic {

/// The key of a difference that names a backend, with its options: "gpu:per-spring".
inline constexpr std::string_view backend_key = "backend";

/// A run's scene and backend.
struct Variant {
  Scene scene;
  BackendChoice backend;
};

/// A scene and a backend with differences applied. Errors: those of assignments(), of with_overrides() and of
/// the backend's name and options.
Result<Variant> varied(const Scene& scene, const BackendChoice& backend,
                       std::span<const Difference> differences);

/// The name of a key in a frame: "integrator", "time step h", "cube[1].shear.stiffness".
std::string title_of(std::string_view key);
/// The value that a key has in a run, for people, with its unit: "implicit Euler", "2000 N/m". A dash where
/// it has none. `backend`: what computes the run, for backend_key.
std::string value_of(std::string_view key, const Scene& scene, std::string_view backend);

}  // namespace aspic

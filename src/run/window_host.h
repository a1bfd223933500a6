#pragma once
// Context and state of a solver on a device, as windows, rendering and reports share them.
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "gpu/canary.h"
#include "gpu/context.h"
#include "gpu_solver/gpu_solver.h"
#include "run/backends.h"

namespace aspic {

/// What a solver may use of its surroundings; nothing is required.
struct SolverHost {
  /// Where a backend that needs a context works, which others may use too; as make_gpu_solver(), its solver
  /// keeps it alive where a shared_ptr holds it. Null: a headless one of its own.
  gl::Context* context = nullptr;
  /// A solver on the same context to share buffers with, see GpuOptions::share_springs_of.
  const GpuSolver* share_springs_of = nullptr;
  /// What the canary found on that context's device before; absent: it is asked again.
  std::optional<gl::Arithmetic> arithmetic;
};

/// Whether `auto` takes a backend on this machine.
struct Suitability {
  bool suits = false;
  std::string reason;  ///< why or why not, as the end of a sentence; empty: there is nothing to say
  std::string detail;  ///< what was tried; may be empty
  std::shared_ptr<gl::Context> context;  ///< the context found on the way, current; null without
};

/// What `auto` takes, and why.
struct AutomaticChoice {
  const BackendRow* row = nullptr;
  std::string reason;                    ///< why, as the end of a sentence
  std::string detail;                    ///< what was tried on the way; may be empty
  std::shared_ptr<gl::Context> context;  ///< the context found, current; null without
};
/// The first row of the table that has what the choice asks for and suits; `window` as for
/// BackendRow::suitability. The choice has passed check_choice().
AutomaticChoice choose_automatically(const BackendChoice& choice, const gl::Context* window = nullptr);

/// Makes the solver of a choice, `auto` included, at the model's initial state. Errors: as check_choice and
/// BackendRow::make.
Result<Backend> make_backend(const BackendChoice& choice, SharedModel model, const SolverHost& host);
inline Result<Backend> make_backend(const BackendChoice& choice, Model model, const SolverHost& host) {
  return make_backend(choice, shared(std::move(model)), host);
}

/// The solver, where its state lies on a device: for drawing without a copy. Null: it lies in memory.
GpuSolver* gpu_of(const Backend& backend);
/// Where that solver works; null with gpu_of().
gl::Context* context_of(const Backend& backend);

/// Where frames of a backend's states are rendered.
struct FrameContext {
  gl::Context* context = nullptr;              ///< never null
  std::shared_ptr<gl::Context> own = nullptr;  ///< keeps it alive; null: the solver does
};
/// The solver's own context, or else a new headless one. Error (no_device).
Result<FrameContext> frame_context(const Backend& backend);

}  // namespace aspic

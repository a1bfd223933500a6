#pragma once
// The one place that knows every backend by name.
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "gpu/context.h"
#include "gpu_solver/gpu_solver.h"
#include "model/solver.h"

namespace aspic {

enum class BackendKind { automatic, gpu, cpu, reference };

/// What the user asked for.
struct BackendChoice {
  BackendKind kind = BackendKind::automatic;
  Precision precision = Precision::single;      ///< double: reference only
  ForcePath force_path = ForcePath::automatic;  ///< gpu only
};

/// A solver with what it needs to live and what a report says of it.
struct Backend {
  std::unique_ptr<gl::Context> context;  ///< null unless gpu; goes after the solver
  std::unique_ptr<Solver> solver;
  std::string name;        ///< "gpu", "reference"
  std::string device;      ///< GL_RENDERER, or what the solver says of itself
  std::string force_path;  ///< "gather", …; empty unless gpu
  std::string reason;      ///< why `auto` took it; empty if it was named
};

/// What `auto` would take and why.
struct AutomaticChoice {
  BackendKind kind = BackendKind::reference;
  std::string reason;                    ///< why, as the end of a sentence
  std::string detail;                    ///< what was tried on the way; may be empty
  std::unique_ptr<gl::Context> context;  ///< the hardware context found, current; null without
};
AutomaticChoice choose_automatically(const BackendChoice& choice);

/// Words of --backend, --precision and --force-path. Error (usage): an unknown word, with those allowed.
Result<BackendKind> parse_backend_kind(std::string_view word);
Result<Precision> parse_precision(std::string_view word);
Result<ForcePath> parse_force_path(std::string_view word);

/// A backend with its options after colons: "gpu:per-spring", "reference:double". Errors as above.
Result<BackendChoice> parse_backend(std::string_view text);

/// Finds choices that no machine could satisfy, before any work: double precision on a gpu, a force path
/// without gpu (usage); what is not built yet (scene_rejected).
Status check_choice(const BackendChoice& choice);

/// The directory in the environment variable ASPIC_SHADER_DIR, whose shaders go before the embedded ones;
/// empty if it is not set. Error (io): it names no directory.
Result<std::filesystem::path> shader_directory();

/// Makes the solver at the model's initial state; the model must outlive it. Errors: as check_choice;
/// no_device.
Result<Backend> make_backend(const BackendChoice& choice, const Model& model);

/// Bytes a model of these counts needs, backend by backend.
struct BackendBytes {
  std::string backend;
  std::uint64_t bytes = 0;
};
std::vector<BackendBytes> bytes_by_backend(const Model& model);

}  // namespace aspic

#pragma once
// The table of backends: everything that any program asks of one is in its row.
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "aspic/solver.h"
#include "base/result.h"
#include "gpu/context.h"
#include "gpu_solver/gpu_solver.h"

namespace aspic {

struct BackendRow;

/// What the user asked for.
struct BackendChoice {
  const BackendRow* row = nullptr;              ///< null: auto
  Precision precision = Precision::single;      ///< one that the row has
  ForcePath force_path = ForcePath::automatic;  ///< one that the row has, or automatic
  Arithmetic arithmetic = Arithmetic::exact;    ///< fast: only if the row has it
  unsigned threads = 0;  ///< 1 to 1024, only if the row takes a number; 0: as many as pay

  friend bool operator==(const BackendChoice&, const BackendChoice&) = default;
};

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

/// A solver with what a report says of it. The solver holds what it needs, so that all of this may be moved,
/// assigned and destroyed in any order.
struct Backend {
  const BackendRow* row = nullptr;
  std::shared_ptr<gl::Context> context;  ///< the solver's own; null if none or given
  std::unique_ptr<Solver> solver;
  GpuSolver* gpu = nullptr;  ///< the solver, where its state lies on a device: for drawing without a copy
  std::string device;        ///< GL_RENDERER, or what the solver says of itself
  std::string force_path;    ///< "gather", …; empty if the backend has none
  Arithmetic arithmetic = Arithmetic::exact;
  std::string reason;  ///< why `auto` took it; empty if it was named

  /// "gpu:gather", "cpu:fast", "reference:double", "reference".
  std::string variant() const;
};

/// Whether `auto` takes a backend on this machine.
struct Suitability {
  bool suits = false;
  std::string reason;  ///< why or why not, as the end of a sentence; empty: there is nothing to say
  std::string detail;  ///< what was tried; may be empty
  std::shared_ptr<gl::Context> context;  ///< the context found on the way, current; null without
};

/// A backend.
struct BackendRow {
  std::string_view name;     ///< word of --backend and of reports: "gpu"
  std::string_view title;    ///< in a sentence and on a button: "Switch to GPU"
  std::string_view summary;  ///< what it is, in a line
  std::span<const Precision> precisions;
  std::span<const ForcePathRow> (*paths)();  ///< force paths that can be chosen; null: it has no such choice
  bool needs_context = false;                ///< it computes in an OpenGL context, on that context's thread
  /// Makes the solver at the model's initial state. The choice has passed check_choice(). Errors: no_device,
  /// scene_rejected, io.
  Result<Backend> (*make)(SharedModel model, const BackendChoice& choice, const SolverHost& host) = nullptr;
  /// Bytes that its solver holds for a model; nothing if there is no such memory. May make the solver to
  /// know.
  std::optional<std::uint64_t> (*bytes)(const Model& model, const BackendChoice& choice) = nullptr;
  /// Whether `auto` takes it: in the window's context, or, if that is null, wherever it finds a device.
  Suitability (*suitability)(const gl::Context* window) = nullptr;
  bool fast = false;      ///< it has fast arithmetic
  bool threaded = false;  ///< its number of threads can be chosen

  std::span<const ForcePathRow> force_paths() const {
    return paths ? paths() : std::span<const ForcePathRow>();
  }
};

/// All backends, in the order in which `auto` tries them. The last is the reference, which runs everywhere
/// and against which the others are measured.
std::span<const BackendRow> backends();
inline const BackendRow& reference_backend() {
  return backends().back();
}
/// The row of that name; null if there is none.
const BackendRow* find_backend(std::string_view name);
/// The row after it in the table, the first after the last or a row of no table.
const BackendRow& next_backend(const BackendRow& row);
/// Every word of --backend: "auto, gpu, reference".
std::string backend_words();

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

/// Words of --backend (null: auto), --precision, --force-path and --arithmetic. Error (usage): an unknown
/// word, with those allowed.
Result<const BackendRow*> parse_backend_name(std::string_view word);
Result<Precision> parse_precision(std::string_view word);
Result<ForcePath> parse_force_path(std::string_view word);
Result<Arithmetic> parse_arithmetic(std::string_view word);

/// What the row has of `asked`, with this row; all of it for auto (null).
BackendChoice choice_for(const BackendRow* row, const BackendChoice& asked);

/// A backend with its options after colons: "gpu:per-spring", "reference:double", "cpu:fast". What the text
/// leaves open is as choice_for() has it. Errors as above.
Result<BackendChoice> parse_backend(std::string_view text, const BackendChoice& asked = {});

/// Finds choices that no machine could satisfy, before any work: a precision, a force path, an arithmetic or
/// a number of threads that the backend does not have (usage); what is not built yet (scene_rejected).
Status check_choice(const BackendChoice& choice);

/// The directory in the environment variable ASPIC_SHADER_DIR, whose shaders go before the embedded ones;
/// empty if it is not set. Error (io): it names no directory.
Result<std::filesystem::path> shader_directory();

/// Makes the solver of a choice, `auto` included, at the model's initial state. Errors: as check_choice and
/// BackendRow::make.
Result<Backend> make_backend(const BackendChoice& choice, SharedModel model, const SolverHost& host = {});
/// With a model of its own: a copy, or what is moved here.
inline Result<Backend> make_backend(const BackendChoice& choice, Model model, const SolverHost& host = {}) {
  return make_backend(choice, shared(std::move(model)), host);
}

/// Bytes that a backend in one of its variants holds for a model.
struct BackendBytes {
  std::string backend;                 ///< "gpu:gather"
  std::optional<std::uint64_t> bytes;  ///< its solver; absent: there is no such memory
};
std::vector<BackendBytes> bytes_by_backend(const Model& model);

}  // namespace aspic

#pragma once
// The table of backends: everything that any program asks of one is in its row.
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "aspic/run.h"
#include "gpu_solver/force_paths.h"

namespace aspic {

/// What a solver may use of its surroundings, and whether `auto` takes a backend: run/window_host.h.
struct SolverHost;
struct Suitability;
namespace gl {
class Context;
}

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
/// The first that needs no OpenGL context: it takes over where a device is lost.
const BackendRow& contextless_backend();
/// The row of that name; null if there is none.
const BackendRow* find_backend(std::string_view name);
/// The row after it in the table, the first after the last or a row of no table.
const BackendRow& next_backend(const BackendRow& row);

/// Words of --backend (null: auto), --precision, --force-path and --arithmetic. Error (usage): an unknown
/// word, with those allowed.
Result<const BackendRow*> parse_backend_name(std::string_view word);
Result<Precision> parse_precision(std::string_view word);
Result<ForcePath> parse_force_path(std::string_view word);
Result<Arithmetic> parse_arithmetic(std::string_view word);

/// What the row has of `asked`, with this row; all of it for auto (null).
BackendChoice choice_for(const BackendRow* row, const BackendChoice& asked);

/// A choice but for its threads as parse_backend() takes it: "auto", "gpu:gather", "reference:double".
std::string words_of(const BackendChoice& choice);

/// Finds choices that no machine could satisfy, before any work: a precision, a force path, an arithmetic or
/// a number of threads that the backend does not have (usage); what is not built yet (scene_rejected).
Status check_choice(const BackendChoice& choice);

/// With a model of its own: a copy, or what is moved here.
inline Result<Backend> make_backend(const BackendChoice& choice, Model model) {
  return make_backend(choice, shared(std::move(model)));
}

/// Bytes that a backend in one of its variants holds for a model.
struct BackendBytes {
  std::string backend;                 ///< "gpu:gather"
  std::optional<std::uint64_t> bytes;  ///< its solver; absent: there is no such memory
};
std::vector<BackendBytes> bytes_by_backend(const Model& model);

}  // namespace aspic

#include "run/backends.h"

#include <fmt/format.h>

#include <cstdlib>

#include "cpu_reference/reference_solver.h"

namespace aspic {
namespace {

Error unknown_word(std::string_view what, std::string_view word, std::string_view allowed) {
  return {ErrorCode::usage, fmt::format("unknown {} \"{}\"; allowed: {}.", what, word, allowed)};
}

Error not_built(std::string_view what, std::string_view instead) {
  return {ErrorCode::scene_rejected, fmt::format("{} is not built yet; use {}.", what, instead)};
}

Result<Backend> make_gpu(std::unique_ptr<gl::Context> context, const BackendChoice& choice,
                         const Model& model) {
  if (!context) {
    auto made = gl::Context::create_headless();
    if (!made) return made.error();
    context = std::move(*made);
  }
  GpuOptions options;
  options.force_path = choice.force_path;
  auto directory = shader_directory();
  if (!directory) return directory.error();
  options.shader_directory = std::move(*directory);
  auto solver = make_gpu_solver(*context, model, options);
  if (!solver) return solver.error();
  Backend backend;
  backend.name = "gpu";
  backend.device = context->info().renderer;
  backend.force_path = name_of((*solver)->force_path());
  backend.context = std::move(context);
  backend.solver = std::move(*solver);
  return backend;
}

Result<Backend> make_reference(const BackendChoice& choice, const Model& model) {
  auto solver = make_reference_solver(model, choice.precision);
  if (!solver) return solver.error();
  Backend backend;
  backend.name = "reference";
  backend.device = (*solver)->description();
  backend.solver = std::move(*solver);
  return backend;
}

}  // namespace

Result<std::filesystem::path> shader_directory() {
  const char* value = std::getenv("ASPIC_SHADER_DIR");
  if (!value || !*value) return std::filesystem::path();
  std::error_code ignored;
  if (!std::filesystem::is_directory(value, ignored)) {
    return Error{
        ErrorCode::io,
        fmt::format("ASPIC_SHADER_DIR names {}, which is no directory: name one laid out as shaders/ "
                    "of the sources, or unset it.",
                    value)};
  }
  return std::filesystem::path(value);
}

AutomaticChoice choose_automatically(const BackendChoice& choice) {
  if (choice.precision == Precision::double_) {
    return {BackendKind::reference, "only the reference computes in double precision", "", nullptr};
  }
  gl::ContextOptions options;
  options.device = gl::DeviceChoice::hardware;
  auto context = gl::Context::create_headless(options);
  if (!context) {
    return {BackendKind::reference, "no hardware GPU with OpenGL 4.3 was found", context.error().message,
            nullptr};
  }
  const gl::DeviceInfo& info = (*context)->info();
  if (info.is_software) {
    return {BackendKind::reference,
            fmt::format("{} is a software rasteriser, which is used only when asked for with --backend gpu",
                        info.renderer),
            "", nullptr};
  }
  std::string reason = fmt::format("{} is a hardware GPU with OpenGL 4.3 compute", info.renderer);
  return {BackendKind::gpu, std::move(reason), "", std::move(*context)};
}

Result<BackendKind> parse_backend_kind(std::string_view word) {
  if (word == "auto") return BackendKind::automatic;
  if (word == "gpu") return BackendKind::gpu;
  if (word == "cpu") return BackendKind::cpu;
  if (word == "reference") return BackendKind::reference;
  return unknown_word("backend", word, "auto, gpu, cpu, reference");
}

Result<Precision> parse_precision(std::string_view word) {
  if (word == "single") return Precision::single;
  if (word == "double") return Precision::double_;
  return unknown_word("precision", word, "single, double");
}

Result<ForcePath> parse_force_path(std::string_view word) {
  if (word == "auto") return ForcePath::automatic;
  for (const ForcePath path : {ForcePath::per_spring, ForcePath::gather, ForcePath::lattice}) {
    if (word == name_of(path)) return path;
  }
  return unknown_word("force path", word, "auto, per-spring, gather, lattice");
}

Result<BackendChoice> parse_backend(std::string_view text) {
  BackendChoice choice;
  const std::size_t colon = text.find(':');
  const auto kind = parse_backend_kind(text.substr(0, colon));
  if (!kind) return kind.error();
  choice.kind = *kind;
  while (text.find(':') != std::string_view::npos) {
    text.remove_prefix(text.find(':') + 1);
    const std::string_view word = text.substr(0, text.find(':'));
    if (const auto precision = parse_precision(word)) {
      choice.precision = *precision;
    } else if (const auto path = parse_force_path(word)) {
      choice.force_path = *path;
    } else {
      return unknown_word("backend option", word, "single, double, auto, per-spring, gather, lattice");
    }
  }
  return choice;
}

Status check_choice(const BackendChoice& choice) {
  if (choice.kind == BackendKind::cpu) return not_built("the cpu backend", "reference or gpu");
  if (choice.force_path == ForcePath::lattice)
    return not_built("the force path lattice", "gather or per-spring");
  if (choice.precision == Precision::double_ && choice.kind == BackendKind::gpu) {
    return Error{ErrorCode::usage,
                 "the gpu computes in single precision; for double say --backend reference."};
  }
  const bool gpu_possible = choice.kind == BackendKind::gpu ||
                            (choice.kind == BackendKind::automatic && choice.precision == Precision::single);
  if (choice.force_path != ForcePath::automatic && !gpu_possible) {
    return Error{ErrorCode::usage,
                 "a force path belongs to the gpu backend; leave it out or say --backend gpu."};
  }
  return {};
}

Result<Backend> make_backend(const BackendChoice& choice, const Model& model) {
  if (const Status possible = check_choice(choice); !possible) return possible.error();
  if (choice.kind == BackendKind::gpu) return make_gpu(nullptr, choice, model);
  if (choice.kind == BackendKind::reference) return make_reference(choice, model);

  AutomaticChoice automatic = choose_automatically(choice);
  if (automatic.kind == BackendKind::reference && choice.force_path != ForcePath::automatic) {
    return Error{ErrorCode::no_device,
                 fmt::format("the force path {} needs the gpu backend, but {}. Say --backend gpu to take "
                             "any device there is.",
                             name_of(choice.force_path), automatic.reason)};
  }
  auto backend = automatic.kind == BackendKind::gpu ? make_gpu(std::move(automatic.context), choice, model)
                                                    : make_reference(choice, model);
  if (backend) backend->reason = std::move(automatic.reason);
  return backend;
}

std::vector<BackendBytes> bytes_by_backend(const Model& model) {
  const ModelCounts counts = count(model);
  const Integrator integrator = model.simulation.integrator;
  return {{"reference", reference_bytes(counts, Precision::single)},
          {"reference:double", reference_bytes(counts, Precision::double_)},
          {"gpu:gather", gpu_bytes(counts, integrator, ForcePath::gather)},
          {"gpu:per-spring", gpu_bytes(counts, integrator, ForcePath::per_spring)}};
}

}  // namespace aspic

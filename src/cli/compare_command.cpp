#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "aspic/scene.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "io/program.h"
#include "model/inputs.h"
#include "run/lockstep.h"
#include "run/window_host.h"

namespace aspic::cli {
namespace {

/// How a quantity is reported, in the order of compared_quantities.
struct Quantity {
  std::string_view key, name, unit, body;
};
constexpr std::array<Quantity, compared_quantities.size()> quantities = {{
    {"position", "position", "m", "particle"},
    {"velocity", "velocity", "m/s", "particle"},
    {"ball_position", "ball x", "m", "ball"},
    {"ball_velocity", "ball v", "m/s", "ball"},
    {"ball_angular_velocity", "ball ω", "rad/s", "ball"},
}};

Json json_of(const WorstDifference& worst, std::string_view body) {
  return {{"largest_absolute", worst.absolute},
          {fmt::format("largest_absolute_{}", body), worst.absolute_index},
          {"largest_absolute_step", worst.absolute_step},
          {"largest_ulp", worst.ulp},
          {fmt::format("largest_ulp_{}", body), worst.ulp_index},
          {"largest_ulp_step", worst.ulp_step}};
}

/// What the canary found on a device whose arithmetic is not that of IEEE 754; empty elsewhere.
std::string inexact_arithmetic(const Backend& backend) {
  const GpuSolver* const gpu = gpu_of(backend);
  if (!gpu || gpu->arithmetic().exact()) return "";
  return fmt::format(
      "{}: single operations are off by up to {} ULP; run aspic verify --only equality to see whether that "
      "explains a difference",
      backend.variant(), gpu->arithmetic().worst_ulps());
}

Json json_of(const CompareOptions& options, const Scene& scene, const std::array<Backend, 2>& backends,
             const LockstepResult& result, bool within) {
  Json json = {{"scene", scene.name},
               {"integrator", name_of(scene.model.simulation.integrator)},
               {"steps", result.steps},
               {"tolerance", options.tolerance},
               {"within_tolerance", within},
               {"identical", !result.first_difference},
               {"first_differing_step", or_null(result.first_difference)}};
  for (std::size_t i = 0; i < result.worst.size(); ++i)
    json[std::string(quantities[i].key)] = json_of(result.worst[i], quantities[i].body);
  json["interrupted"] = result.interrupted;
  for (std::size_t i = 0; i < backends.size(); ++i) {
    const std::optional<Divergence>& divergence = result.divergence[i];
    const GpuSolver* const gpu = gpu_of(backends[i]);
    json["backends"].push_back({{"backend", backends[i].variant()},
                                {"device", backends[i].device},
                                {"state_hash", result.hash[i]},
                                {"operation_ulps", gpu ? Json(gpu->arithmetic().worst_ulps()) : Json(0)},
                                {"diverged_in_step", divergence ? Json(divergence->step) : Json()}});
  }
  return json;
}

Status print_result(const CompareOptions& options, const Scene& scene, const std::array<Backend, 2>& backends,
                    const LockstepResult& result, bool within) {
  if (options.json) return print_data(to_text(json_of(options, scene, backends, result, within)));
  std::string text = fmt::format("scene       {}, {}, {} steps compared\n", scene.name,
                                 name_of(scene.model.simulation.integrator), result.steps);
  for (std::size_t i = 0; i < backends.size(); ++i) {
    text += fmt::format("{:<11} {}  {}\n", backends[i].variant(), result.hash[i], backends[i].device);
  }
  for (std::size_t i = 0; i < result.worst.size(); ++i) {
    const auto& [key, name, unit, body] = quantities[i];
    const WorstDifference& w = result.worst[i];
    if (body == "ball" && backends[0].solver->model().ball_count() == 0) continue;
    if (w.absolute == 0.0 && w.ulp == 0) {
      text += fmt::format("{:<11} identical in every step\n", name);
    } else {
      text += fmt::format("{:<11} largest difference {:.6g} {} ({} {}, step {}), {} ULP ({} {}, step {})\n",
                          name, w.absolute, unit, body, w.absolute_index, w.absolute_step, w.ulp, body,
                          w.ulp_index, w.ulp_step);
    }
  }
  for (const Backend& backend : backends)
    if (const std::string note = inexact_arithmetic(backend); !note.empty()) text += note + "\n";
  text += result.first_difference ? fmt::format("first differing step {}\n", *result.first_difference)
                                  : "no step differs\n";
  text += fmt::format("{}: tolerance {}\n", within ? "within" : "EXCEEDED", options.tolerance);
  return print_text(text);
}

}  // namespace

Status execute(const CompareOptions& options) {
  const InterruptGuard interrupt;
  ASPIC_TRY(const auto scene, load_scene(options.scene, options.overrides, by_set));
  ASPIC_TRY(const auto steps, steps_of(options.length, scene.model.simulation));
  ASPIC_TRY(auto built, build_model(scene.model));
  const SharedModel model = shared(std::move(built));

  std::array<Backend, 2> backends;
  for (std::size_t i = 0; i < backends.size(); ++i) {
    // Solvers on a device work in one context, where their buffers have names of their own.
    SolverHost host;
    host.context = context_of(backends[0]);
    ASPIC_TRY(backends[i], make_backend(i == 0 ? options.first : options.second, model, host));
  }
  InputLog inputs;
  if (!options.replay_file.empty()) {
    ASPIC_TRY(inputs, read_inputs(options.replay_file, {scene.model, *model}));
    for (const Backend& backend : backends)
      ASPIC_CHECK(check_log(*model, inputs, backend.solver->precision()));
  }
  const auto compare = [&] {
    ProgressBar bar(steps);
    const auto go_on = [&](std::uint64_t done) {
      bar.update(done);
      return !interrupt.interrupted();
    };
    return compare_in_lockstep(*backends[0].solver, *backends[1].solver, steps, go_on, inputs);
  };
  ASPIC_TRY(const auto result, compare());
  const bool within =
      options.tolerance == 0.0 ? !result.first_difference : result.largest_absolute() <= options.tolerance;
  ASPIC_CHECK(print_result(options, scene, backends, result, within));
  if (result.interrupted) {
    return fail(ErrorCode::interrupted, "interrupted at step {} of {}.", result.steps, steps);
  }
  const auto& [first, second] = result.divergence;
  if (first && second && first->step == second->step) {
    return fail(ErrorCode::diverged, "both diverged in step {} ({} and {}).", first->step, body_text(*first),
                body_text(*second));
  }
  if (first || second) {
    return fail(ErrorCode::diverged, "only {} diverged, in step {} ({}).", backends[first ? 0 : 1].variant(),
                (first ? *first : *second).step, body_text(first ? *first : *second));
  }
  if (!within) {
    return fail(ErrorCode::check_failed, "{} and {} differ by more than the tolerance {}.",
                backends[0].variant(), backends[1].variant(), options.tolerance);
  }
  return {};
}

}  // namespace aspic::cli

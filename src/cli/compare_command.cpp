#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "analysis/compare.h"
#include "cli/commands.h"
#include "cli/json.h"
#include "io/program.h"
#include "scene/load.h"

namespace aspic::cli {
namespace {

/// What is compared, as it is reported.
struct Quantity {
  std::string_view key, name, unit, body;
  QuantityDifference StateDifference::*difference;
};
constexpr Quantity quantities[] = {
    {"position", "position", "m", "particle", &StateDifference::position},
    {"velocity", "velocity", "m/s", "particle", &StateDifference::velocity},
    {"ball_position", "ball x", "m", "ball", &StateDifference::ball_position},
    {"ball_velocity", "ball v", "m/s", "ball", &StateDifference::ball_velocity},
    {"ball_angular_velocity", "ball ω", "rad/s", "ball", &StateDifference::ball_angular_velocity},
};

/// The largest difference of a quantity over all steps compared.
struct Worst : QuantityDifference {
  std::uint64_t absolute_step = 0, ulp_step = 0;

  void take(const QuantityDifference& d, std::uint64_t step) {
    if (d.absolute > absolute) {
      absolute = d.absolute;
      absolute_index = d.absolute_index;
      absolute_step = step;
    }
    if (d.ulp > ulp) {
      ulp = d.ulp;
      ulp_index = d.ulp_index;
      ulp_step = step;
    }
  }
};

struct Comparison {
  std::uint64_t steps = 0;  ///< compared
  std::array<Worst, std::size(quantities)> worst;
  std::optional<std::uint64_t> first_difference;
  std::array<std::string, 2> hash;
  std::array<std::optional<Divergence>, 2> divergence;
  bool interrupted = false;

  double largest_absolute() const { return std::ranges::max_element(worst, {}, &Worst::absolute)->absolute; }
};

Result<Comparison> compare_steps(std::array<Backend, 2>& backends, std::uint64_t steps,
                                 const InterruptGuard& interrupt) {
  Comparison result;
  ProgressBar bar(steps);
  for (std::uint64_t step = 0;; ++step) {
    ASPIC_TRY(auto first, backends[0].solver->state());
    ASPIC_TRY(const auto second, backends[1].solver->state());
    ASPIC_TRY(const auto difference, compare_states(first, second));
    // States of two precisions with equal single-precision values still differ where a number does.
    if (!result.first_difference && (!difference.identical() || difference.largest_absolute() > 0.0)) {
      result.first_difference = step;
    }
    for (std::size_t i = 0; i < result.worst.size(); ++i)
      result.worst[i].take(difference.*quantities[i].difference, step);
    result.hash = {state_hash_text(first), state_hash_text(second)};
    result.steps = step;
    result.interrupted = interrupt.interrupted();
    if (step == steps || result.interrupted) return result;

    for (std::size_t i = 0; i < backends.size(); ++i) {
      ASPIC_TRY(result.divergence[i], backends[i].solver->advance(1));
    }
    if (result.divergence[0] || result.divergence[1]) return result;
    bar.update(step + 1);
  }
}

Json to_json(const Worst& worst, std::string_view body) {
  return {{"largest_absolute", worst.absolute},
          {fmt::format("largest_absolute_{}", body), worst.absolute_index},
          {"largest_absolute_step", worst.absolute_step},
          {"largest_ulp", worst.ulp},
          {fmt::format("largest_ulp_{}", body), worst.ulp_index},
          {"largest_ulp_step", worst.ulp_step}};
}

/// What the canary found on a device whose arithmetic is not that of IEEE 754; empty elsewhere.
std::string inexact_arithmetic(const Backend& backend) {
  if (!backend.gpu || backend.gpu->arithmetic().exact()) return "";
  return fmt::format(
      "{}: single operations are off by up to {} ULP; aspic verify --only equality tells whether that "
      "explains a "
      "difference",
      backend.variant(), backend.gpu->arithmetic().worst_ulps());
}

Json to_json(const CompareOptions& options, const Scene& scene, const std::array<Backend, 2>& backends,
             const Comparison& result, bool within) {
  Json json = {{"scene", scene.name},
               {"integrator", name_of(scene.model.simulation.integrator)},
               {"steps", result.steps},
               {"tolerance", options.tolerance},
               {"within_tolerance", within},
               {"identical", !result.first_difference},
               {"first_differing_step", or_null(result.first_difference)}};
  for (std::size_t i = 0; i < result.worst.size(); ++i)
    json[std::string(quantities[i].key)] = to_json(result.worst[i], quantities[i].body);
  json["interrupted"] = result.interrupted;
  for (std::size_t i = 0; i < backends.size(); ++i) {
    const std::optional<Divergence>& divergence = result.divergence[i];
    json["backends"].push_back(
        {{"backend", backends[i].variant()},
         {"device", backends[i].device},
         {"state_hash", result.hash[i]},
         {"operation_ulps", backends[i].gpu ? Json(backends[i].gpu->arithmetic().worst_ulps()) : Json(0)},
         {"diverged_in_step", divergence ? Json(divergence->step) : Json()}});
  }
  return json;
}

Status print_result(const CompareOptions& options, const Scene& scene, const std::array<Backend, 2>& backends,
                    const Comparison& result, bool within) {
  if (options.json) return print_data(to_text(to_json(options, scene, backends, result, within)));
  std::string text = fmt::format("scene       {}, {}, {} steps compared\n", scene.name,
                                 name_of(scene.model.simulation.integrator), result.steps);
  for (std::size_t i = 0; i < backends.size(); ++i) {
    text += fmt::format("{:<11} {}  {}\n", backends[i].variant(), result.hash[i], backends[i].device);
  }
  for (std::size_t i = 0; i < result.worst.size(); ++i) {
    const auto& [key, name, unit, body, difference] = quantities[i];
    const Worst& w = result.worst[i];
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
  ASPIC_TRY(const auto scene, load_scene(options.scene, options.overrides));
  ASPIC_TRY(const auto steps, steps_of(options.length, scene.model.simulation));
  ASPIC_TRY(const auto model, build_model(scene.model));

  std::array<Backend, 2> backends;
  for (std::size_t i = 0; i < backends.size(); ++i) {
    // Solvers on a device work in one context, where their buffers have names of their own.
    SolverHost host;
    host.context = backends[0].context.get();
    ASPIC_TRY(backends[i], make_backend(i == 0 ? options.first : options.second, model, host));
  }
  ASPIC_TRY(const auto result, compare_steps(backends, steps, interrupt));
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
    return fail(ErrorCode::diverged, "{} alone diverged, in step {} ({}).", backends[first ? 0 : 1].variant(),
                (first ? *first : *second).step, body_text(first ? *first : *second));
  }
  if (!within) {
    return fail(ErrorCode::check_failed, "{} and {} differ by more than the tolerance {}.",
                backends[0].variant(), backends[1].variant(), options.tolerance);
  }
  return {};
}

}  // namespace aspic::cli

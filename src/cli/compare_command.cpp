#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "analysis/compare.h"
#include "cli/commands.h"
#include "cli/json_report.h"
#include "io/console.h"
#include "io/interrupt.h"
#include "scene/load.h"

namespace aspic::cli {
namespace {

/// The largest difference of a quantity over all steps compared.
struct Worst {
  QuantityDifference difference;
  std::uint64_t absolute_step = 0, ulp_step = 0;

  void take(const QuantityDifference& d, std::uint64_t step) {
    if (d.absolute > difference.absolute) {
      difference.absolute = d.absolute;
      difference.absolute_index = d.absolute_index;
      absolute_step = step;
    }
    if (d.ulp > difference.ulp) {
      difference.ulp = d.ulp;
      difference.ulp_index = d.ulp_index;
      ulp_step = step;
    }
  }
};

struct Comparison {
  std::uint64_t steps = 0;  ///< compared
  Worst position, velocity, ball_position, ball_velocity, ball_angular_velocity;
  std::optional<std::uint64_t> first_difference;
  std::array<std::string, 2> hash;
  std::array<std::optional<Divergence>, 2> divergence;
  bool interrupted = false;

  double largest_absolute() const {
    return std::max({position.difference.absolute, velocity.difference.absolute,
                     ball_position.difference.absolute, ball_velocity.difference.absolute,
                     ball_angular_velocity.difference.absolute});
  }
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
    result.position.take(difference.position, step);
    result.velocity.take(difference.velocity, step);
    result.ball_position.take(difference.ball_position, step);
    result.ball_velocity.take(difference.ball_velocity, step);
    result.ball_angular_velocity.take(difference.ball_angular_velocity, step);
    result.hash = {state_hash_text(first), state_hash_text(second)};
    result.steps = step;
    result.interrupted = interrupt.interrupted();
    if (step == steps || result.interrupted) return result;

    for (std::size_t i = 0; i < backends.size(); ++i) {
      ASPIC_TRY(const auto advanced, backends[i].solver->advance(1));
      result.divergence[i] = advanced;
    }
    if (result.divergence[0] || result.divergence[1]) return result;
    bar.update(step + 1);
  }
}

/// `body` is "particle" or "ball".
JsonObject to_json_object(const Worst& worst, const std::string& body) {
  return {{"largest_absolute", worst.difference.absolute},
          {"largest_absolute_" + body, worst.difference.absolute_index},
          {"largest_absolute_step", worst.absolute_step},
          {"largest_ulp", worst.difference.ulp},
          {"largest_ulp_" + body, worst.difference.ulp_index},
          {"largest_ulp_step", worst.ulp_step}};
}

Status print_result(const CompareOptions& options, const Scene& scene, const std::array<Backend, 2>& backends,
                    const Comparison& result, bool within) {
  if (options.json) {
    JsonArray sides;
    for (std::size_t i = 0; i < backends.size(); ++i) {
      sides.emplace_back(JsonObject{
          {"backend", backends[i].variant()},
          {"device", backends[i].device},
          {"state_hash", result.hash[i]},
          {"diverged_in_step", result.divergence[i] ? JsonValue(result.divergence[i]->step) : JsonValue()}});
    }
    return print_data(
        to_json({{"scene", scene.name},
                 {"integrator", name_of(scene.model.simulation.integrator)},
                 {"steps", result.steps},
                 {"tolerance", options.tolerance},
                 {"within_tolerance", within},
                 {"identical", !result.first_difference},
                 {"first_differing_step",
                  result.first_difference ? JsonValue(*result.first_difference) : JsonValue()},
                 {"position", to_json_object(result.position, "particle")},
                 {"velocity", to_json_object(result.velocity, "particle")},
                 {"ball_position", to_json_object(result.ball_position, "ball")},
                 {"ball_velocity", to_json_object(result.ball_velocity, "ball")},
                 {"ball_angular_velocity", to_json_object(result.ball_angular_velocity, "ball")},
                 {"interrupted", result.interrupted},
                 {"backends", sides}}));
  }
  std::string text = fmt::format("scene       {}, {}, {} steps compared\n", scene.name,
                                 name_of(scene.model.simulation.integrator), result.steps);
  for (std::size_t i = 0; i < backends.size(); ++i) {
    text += fmt::format("{:<11} {}  {}\n", backends[i].variant(), result.hash[i], backends[i].device);
  }
  const auto line = [](std::string_view name, std::string_view unit, const Worst& w,
                       std::string_view body = "particle") {
    const QuantityDifference& d = w.difference;
    if (d.absolute == 0.0 && d.ulp == 0) return fmt::format("{:<11} identical in every step\n", name);
    return fmt::format("{:<11} largest difference {:.6g} {} ({} {}, step {}), {} ULP ({} {}, step {})\n",
                       name, d.absolute, unit, body, d.absolute_index, w.absolute_step, d.ulp, body,
                       d.ulp_index, w.ulp_step);
  };
  text += line("position", "m", result.position) + line("velocity", "m/s", result.velocity);
  if (backends[0].solver->model().ball_count() > 0) {
    text += line("ball x", "m", result.ball_position, "ball") +
            line("ball v", "m/s", result.ball_velocity, "ball") +
            line("ball ω", "rad/s", result.ball_angular_velocity, "ball");
  }
  text += result.first_difference ? fmt::format("first differing step {}\n", *result.first_difference)
                                  : "no step differs\n";
  text += fmt::format("{}: tolerance {}\n", within ? "within" : "EXCEEDED", options.tolerance);
  return print_text(text);
}

}  // namespace

Status compare_command(const CompareOptions& options) {
  const InterruptGuard interrupt;
  ASPIC_TRY(const auto scene, load_scene(options.scene, options.overrides));
  ASPIC_TRY(const auto steps, steps_of(options.length, scene.model.simulation));
  ASPIC_TRY(const auto model, build_model(scene.model));

  std::array<Backend, 2> backends;
  for (std::size_t i = 0; i < backends.size(); ++i) {
    BackendChoice choice = i == 0 ? options.first : options.second;
    ASPIC_TRY(auto backend, make_backend(choice, model));
    backends[i] = std::move(backend);
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

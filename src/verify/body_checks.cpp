// Every kind of body with its default values: what it is made of, and the same bits on every backend.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/bodies.h"
#include "model/springs.h"
#include "verify/experiments.h"

namespace aspic::verify {
namespace {

constexpr std::uint64_t body_steps = 200, few_body_steps = 10;
const GpuOptions one_variant[1];

ModelSettings settings_of(const BodyRow& body) {
  ModelSettings settings;
  body.list.append(settings);
  return settings;
}

/// One body whose lowest particles are half of ε below a plane, so that contact acts at once.
Result<Model> on_ground(const BodyRow& body, Integrator integrator) {
  ModelSettings settings = settings_of(body);
  settings.simulation.integrator = integrator;
  if (row_of(integrator).traits.stable_at_any_step) settings.simulation.timestep = 0.01;
  ASPIC_TRY(auto airborne, build_model(settings));
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& x : airborne.initial_position) lowest = std::min(lowest, x.y);
  settings.terrain.emplace_back().geometry["point"] =
      Vec3{0.0, lowest + 0.5 * settings.contact.distance, 0.0};
  return build_model(settings);
}

/// Counts by closed form, and springs as long as they rest: in units of what rounding positions leaves.
Result<Finding> made_as_said(const BodyRow& body) {
  const ModelSettings settings = settings_of(body);
  ASPIC_TRY(auto model, build_model(settings));
  ModelCounts said = predict_counts(settings), made = count(model);
  const bool counted = said.particles == made.particles && said.structural == made.structural &&
                       said.shear == made.shear && said.bending == made.bending;
  double extent = 0.0, worst = 0.0;
  for (const Vec3& x : model.initial_position) extent = std::max(extent, length(x));
  for (const Spring& s : springs_of(model)) {
    const double now = length(model.initial_position[s.a] - model.initial_position[s.b]);
    worst = std::max(worst, std::abs(now - model.spring_classes[s.spring_class].rest_length));
  }
  const double share = worst / (8.0 * epsilon_double * extent);
  return Finding{counted && share <= 1.0, fmt::format("{:.2g} of {} springs{}", share, made.springs(),
                                                      counted ? "" : ", wrong counts")};
}

Result<Finding> same_bits(const Subject& subject, const BackendRow& backend, const BodyRow& body) {
  BitComparison comparison(subject, backend);
  for (const Integrator integrator : all_integrators) {
    ASPIC_TRY(auto model, on_ground(body, integrator));
    const std::uint64_t steps = row_of(integrator).traits.long_steps ? few_body_steps : body_steps;
    ASPIC_CHECK(comparison.add(
        model, [&](Solver& solver) { return run(solver, steps); }, one_variant));
  }
  return comparison.finding();
}

}  // namespace

void add_body_checks(std::vector<Check>& checks) {
  for (const BodyRow& body : body_rows()) {
    if (predict_counts(settings_of(body)).particles == 0) continue;
    checks.push_back({fmt::format("body/{}/made", body.list.key),
                      fmt::format("{}: counts by closed form; springs' lengths at the start less their rest "
                                  "lengths, over 8ε·max|x|",
                                  body.list.key),
                      "≤ 1", true, false, [&body](const Subject&) { return made_as_said(body); }});
    for (const BackendRow& backend : backends().first(backends().size() - 1)) {
      checks.push_back(
          {fmt::format("body/{}/{}", body.list.key, backend.name),
           fmt::format("{}: every integrator ends with the reference's bits on the {}, in contact, {} steps, "
                       "{} of implicit-euler",
                       body.list.key, backend.name, body_steps, few_body_steps),
           backend.needs_context ? "0 ULP, or the canary's finding on hardware" : "0 ULP", true,
           backend.needs_context, [&](const Subject& subject) { return same_bits(subject, backend, body); }});
    }
  }
}

}  // namespace aspic::verify

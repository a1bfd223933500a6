#include "verify/experiments.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "aspic/analysis.h"
#include "model/incident_springs.h"
#include "model/integrator.h"
#include "model/terrain.h"

namespace aspic::verify {

ModelSettings cube_settings(int particles_per_edge, const Vec3& center) {
  ModelSettings settings;
  CubeSettings cube;
  cube.particles_per_edge = particles_per_edge;
  cube.position = center;
  settings.cubes.push_back(cube);
  return settings;
}

ModelSettings cube_on_terrain(int particles_per_edge, TerrainShape shape, Integrator integrator,
                              ContactModel contact) {
  ModelSettings settings = cube_settings(particles_per_edge, terrain_row(shape).drop);
  settings.cubes[0].rotation = {{1.0, 0.3, 0.7}, 25.0};
  settings.cubes[0].velocity = {1.0, -1.0, 0.5};
  settings.simulation.integrator = integrator;
  settings.contact.model = contact;
  if (row_of(integrator).traits.stable_at_any_step) settings.simulation.timestep = 0.01;
  settings.terrain.push_back({.shape = shape});
  return settings;
}

Model loose_particles(std::vector<Vec3> positions, const std::vector<Vec3>& velocities, double mass) {
  Model model;
  model.initial_position = std::move(positions);
  model.initial_velocity = velocities;
  model.mass.assign(model.initial_position.size(), mass);
  model.inverse_mass.assign(model.initial_position.size(), 1.0 / mass);
  return model;
}

State shaken(const Model& model, double shift, double speed, std::uint64_t seed) {
  State state = initial_state(model, Precision::double_);
  Noise noise(seed);
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    state.position[i] = state.position[i] + shift * noise.vector();
    state.velocity[i] = speed * noise.vector();
  }
  return state;
}

Terrain plane_through_origin(const Model& model, const Vec3& normal) {
  TerrainSettings settings;
  settings.geometry["point"] = Vec3{0, 0, 0};
  settings.geometry["normal"] = normal;
  return make_terrain(settings, model.contact);
}

double deepest(const Model& model, const State& state) {
  double depth = -std::numeric_limits<double>::infinity();
  for (const Terrain& terrain : model.terrain) {
    for (const Vec3& x : state.position) depth = std::max(depth, -signed_distance(terrain, x));
  }
  return depth;
}

double usual_step(Integrator integrator) {
  return row_of(integrator).traits.nominal_step;
}

std::uint64_t steps_of(const Model& model, double duration) {
  return static_cast<std::uint64_t>(std::lround(duration / model.simulation.timestep));
}

Status require_good(const Result<Advance>& advanced) {
  if (!advanced) return advanced.error();
  if (!advanced->divergence) return {};
  return fail(ErrorCode::check_failed, "diverged in step {} at particle {}", advanced->divergence->step,
              advanced->divergence->particle);
}

Result<State> run(Solver& solver, std::uint64_t steps, const State* start) {
  if (start != nullptr) ASPIC_CHECK(solver.load(*start));
  ASPIC_CHECK(require_good(solver.advance(steps)));
  return solver.state();
}

Result<State> run_reference(const Subject& subject, const Model& model, Precision precision,
                            std::uint64_t steps, const State* start) {
  ASPIC_TRY(auto solver, subject.reference(model, precision));
  return run(*solver, steps, start);
}

Status BitComparison::add(const Model& model, const std::function<Result<State>(Solver&)>& run,
                          std::span<const GpuOptions> variants) {
  ASPIC_TRY(auto reference, subject_.reference(model, Precision::single));
  ASPIC_TRY(const auto expected, run(*reference));
  for (const GpuOptions& options : row_.needs_context ? variants : variants.first(1)) {
    std::unique_ptr<Solver> solver;
    GpuSolver* on_device = nullptr;
    if (row_.needs_context) {
      ASPIC_TRY(auto gpu, subject_.gpu(model, options));
      on_device = gpu.get();
      arithmetic_ = fmt::format("{}", fmt::join(gpu->arithmetic().sentences(), " "));
      solver = std::move(gpu);
    } else {
      ASPIC_TRY(solver, subject_.other(model, {&row_}));
    }
    ASPIC_TRY(const auto end, run(*solver));
    ASPIC_TRY(const auto difference, compare_states(end, expected));
    ulp_ = std::max(ulp_, difference.largest_ulp());
    absolute_ = std::max(absolute_, difference.largest_absolute());
    ++runs_;
    if (difference.identical()) continue;
    if (on_device) {
      ASPIC_CHECK(bound(model, *on_device, expected.step));
    } else {
      share_ = std::numeric_limits<double>::infinity();
    }
  }
  return {};
}

/// Of a run of so many steps that differs, on a device.
Status BitComparison::bound(const Model& model, GpuSolver& gpu, std::uint64_t steps) {
  const gl::Arithmetic& arithmetic = gpu.arithmetic();
  if (arithmetic.exact() && arithmetic.device.denormals_flushed()) {
    share_ = std::numeric_limits<double>::infinity();
    return {};
  }
  constexpr std::uint64_t samples = 16;
  ASPIC_TRY(auto single, subject_.reference(model, Precision::single));
  ASPIC_TRY(auto precise, subject_.reference(model, Precision::double_));
  const double evaluations = std::max(1, force_evaluations_per_step(model.simulation.integrator)),
               forces = std::max(1.0, highest_degree(model) * evaluations),
               factor = 1.0 + 2.0 * arithmetic.worst_ulps() * std::sqrt(forces);
  std::array<StepBound, samples> found;
  State start = initial_state(model, Precision::single);
  for (StepBound& step : found) {
    ASPIC_TRY(const auto end, verify::run(*single, 1, &start));
    ASPIC_TRY(const auto exact_end, verify::run(*precise, 1, &start));
    ASPIC_TRY(const auto device_end, verify::run(gpu, 1, &start));
    ASPIC_TRY(const auto rounded_off, compare_states(end, exact_end));
    ASPIC_TRY(const auto off, compare_states(device_end, end));
    double scale = 0.0;
    for (const auto* list : {&end.position, &end.velocity})
      for (const Vec3& v : *list) scale = std::max({scale, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    const double unit = std::exp2(std::floor(std::log2(scale)) - 23);
    step.off = off.largest_absolute() / unit;
    step.allowed = factor * rounded_off.largest_absolute() / unit;
    ASPIC_TRY(start, verify::run(*single, std::max<std::uint64_t>(steps / samples, 1), &start));
  }
  // The median: where contact begins or ends, one rounding decides, and a step may differ by anything.
  std::ranges::nth_element(found, found.begin() + samples / 2, {}, &StepBound::share);
  const StepBound& typical = found[samples / 2];
  if (typical.share() > share_ || step_.allowed == 0.0) step_ = typical;
  share_ = std::max(share_, typical.share());
  return {};
}

Finding BitComparison::finding() const {
  const std::string text = fmt::format("{} ULP in {} runs", ulp_, runs_);
  if (same()) return {true, text};
  if (!std::isfinite(share_))
    return {false,
            fmt::format("{}, {:.3g} in meters and m/s, for which the device's arithmetic is no reason. {}",
                        text, absolute_, arithmetic_)};
  return {share_ <= 1.0, fmt::format("single steps {:.3g} ULP of the largest component, {:.3g} allowed; {}, "
                                     "{:.3g} in meters and m/s. {}",
                                     step_.off, step_.allowed, text, absolute_, arithmetic_)};
}

}  // namespace aspic::verify

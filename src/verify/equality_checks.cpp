// The device against the reference: the same bits, however often and in whatever groups.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "aspic/scene.h"
#include "io/child_process.h"
#include "model/terrain.h"
#include "verify/experiments.h"
#include "verify/textbook.h"

namespace aspic::verify {
namespace {

constexpr std::uint64_t most_steps = 2000, few_steps = 60, repeat_steps = 500;

/// The force paths of a backend that are worth comparing with an integrator.
std::vector<GpuOptions> paths_of(const BackendRow& row, Integrator integrator) {
  std::vector<GpuOptions> paths;
  for (const ForcePathRow& path : row.force_paths())
    if (works_with(path.path, integrator)) paths.emplace_back().force_path = path.path;
  if (paths.empty()) paths.emplace_back();
  return paths;
}

Result<Finding> same_bits(const Subject& subject, const BackendRow& row, Integrator integrator) {
  const bool long_steps = row_of(integrator).traits.long_steps;
  BitComparison comparison(subject, row);
  // The last round is on ground that moves.
  for (std::size_t round = 0; round <= std::size(terrain_shapes); ++round) {
    const bool moves = round == std::size(terrain_shapes);
    for (const ContactModel contact : both_contact_models) {
      const TerrainShape shape = terrain_shapes[moves ? 0 : round].value;
      ModelSettings settings = cube_on_terrain(long_steps ? 4 : 5, shape, integrator, contact);
      if (moves) settings.terrain[0].motion = TerrainMotion{{0.3, 1.0, 0.2}, 0.2, 1.1, 0.2};
      ASPIC_TRY(auto model, build_model(settings));
      const auto steps = [&](Solver& solver) { return run(solver, long_steps ? few_steps : most_steps); };
      ASPIC_CHECK(comparison.add(model, steps, paths_of(row, integrator)));
    }
  }
  return comparison.finding();
}

/// A hand that takes a corner, moves, changes to a particle inside and lets go, each for a quarter of the
/// run.
Result<State> run_with_hand(Solver& solver, std::uint64_t steps) {
  const std::uint32_t last = solver.model().particle_count() - 1;
  const std::optional<Pull> inputs[] = {Pull{last, {4.0, 5.0, 2.0}, 900.0, 20.0},
                                        Pull{last, {4.0, 2.0, -3.0}, 900.0, 20.0},
                                        Pull{last / 2, {-2.0, 4.0, 1.0 / 3.0}, 1e4 / 3.0, 0.0}, std::nullopt};
  for (const std::optional<Pull>& pull : inputs) {
    ASPIC_CHECK(solver.set_inputs(inputs_of(pull)));
    ASPIC_CHECK(require_good(solver.advance(steps / 4)));
  }
  return solver.state();
}

Result<Finding> same_bits_with_hand(const Subject& subject, const BackendRow& row) {
  BitComparison comparison(subject, row);
  for (const Integrator integrator : all_integrators) {
    const std::uint64_t steps = row_of(integrator).traits.long_steps ? few_steps : repeat_steps;
    for (const ContactModel contact : both_contact_models) {
      ASPIC_TRY(auto model, build_model(cube_on_terrain(4, TerrainShape::plane, integrator, contact)));
      const auto pulled = [&](Solver& solver) { return run_with_hand(solver, steps); };
      ASPIC_CHECK(comparison.add(model, pulled, paths_of(row, integrator)));
    }
  }
  return comparison.finding();
}

/// Two particles, one spring: after one step of explicit Euler from known velocities the force is (v' −
/// v)·m/h, and with h a power of two and v = 0 but along the spring nothing is lost in reading it back.
Result<Finding> spring_force(const Subject& subject) {
  Noise noise(77);
  constexpr int pairs = 1000;
  std::vector<Vec3> x, v;
  std::vector<Spring> springs;
  for (int i = 0; i < pairs; ++i) {
    // Close to the origin, so that positions lose nothing; only one end moves.
    const Vec3 e = noise.vector();
    x.push_back(e);
    x.push_back(Vec3{});
    v.push_back(4.0 * noise.vector());
    v.push_back(Vec3{});
    springs.push_back({static_cast<std::uint32_t>(2 * i), static_cast<std::uint32_t>(2 * i + 1), 0});
  }
  Model model = loose_particles(x, v);
  model.simulation.gravity = {0, 0, 0};
  model.simulation.timestep = 0x1p-20;
  model.spring_classes.push_back({SpringType::structural, 2000.0, 60.0, 0.5, false});
  model.listed_springs = springs;
  const State start = initial_state(model, Precision::single);
  const auto f = force(model, motion_of<double>(start));
  ASPIC_TRY(auto solver, subject.gpu(model, {}));
  ASPIC_TRY(const auto end, run(*solver, 1, &start));
  double worst = 0.0;
  for (int i = 0; i < pairs; ++i) {
    // The end at rest: v' = h·f exactly, so f = v'/h.
    const auto a = 2 * static_cast<std::size_t>(i), b = a + 1;
    const Vec3 read = (1 / model.simulation.timestep) * end.velocity[b];
    const double L = length(start.position[a] - start.position[b]);
    const double scale = 2000.0 * (L + 0.5) + 60.0 * length(start.velocity[a] - start.velocity[b]);
    for (int axis = 0; axis < 3; ++axis) {
      worst = std::max(worst, std::abs(read[axis] - f[static_cast<Eigen::Index>(3 * b) + axis]) / scale);
    }
  }
  return at_most(worst, 4e-7);
}

Result<Model> repeat_model(Integrator integrator) {
  return build_model(cube_on_terrain(5, TerrainShape::plane, integrator, ContactModel::coulomb));
}

/// Runs that go nowhere end alike as well: their hash is the one they started with.
Finding one_hash(const std::set<std::string>& hashes, std::size_t runs, const Model& model,
                 const std::string& expected = "") {
  const bool still = hashes.contains(state_hash_text(initial_state(model, Precision::single)));
  const bool one = hashes.size() == 1 && !still && (expected.empty() || *hashes.begin() == expected);
  return {one, fmt::format("{} hash{} in {} runs{}", hashes.size(), hashes.size() == 1 ? "" : "es", runs,
                           still                      ? ", that of the start: nothing moved"
                           : one && !expected.empty() ? ", that of the reference"
                                                      : "")};
}

Result<Finding> repeated(const Subject& subject, Integrator integrator, std::uint64_t steps) {
  ASPIC_TRY(auto model, repeat_model(integrator));
  ASPIC_TRY(auto solver, subject.gpu(model, {}));
  const State start = initial_state(model, Precision::single);
  std::set<std::string> hashes;
  for (int i = 0; i < 20; ++i) {
    ASPIC_TRY(auto end, run(*solver, steps, &start));
    hashes.insert(state_hash_text(end));
  }
  return one_hash(hashes, 20, model);
}

Result<Finding> group_sizes(const Subject& subject) {
  ASPIC_TRY(auto model, repeat_model(Integrator::runge_kutta_4));
  std::set<std::string> hashes;
  std::size_t runs = 0;
  for (const ForcePathRow& path : force_paths()) {
    for (const std::uint32_t size : {32u, 64u, 128u, 256u}) {
      GpuOptions options;
      options.force_path = path.path;
      options.group_size = size;
      ASPIC_TRY(auto solver, subject.gpu(model, options));
      ASPIC_TRY(auto end, run(*solver, repeat_steps));
      hashes.insert(state_hash_text(end));
      ++runs;
    }
  }
  return one_hash(hashes, runs, model);
}

Result<Finding> driver_threads(const Subject& subject) {
  const std::vector<std::string> overrides = {
      "cube[0].particles-per-edge=6", "cube[0].position=[0.0, 2.0, 0.0]", "cube[0].rotation.angle=20.0",
      "cube[0].rotation.axis=[1.0, 2.0, 3.0]"};
  ASPIC_TRY(auto scene, load_scene("cube-plane", overrides));
  ASPIC_TRY(auto model, build_model(scene.model));
  ASPIC_TRY(auto expected, run_reference(subject, model, Precision::single, repeat_steps));
  std::vector<std::string> words = {
      "run", "cube-plane", "--backend", "gpu", "--json", "--steps", std::to_string(repeat_steps)};
  for (const std::string& text : overrides) words.insert(words.end(), {"--set", text});
  std::set<std::string> hashes;
  for (const char* threads : {"1", "2", "8"}) {
    // The driver reads its thread count once, at its start: each count runs in a separate process.
    ASPIC_TRY(auto output, output_of(subject.program, words, {{"LP_NUM_THREADS", threads}}));
    const std::string key = "\"state_hash\": \"";
    const std::size_t at = output.find(key);
    if (at == std::string::npos)
      return Error{ErrorCode::check_failed, "the child process printed no state hash"};
    hashes.insert(output.substr(at + key.size(), 16));
  }
  return one_hash(hashes, 3, model, subject.software_device ? state_hash_text(expected) : "");
}

}  // namespace

void add_equality_checks(std::vector<Check>& checks) {
  for (const BackendRow& row : backends().first(backends().size() - 1)) {
    const char* const bound =
        row.needs_context ? "0 ULP, or what the arithmetic that the canary found explains" : "0 ULP";
    for (const Integrator integrator : all_integrators) {
      const std::vector<GpuOptions> paths = paths_of(row, integrator);
      checks.push_back(
          {fmt::format("equality/{}/{}", name_of(integrator), row.name),
           fmt::format("{} and reference after {} steps through contact: {} terrains, 2 contact models{}",
                       row.name, row_of(integrator).traits.long_steps ? few_steps : most_steps,
                       std::size(terrain_shapes) + 1,
                       row.force_paths().empty() ? ""
                       : paths.size() == 1       ? fmt::format(", {}", name_of(paths.front().force_path))
                                                 : fmt::format(", {} force paths", paths.size())),
           bound, integrator == Integrator::explicit_euler, row.needs_context,
           [&row, integrator](const Subject& subject) { return same_bits(subject, row, integrator); }});
    }
    checks.push_back(
        {fmt::format("equality/pull/{}", row.name),
         fmt::format(
             "{} and reference while a hand pulls, moves and lets go: every integrator, 2 contact models{}",
             row.name,
             row.force_paths().empty() ? "" : fmt::format(", {} force paths", row.force_paths().size())),
         bound, true, row.needs_context,
         [&row](const Subject& subject) { return same_bits_with_hand(subject, row); }});
  }
  checks.push_back({"equality/force",
                    "spring force of the gpu against double precision, over k(L + r) + c|v|, 1,000 springs",
                    at_most_text(4e-7), true, true, spring_force});
  checks.push_back({"repeat/runs", "20 runs of 500 steps on the gpu end with one hash", "1 hash", true, true,
                    [](const Subject& s) { return repeated(s, Integrator::explicit_euler, repeat_steps); }});
  checks.push_back({"repeat/implicit", "20 runs of 10 steps of implicit-euler on the gpu end with one hash",
                    "1 hash", false, true,
                    [](const Subject& s) { return repeated(s, Integrator::implicit_euler, 10); }});
  checks.push_back({"repeat/group-sizes",
                    "work groups of 32, 64, 128, 256 on all force paths end with one hash", "1 hash", false,
                    true, group_sizes});
  checks.push_back({"repeat/driver-threads",
                    "1, 2 and 8 driver threads end with one hash, on software that of the reference",
                    "1 hash", true, true, driver_threads});
}

}  // namespace aspic::verify

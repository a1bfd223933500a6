// The device against the reference: the same bits, however often and in whatever groups.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/compare.h"
#include "io/child_process.h"
#include "model/terrain.h"
#include "scene/load.h"
#include "verify/experiments.h"
#include "verify/textbook.h"

namespace aspic::verify {
namespace {

constexpr std::uint64_t explicit_steps = 2000, implicit_steps = 60, repeat_steps = 500;

struct Worst {
  std::uint64_t ulp = 0;
  double absolute = 0.0;
  int runs = 0;
  std::string arithmetic;  ///< the canary's sentences
  bool arithmetic_exact = true;
};

/// A solver of any backend but the reference.
Result<std::unique_ptr<Solver>> make_solver(const Subject& subject, const BackendRow& row, const Model& model,
                                            ForcePath path) {
  if (!row.needs_context) return subject.other(model, {&row});
  GpuOptions options;
  options.force_path = path;
  ASPIC_TRY(auto solver, subject.gpu(model, options));
  return std::unique_ptr<Solver>(std::move(solver));
}

/// The force paths of a backend that have bits of their own to show with an integrator.
std::vector<ForcePath> paths_of(const BackendRow& row, Integrator integrator) {
  if (row.force_paths().empty()) return {ForcePath::automatic};
  std::vector<ForcePath> paths;
  for (const ForcePathRow& path : row.force_paths())
    if (works_with(path.path, integrator)) paths.push_back(path.path);
  return paths;
}

/// What the canary found on the device of a solver; null: the solver runs on none.
const gl::Arithmetic* arithmetic_of(const Solver& solver) {
  const auto* const gpu = dynamic_cast<const GpuSolver*>(&solver);
  return gpu ? &gpu->arithmetic() : nullptr;
}

Status compare_run(const Subject& subject, const BackendRow& row, const Model& model, ForcePath path,
                   std::uint64_t steps, const State& expected, Worst& worst) {
  ASPIC_TRY(auto solver, make_solver(subject, row, model, path));
  ASPIC_TRY(const auto end, run(*solver, steps));
  ASPIC_TRY(const auto difference, compare_states(end, expected));
  worst.ulp = std::max(worst.ulp, difference.largest_ulp());
  worst.absolute = std::max(worst.absolute, difference.largest_absolute());
  ++worst.runs;
  worst.arithmetic.clear();
  if (const gl::Arithmetic* const arithmetic = arithmetic_of(*solver)) {
    worst.arithmetic_exact = arithmetic->exact();
    for (const std::string& sentence : arithmetic->sentences()) worst.arithmetic += " " + sentence;
  }
  return {};
}

Result<Finding> same_bits(const Subject& subject, const BackendRow& row, Integrator integrator) {
  const bool solved = row_of(integrator).solved();
  const std::uint64_t steps = solved ? implicit_steps : explicit_steps;
  Worst worst;
  // The last round is on ground that moves.
  for (std::size_t round = 0; round <= std::size(terrain_shapes); ++round) {
    const bool moves = round == std::size(terrain_shapes);
    for (const ContactModel contact : both_contact_models) {
      const TerrainShape shape = terrain_shapes[moves ? 0 : round].value;
      ModelSettings settings = cube_on_terrain(solved ? 4 : 5, shape, integrator, contact);
      if (moves) settings.terrain[0].motion = TerrainMotion{{0.3, 1.0, 0.2}, 0.2, 1.1, 0.2};
      if (solved) settings.simulation.timestep = 0.01;
      ASPIC_TRY(auto model, build_model(settings));
      ASPIC_TRY(auto expected, run_reference(subject, model, Precision::single, steps));
      for (const ForcePath path : paths_of(row, integrator)) {
        ASPIC_CHECK(compare_run(subject, row, model, path, steps, expected, worst));
      }
    }
  }
  const std::string text = fmt::format("{} ULP in {} runs", worst.ulp, worst.runs);
  if (worst.ulp == 0) return Finding{true, text};
  // Hardware that the canary found to compute otherwise is excused by that finding, and by nothing else.
  return Finding{!subject.software_device && !worst.arithmetic_exact,
                 fmt::format("{}, {:.3g} in metres and m/s.{}", text, worst.absolute, worst.arithmetic)};
}

/// A hand that takes a corner, moves, changes to a particle inside and lets go, each for a quarter of the
/// run.
Result<State> run_with_hand(Solver& solver, std::uint64_t steps) {
  const std::uint32_t last = solver.model().particle_count() - 1;
  const std::optional<Pull> inputs[] = {Pull{last, {4.0, 5.0, 2.0}, 900.0, 20.0},
                                        Pull{last, {4.0, 2.0, -3.0}, 900.0, 20.0},
                                        Pull{last / 2, {-2.0, 4.0, 1.0 / 3.0}, 1e4 / 3.0, 0.0}, std::nullopt};
  for (const std::optional<Pull>& pull : inputs) {
    ASPIC_CHECK(solver.set_pull(pull));
    ASPIC_CHECK(require_good(solver.advance(steps / 4)));
  }
  return solver.state();
}

Result<Finding> same_bits_with_hand(const Subject& subject, const BackendRow& row) {
  std::uint64_t worst = 0;
  int runs = 0;
  bool exact = true;
  for (const Integrator integrator : all_integrators) {
    const bool solved = row_of(integrator).solved();
    for (const ContactModel contact : both_contact_models) {
      ModelSettings settings = cube_on_terrain(4, TerrainShape::plane, integrator, contact);
      if (solved) settings.simulation.timestep = 0.01;
      const std::uint64_t steps = solved ? implicit_steps : repeat_steps;
      ASPIC_TRY(auto model, build_model(settings));
      ASPIC_TRY(auto reference, subject.reference(model, Precision::single));
      ASPIC_TRY(auto expected, run_with_hand(*reference, steps));
      for (const ForcePath path : paths_of(row, integrator)) {
        ASPIC_TRY(auto solver, make_solver(subject, row, model, path));
        ASPIC_TRY(auto end, run_with_hand(*solver, steps));
        ASPIC_TRY(auto difference, compare_states(end, expected));
        worst = std::max(worst, difference.largest_ulp());
        if (const gl::Arithmetic* const a = arithmetic_of(*solver)) exact = exact && a->exact();
        ++runs;
      }
    }
  }
  return Finding{worst == 0 || (!subject.software_device && !exact),
                 fmt::format("{} ULP in {} runs", worst, runs)};
}

/// Two particles, one spring: after one step of explicit Euler from known velocities the force is (v' −
/// v)·m/h, and with h a power of two and v = 0 but along the spring nothing is lost in reading it back.
Result<Finding> spring_force(const Subject& subject) {
  Noise noise(77);
  constexpr int pairs = 1000;
  Model model;
  model.simulation.gravity = {0, 0, 0};
  model.simulation.timestep = 0x1p-20;
  model.spring_classes.push_back({SpringType::structural, 2000.0, 60.0, 0.5, false});
  std::vector<Vec3> x, v;
  for (int i = 0; i < pairs; ++i) {
    // Close to the origin, so that positions lose nothing; only one end moves.
    const Vec3 e = noise.vector();
    x.push_back(e);
    x.push_back(Vec3{});
    v.push_back(4.0 * noise.vector());
    v.push_back(Vec3{});
    model.listed_springs.push_back(
        {static_cast<std::uint32_t>(2 * i), static_cast<std::uint32_t>(2 * i + 1), 0});
  }
  model.initial_position = x;
  model.initial_velocity = v;
  model.mass.assign(x.size(), 1.0);
  model.inverse_mass.assign(x.size(), 1.0);
  const State start = initial_state(model, Precision::single);
  const auto f = force(model, motion_of<double>(start));
  GpuOptions options;
  ASPIC_TRY(auto solver, subject.gpu(model, options));
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
  ModelSettings settings = cube_on_terrain(5, TerrainShape::plane, integrator, ContactModel::coulomb);
  if (row_of(integrator).solved()) settings.simulation.timestep = 0.01;
  return build_model(settings);
}

Finding one_hash(const std::set<std::string>& hashes, std::size_t runs, const std::string& expected) {
  const bool one = hashes.size() == 1 && (expected.empty() || *hashes.begin() == expected);
  return {one, fmt::format("{} hash{} in {} runs{}", hashes.size(), hashes.size() == 1 ? "" : "es", runs,
                           one && !expected.empty() ? ", that of the reference" : "")};
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
  return one_hash(hashes, 20, "");
}

Result<Finding> group_sizes(const Subject& subject) {
  ASPIC_TRY(auto model, repeat_model(Integrator::runge_kutta_4));
  std::set<std::string> hashes;
  std::size_t runs = 0;
  for (const ForcePathRow& path : built_force_paths()) {
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
  return one_hash(hashes, runs, "");
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
    // The driver reads its thread count once, at its start: each count is a process of its own.
    ASPIC_TRY(auto output, output_of(subject.program, words, {{"LP_NUM_THREADS", threads}}));
    const std::string key = "\"state_hash\": \"";
    const std::size_t at = output.find(key);
    if (at == std::string::npos)
      return Error{ErrorCode::check_failed, "the child process printed no state hash"};
    hashes.insert(output.substr(at + key.size(), 16));
  }
  return one_hash(hashes, 3, subject.software_device ? state_hash_text(expected) : "");
}

}  // namespace

void add_equality_checks(std::vector<Check>& checks) {
  for (const BackendRow& row : backends().first(backends().size() - 1)) {
    const char* const bound = row.needs_context ? "0 ULP, or the canary's finding on hardware" : "0 ULP";
    for (const Integrator integrator : all_integrators) {
      const std::vector<ForcePath> paths = paths_of(row, integrator);
      checks.push_back(
          {fmt::format("equality/{}/{}", name_of(integrator), row.name),
           fmt::format("{} and reference after {} steps through contact: {} terrains, 2 contact models{}",
                       row.name, row_of(integrator).solved() ? implicit_steps : explicit_steps,
                       std::size(terrain_shapes) + 1,
                       row.force_paths().empty() ? ""
                       : paths.size() == 1       ? fmt::format(", {}", name_of(paths.front()))
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

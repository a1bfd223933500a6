#pragma once
// tests/data/hashes.json: which state the reference in single precision ends a run with, by its hash. Solvers
// on every backend and driver are compared with the file, so the reference computes these runs once, and a
// change of bits that all backends make alike is noticed.
//
// A change that is meant to alter bits writes the file again: scripts/hashes.sh.
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "aspic/state.h"
#include "model/model.h"
#include "support/equality_cases.h"
#include "support/kernel_variants.h"

namespace aspic::test {

/// A run whose last state's hash is in the file.
struct GoldenRun {
  std::string scene;  ///< unique with the method
  Integrator method;
  std::uint64_t steps;
  std::function<Model()> model;
  std::function<ModelSettings()> settings = {};  ///< of built-in scenes; else empty
};

GoldenRun golden_run(const EqualityCase& row);
GoldenRun golden_run(const KernelVariant& variant);
/// A built-in scene, its bodies set down 1 cm above the terrain so that they touch it soon.
GoldenRun golden_run(const std::string& builtin_scene, ContactModel contact, Integrator method);

/// Every built-in scene with every contact model.
std::vector<GoldenRun> scene_runs();
/// Of these, every built-in scene under explicit Euler, Runge-Kutta 4 and implicit Euler with Coulomb's
/// contact, and one under another method or with the course's contact, which take turns.
std::vector<GoldenRun> core_scene_runs();
/// Those of the covering set and of the kernel variants, each once.
std::vector<GoldenRun> case_runs();

/// The state at its end by the reference; of a run that diverges, the last good one.
State reference_state(const GoldenRun& run);

/// Runs in the file.
std::size_t golden_count();
/// The last good state: its step, fewer than the run's if it diverges, and its hash.
struct GoldenEnd {
  std::uint64_t step = 0;
  std::string hash;
  friend bool operator==(const GoldenEnd&, const GoldenEnd&) = default;
};
/// The file's; nothing if the file has no such run or other steps.
std::optional<GoldenEnd> golden_end(const GoldenRun& run);

/// Fails the test unless the state is the one that the file tells of. Then the reference runs, to say who
/// differs.
void expect_golden(const GoldenRun& run, const State& state);

/// A run of a built-in scene on an NVIDIA H200 (bench/results/h200/hashes.csv), with the hash of its last
/// state.
struct HardwareRun {
  std::string scene;
  Integrator method;
  std::uint64_t steps;
  std::string hash;

  std::string text() const;
  Model model() const;
};
std::vector<HardwareRun> hardware_runs();

/// The text of a file with these runs.
std::string golden_text(const std::vector<GoldenRun>& runs);

}  // namespace aspic::test

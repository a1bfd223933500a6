// The table of backends, and choosing by it.
#include "run/backends.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cfenv>
#include <cmath>
#include <limits>
#include <set>
#include <thread>

#include "aspic/scene.h"
#include "base/flush_denormals.h"
#include "run/window_host.h"

namespace aspic {
namespace {

using testing::HasSubstr;

TEST(Backends, AreGoneRoundByTheirOrder) {
  std::set<std::string_view> seen;
  const BackendRow* row = &backends().front();
  for (std::size_t i = 0; i < backends().size(); ++i, row = &next_backend(*row)) {
    EXPECT_TRUE(seen.insert(row->name).second) << row->name;
    EXPECT_EQ(find_backend(row->name), row);
  }
  EXPECT_EQ(row, &backends().front());
  EXPECT_EQ(reference_backend().name, "reference");
  EXPECT_EQ(find_backend("tpu"), nullptr);
}

TEST(Backends, AnUnknownWordIsAnsweredWithAllNames) {
  const auto parsed = parse_backend_name("tpu");
  ASSERT_FALSE(parsed.ok());
  EXPECT_EQ(parsed.error().code, ErrorCode::usage);
  for (const BackendRow& row : backends())
    EXPECT_THAT(parsed.error().message(), HasSubstr(std::string(row.name)));
  EXPECT_EQ(*parse_backend_name("auto"), nullptr);
}

TEST(Backends, WhatARowLacksIsRefusedBeforeAnyWork) {
  for (const BackendRow& row : backends()) {
    const bool has_double = std::ranges::find(row.precisions, Precision::double_) != row.precisions.end();
    EXPECT_EQ(check_choice({&row, Precision::double_, ForcePath::automatic}).ok(), has_double) << row.name;
    EXPECT_EQ(check_choice({&row, Precision::single, ForcePath::gather}).ok(), !row.force_paths().empty())
        << row.name;
  }
  EXPECT_FALSE(check_choice({nullptr, Precision::double_, ForcePath::gather}).ok());
}

TEST(Backends, FastArithmeticAndThreadsAreForThoseThatHaveThem) {
  for (const BackendRow& row : backends()) {
    for (const auto& [choice, has, remedy] :
         {std::tuple{BackendChoice{.row = &row, .arithmetic = Arithmetic::fast}, row.fast, "gpu"},
          std::tuple{BackendChoice{.row = &row, .threads = 5}, row.threaded, "cpu"}}) {
      const Status checked = check_choice(choice);
      EXPECT_EQ(checked.ok(), has) << row.name;
      if (has) continue;
      EXPECT_EQ(checked.error().code, ErrorCode::usage);
      EXPECT_THAT(checked.error().message(), HasSubstr(fmt::format("the {} does not", row.name)));
      EXPECT_THAT(worded(checked.error(), FrontEnd::command_line),
                  HasSubstr(fmt::format("se --backend {}", remedy)));
      EXPECT_THAT(worded(checked.error(), FrontEnd::python),
                  HasSubstr(fmt::format("ass backend=\"{}\"", remedy)));
      EXPECT_TRUE(check_choice(choice_for(&row, choice)).ok()) << row.name;
    }
  }
  EXPECT_TRUE(choose_automatically({.arithmetic = Arithmetic::fast}).row->fast);
  EXPECT_EQ(choose_automatically({.threads = 2}).row, find_backend("cpu"));
  const Status nobody = check_choice({.precision = Precision::double_, .arithmetic = Arithmetic::fast});
  ASSERT_FALSE(nobody.ok());
  EXPECT_THAT(nobody.error().message(), HasSubstr("no backend supports this combination"));
}

TEST(Backends, OptionsOfItsOwnGoBeforeThoseAskedOfAll) {
  const BackendChoice asked = {.arithmetic = Arithmetic::fast, .threads = 3};
  EXPECT_EQ(*parse_backend("cpu", asked), (BackendChoice{.row = find_backend("cpu"), .threads = 3}));
  EXPECT_EQ(*parse_backend("gpu", asked),
            (BackendChoice{.row = find_backend("gpu"), .arithmetic = Arithmetic::fast}));
  EXPECT_EQ(*parse_backend("gpu:exact", asked), (BackendChoice{.row = find_backend("gpu")}));
  EXPECT_EQ(*parse_backend("reference:double", asked),
            (BackendChoice{.row = find_backend("reference"), .precision = Precision::double_}));
  EXPECT_EQ(parse_backend("gpu:fast")->arithmetic, Arithmetic::fast);
  EXPECT_FALSE(parse_backend("cpu:quick").ok());
}

TEST(Backends, AutoTakesTheFirstThatHasThePrecision) {
  const AutomaticChoice choice = choose_automatically({nullptr, Precision::double_, ForcePath::automatic});
  ASSERT_NE(choice.row, nullptr);
  for (const BackendRow& row : backends()) {
    if (std::ranges::find(row.precisions, Precision::double_) == row.precisions.end()) continue;
    EXPECT_EQ(choice.row, &row);
    break;
  }
  EXPECT_THAT(choice.reason, HasSubstr("double precision"));
}

TEST(Backends, EveryVariantTellsItsBytes) {
  const auto scene = load_scene("cube-plane");
  ASSERT_TRUE(scene.ok());
  const auto model = build_model(scene->model);
  ASSERT_TRUE(model.ok());
  std::set<std::string> names;
  for (const BackendBytes& bytes : bytes_by_backend(*model)) {
    EXPECT_GT(bytes.bytes.value(), 24 * model->particle_count()) << bytes.backend;
    EXPECT_TRUE(names.insert(bytes.backend).second) << bytes.backend;
    EXPECT_TRUE(parse_backend(bytes.backend).ok()) << bytes.backend;
  }
}

TEST(Backends, ASolverSaysWhatItIs) {
  const auto scene = load_scene("cube-plane");
  ASSERT_TRUE(scene.ok());
  const auto model = build_model(scene->model);
  ASSERT_TRUE(model.ok());
  const auto backend = make_backend({&reference_backend(), Precision::double_, ForcePath::automatic}, *model);
  ASSERT_TRUE(backend.ok()) << backend.error().message();
  EXPECT_EQ(backend->variant(), "reference:double");
  EXPECT_EQ(backend->row, &reference_backend());
  EXPECT_EQ(gpu_of(*backend), nullptr);
  EXPECT_EQ(context_of(*backend), nullptr);
}

// In a net, numbers become denormal within steps.
TEST(Backends, KeepTheCallersFloatingPointEnvironmentAndNotItsArithmetic) {
  for (const char* integrator : {"symplectic-euler", "implicit-euler"}) {
    const std::vector<std::string> set = {fmt::format("simulation.integrator={}", integrator)};
    const auto model = build_model(load_scene("goal-net", set)->model);
    ASSERT_TRUE(model.ok());
    std::set<std::string> hashes;
    for (const BackendRow& row : backends()) {
      const auto backend = make_backend({.row = &row, .threads = row.threaded ? 2u : 0u}, *model);
      ASSERT_TRUE(backend.ok()) << backend.error().message();
      ASSERT_TRUE(backend->solver->advance(4).ok());
      std::fesetround(FE_UPWARD);
      const auto advanced = backend->solver->advance(4);
      const auto state = backend->solver->state();
      EXPECT_EQ(std::fegetround(), FE_UPWARD);
      std::fesetround(FE_TONEAREST);
      EXPECT_FALSE(flushes_denormals());
      ASSERT_TRUE(advanced.ok() && state.ok());
      hashes.insert(state_hash_text(*state));
    }
    EXPECT_EQ(hashes.size(), 1u);
  }
}

TEST(Backends, AnInterruptedStepIsDroppedAndTheRunGoesOnWithItsBits) {
  for (const char* integrator : {"explicit-euler", "runge-kutta-4", "implicit-euler"}) {
    const std::vector<std::string> set = {fmt::format("simulation.integrator={}", integrator)};
    const auto model = build_model(load_scene("cube-plane", set)->model);
    ASSERT_TRUE(model.ok());
    for (const BackendRow& row : backends()) {
      if (row.needs_context) continue;
      const auto backend = make_backend({&row}, *model);
      ASSERT_TRUE(backend.ok()) << backend.error().message();
      Solver& solver = *backend->solver;
      std::atomic<bool> flag = false;
      std::atomic<int> begun = 0;
      solver.set_stop_flag(&flag);
      {
        const std::jthread hand([&] {
          while (begun < 1) std::this_thread::yield();
          flag = true;
        });
        begun = 1;
        const auto advanced = solver.advance(1'000'000'000);
        ASSERT_TRUE(advanced.ok());
        EXPECT_FALSE(advanced->divergence.has_value()) << "an interruption is no divergence";
        EXPECT_TRUE(advanced->stopped);
        EXPECT_EQ(advanced->steps, solver.state()->step);
      }
      EXPECT_EQ(*solver.advance(5), (Advance{0, {}, true}));
      const std::uint64_t step = solver.state()->step;
      flag = false;
      EXPECT_EQ(*solver.advance(3), Advance{3});
      const auto other = make_backend({&reference_backend()}, *model);
      ASSERT_TRUE(other->solver->advance(step + 3).ok());
      EXPECT_EQ(state_hash_text(*solver.state()), state_hash_text(*other->solver->state()))
          << row.name << ", " << integrator << ", interrupted after " << step;
    }
  }
}

/// Every backend that needs no device, with a cube that touches itself, in every precision that it has.
std::vector<Backend> contextless(const ModelSettings& settings) {
  std::vector<Backend> all;
  const auto model = make_model(settings);
  EXPECT_TRUE(model.ok());
  for (const BackendRow& row : backends()) {
    if (row.needs_context) continue;
    for (const Precision precision : {Precision::single, Precision::double_}) {
      auto made = make_backend({&row, precision}, *model);
      if (made) all.push_back(std::move(*made));
    }
  }
  EXPECT_GE(all.size(), 3u);
  return all;
}

TEST(Backends, AStoppedReplayKeepsTheInputsOfItsStep) {
  const auto scene = load_scene("cube-plane");
  InputLog log;
  log.set(0, {.pinned = {1}});
  log.set(10, {.pinned = {2}});
  for (const Backend& backend : contextless(scene->model)) {
    Solver& solver = *backend.solver;
    std::atomic<bool> flag = true;
    solver.set_stop_flag(&flag);
    EXPECT_EQ(*advance(solver, log, 0, 100), (Advance{0, {}, true})) << backend.variant();
    EXPECT_EQ(solver.inputs().pinned, std::vector<std::uint32_t>{1}) << "those of a later step";
    flag = false;
    EXPECT_EQ(*advance(solver, log, 0, 15), Advance{15});
    EXPECT_EQ(solver.inputs().pinned, std::vector<std::uint32_t>{2});
  }
}

TEST(Backends, ADivergenceEndsAReplayAtItsStep) {
  const std::vector<std::string> set = {"simulation.timestep=0.05"};
  const auto scene = load_scene("cube-plane", set);
  InputLog log;
  log.set(3, {.pinned = {2}});
  for (const Backend& backend : contextless(scene->model)) {
    const auto made = advance(*backend.solver, log, 0, 100000);
    ASSERT_TRUE(made.ok() && made->divergence) << backend.variant();
    EXPECT_EQ(made->steps, made->divergence->step - 1);
    EXPECT_EQ(made->steps, backend.solver->state()->step);
    EXPECT_FALSE(made->stopped);
  }
}

TEST(Backends, RefuseStatesThatAreNotFinite) {
  const std::vector<std::string> set = {"contact.self=true", "cube[0].particles-per-edge=4"};
  auto scene = load_scene("cube-plane", set);
  scene->model.balls.emplace_back();
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = HUGE_VAL;
  for (const Backend& backend : contextless(scene->model)) {
    Solver& solver = *backend.solver;
    ASSERT_TRUE(solver.advance(2).ok());
    const State before = *solver.state();
    for (const StateField& field : state_fields) {
      for (const double bad : {nan, inf, -inf, 1e300}) {
        const bool finite = bad == 1e300 && solver.precision() == Precision::double_;
        for (const bool all : {false, true}) {
          State state = before;
          auto& vectors = state.*field.vectors;
          for (std::size_t i = all ? 0 : vectors.size() - 1; i < vectors.size(); ++i) vectors[i].y = bad;
          const Status loaded = solver.load(state);
          ASSERT_EQ(loaded.ok(), finite) << backend.variant() << ", " << field.name << " " << bad;
          if (finite) {
            ASSERT_TRUE(solver.load(before).ok());
            continue;
          }
          EXPECT_EQ(loaded.error().code, ErrorCode::usage);
          EXPECT_NE(loaded.error().what.find(field.name), std::string::npos) << loaded.error().what;
          EXPECT_EQ(*solver.state(), before) << "a refused state changes nothing";
        }
      }
    }
  }
}

TEST(Backends, AnotherTimeStepKeepsTheTime) {
  const auto scene = load_scene("elevator");
  for (const double factor : {0.5, 2.0, 0.3}) {
    ModelSettings other = scene->model;
    other.simulation.timestep *= factor;
    const auto model = make_model(other);
    for (const Backend& backend : contextless(scene->model)) {
      Solver& solver = *backend.solver;
      ASSERT_EQ(*solver.advance(700), Advance{700});
      const State before = *solver.state();
      ASSERT_TRUE(solver.set_constants(*model).ok());
      EXPECT_EQ(solver.state()->step, step_at_same_time(700, 1.0, factor)) << backend.variant();
      ASSERT_EQ(*solver.advance(2), Advance{2});
      const State after = *solver.state();
      // The plate moves at up to 1 m/s; where time jumped it was half a meter.
      for (std::size_t i = 0; i < before.position.size(); ++i)
        ASSERT_LT(std::abs(after.position[i].y - before.position[i].y), 0.02) << backend.variant();
    }
  }
}

}  // namespace
}  // namespace aspic

// The table of backends, and choosing by it.
#include "run/backends.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cfenv>
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
    for (const auto& [choice, has] :
         {std::pair{BackendChoice{.row = &row, .arithmetic = Arithmetic::fast}, row.fast},
          std::pair{BackendChoice{.row = &row, .threads = 5}, row.threaded}}) {
      const Status checked = check_choice(choice);
      EXPECT_EQ(checked.ok(), has) << row.name;
      if (has) continue;
      EXPECT_EQ(checked.error().code, ErrorCode::usage);
      EXPECT_THAT(checked.error().message(), HasSubstr(fmt::format("the {} does not", row.name)));
      EXPECT_THAT(worded(checked.error(), FrontEnd::command_line), HasSubstr("se --backend cpu"));
      EXPECT_THAT(worded(checked.error(), FrontEnd::python), HasSubstr("ass backend=\"cpu\""));
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
  EXPECT_EQ(*parse_backend("cpu", asked),
            (BackendChoice{.row = find_backend("cpu"), .arithmetic = Arithmetic::fast, .threads = 3}));
  EXPECT_EQ(*parse_backend("cpu:exact", asked), (BackendChoice{.row = find_backend("cpu"), .threads = 3}));
  EXPECT_EQ(*parse_backend("reference:double", asked),
            (BackendChoice{.row = find_backend("reference"), .precision = Precision::double_}));
  EXPECT_EQ(parse_backend("cpu:fast")->arithmetic, Arithmetic::fast);
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
  const auto fast = make_backend({.row = find_backend("cpu"), .arithmetic = Arithmetic::fast}, *model);
  ASSERT_TRUE(fast.ok()) << fast.error().message();
  EXPECT_EQ(fast->variant(), "cpu:fast");
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
        EXPECT_FALSE(advanced->has_value()) << "an interruption is no divergence";
      }
      ASSERT_TRUE(solver.advance(5).ok());
      const std::uint64_t step = solver.state()->step;
      flag = false;
      ASSERT_TRUE(solver.advance(3).ok());
      const auto other = make_backend({&reference_backend()}, *model);
      ASSERT_TRUE(other->solver->advance(step + 3).ok());
      EXPECT_EQ(state_hash_text(*solver.state()), state_hash_text(*other->solver->state()))
          << row.name << ", " << integrator << ", interrupted after " << step;
    }
  }
}

}  // namespace
}  // namespace aspic

// What `aspic bench` times: steps, without a read of the state, in runs long enough.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/bench.h"
#include "run/backends.h"
#include "support/model_building.h"

namespace aspic::cli {
namespace {

using testing::HasSubstr;

/// Counts its steps and the reads of fields.
class CountingSolver final : public Solver {
 public:
  explicit CountingSolver(SharedModel model) : model_(std::move(model)) {}
  std::string_view backend() const override { return "gpu"; }
  std::string description() const override { return "counter"; }
  Precision precision() const override { return Precision::single; }
  const Model& model() const override { return *model_; }
  std::uint64_t bytes() const override { return 0; }
  Result<Advance> advance(std::uint64_t steps) override {
    made += steps;
    return Advance{.steps = steps};
  }

  std::uint64_t made = 0, reads = 0, waits = 0;

 private:
  Status take_state(const ConstStateView&, std::uint64_t) override { return {}; }
  Result<std::uint64_t> give_state(const StateView& view) override {
    ++waits;
    for (const Vectors& field : view) reads += std::holds_alternative<std::monostate>(field) ? 0 : 1;
    return made;
  }
  Status take_inputs(const Inputs&) override { return {}; }
  Status take_constants(SharedModel, std::uint64_t) override { return {}; }
  SharedModel model_;
};

TEST(BenchContestant, TimesStepsWithoutReadingTheState) {
  auto solver = std::make_unique<CountingSolver>(shared(test::build(test::cube_on_plane(3))));
  CountingSolver& counter = *solver;
  Backend backend;
  backend.row = find_backend("gpu");
  backend.solver = std::move(solver);
  const InterruptGuard interrupt;
  const auto contestant = make_backend_contestant(std::move(backend), interrupt);
  ASSERT_TRUE(contestant->run(100).ok());
  EXPECT_EQ(counter.made, 100u);
  EXPECT_GT(counter.waits, 0u) << "nothing waited for the device";
  EXPECT_EQ(counter.reads, 0u);
}

/// Steps of 1 ms, and five times as long for the first 0.2 s of work.
class RisingClock final : public Contestant {
 public:
  RisingClock() : Contestant({}) {}
  Result<Took> run(std::uint64_t steps) override {
    const double took = (worked_ < 0.2 ? 0.005 : 0.001) * static_cast<double>(steps);
    worked_ += took;
    return Took{took, took};
  }

 private:
  double worked_ = 0.0;
};

TEST(BenchCalibration, MeasuresAtTheClocksOfWork) {
  constexpr std::uint64_t most = 1000000;
  for (const double seconds : {0.02, 0.1, 1.0}) {
    RisingClock contestant;
    EXPECT_NEAR(static_cast<double>(*steps_for(contestant, seconds, most)), 1000 * seconds, 1.0) << seconds;
  }
  RisingClock contestant;
  EXPECT_EQ(*steps_for(contestant, 10.0, 7), 7u);
}

TEST(BenchCalibration, WarnsOfShortRepeats) {
  Measurement m;
  m.name = "gpu:lattice";
  m.size = 100;
  m.repeats = {{0.1, 0.1}};
  m.steps = fewest_steps;
  EXPECT_EQ(steps_warning(m, "--seconds"), "");
  m.steps = 1;
  EXPECT_THAT(steps_warning(m, "--seconds"), HasSubstr("gpu:lattice, 100 per edge"));
  EXPECT_THAT(steps_warning(m, "--seconds"), HasSubstr("has 1 step;"));
  EXPECT_THAT(steps_warning(m, "--duration"), HasSubstr("Raise --duration."));
  m.repeats.clear();
  EXPECT_EQ(steps_warning(m, "--seconds"), "");
}

TEST(BenchReport, HasKernelTimeWhereADeviceTellsIt) {
  Measurement m;
  m.repeats = {{0.5, 0.5}};
  m.steps = 100;
  EXPECT_DOUBLE_EQ(m.milliseconds_per_step(), 5.0);
  EXPECT_FALSE(m.kernel_milliseconds_per_step());
  m.passes = {{"forces", 1.5, 1.0, 0.0}, {"sums", 0.25, 1.0, 0.0}};
  EXPECT_DOUBLE_EQ(*m.kernel_milliseconds_per_step(), 1.75);
  BenchReport report = {"scene", 1, 0, false, {m}};
  EXPECT_EQ(json_of(report)["measurements"][0]["kernel_milliseconds_per_step"], 1.75);
  EXPECT_EQ(json_of(report)["measurements"][0]["milliseconds_per_step"], 5.0);
  report.rows[0].passes.clear();
  EXPECT_TRUE(json_of(report)["measurements"][0]["kernel_milliseconds_per_step"].is_null());
  EXPECT_THAT(table_of(report), HasSubstr("  ms/step    kernel"));
}

}  // namespace
}  // namespace aspic::cli

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/process.h"
#include "model/integrator.h"

namespace aspic {
namespace {

using test::aspic;

TEST(Bench, ReportsWhatItMeasured) {
  const auto run = aspic(
      {"bench", "--backend", "reference", "--size", "4", "--duration", "0.05", "--repeats", "2", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* key : {"\"spring_evaluations_per_second\"", "\"steps_per_second\"", "\"bytes\"",
                          "\"renderer\"", "\"spread\""}) {
    EXPECT_NE(run.out.find(key), std::string::npos) << key;
  }
  EXPECT_NE(run.out.find("\"springs\": 564"), std::string::npos)
      << run.out;  // 144 + 324 + 96 (docs/physics.md, section 2)
  EXPECT_NE(run.out.find("\"steps\": 50"), std::string::npos) << run.out;
}

TEST(Bench, SaysWhereAndWith) {
  const auto run = aspic({"bench", "--backend", "reference", "--size", "3", "--duration", "0.01", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto report = nlohmann::json::parse(run.out);
  EXPECT_GE(report["machine"]["cores"], 1);
  EXPECT_GT(report["machine"]["memory_bytes"], 0);
  EXPECT_TRUE(report["machine"].contains("processor"));
  for (const char* key : {"version", "date", "compiler", "flags"}) EXPECT_NE(report[key], "") << key;
  EXPECT_EQ(report["interrupted"], false);
  EXPECT_EQ(report["warm_up"], 1);
}

TEST(Bench, OrdersItsSamplesStatistics) {
  const auto run = aspic({"bench", "--backend", "reference,cpu", "--size", "3,5", "--duration", "0.05",
                          "--repeats", "4", "--warm-up", "0", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto rows = nlohmann::json::parse(run.out)["measurements"];
  ASSERT_EQ(rows.size(), 4u);
  for (const auto& row : rows) {
    auto seconds = row["seconds"].get<std::vector<double>>();
    ASSERT_EQ(seconds.size(), 4u);
    std::ranges::sort(seconds);
    EXPECT_EQ(row["fastest_seconds"], seconds[0]);
    EXPECT_DOUBLE_EQ(row["lower_quartile_seconds"], 0.25 * seconds[0] + 0.75 * seconds[1]);
    EXPECT_DOUBLE_EQ(row["median_seconds"], 0.5 * (seconds[1] + seconds[2]));
    EXPECT_DOUBLE_EQ(row["upper_quartile_seconds"], 0.75 * seconds[2] + 0.25 * seconds[3]);
    EXPECT_EQ(row["slowest_seconds"], seconds[3]);
    EXPECT_EQ(row["processor_seconds"].size(), 4u);
    EXPECT_GT(row["processors"], 0.0);
    EXPECT_TRUE(row["passes"].is_null());
  }
  const auto throughput = [&](std::size_t i) {
    return rows[i]["spring_evaluations_per_second"].get<double>();
  };
  const auto near = [](double a, double b) { return std::abs(a - b) <= 1e-12 * std::abs(b); };
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(rows[i]["name"], i % 2 == 0 ? "reference" : "cpu");
    EXPECT_EQ(rows[i]["size"], i < 2 ? 3 : 5);
    EXPECT_TRUE(near(rows[i]["growth"], throughput(i % 2) / throughput(i))) << i;
    EXPECT_GT(rows[i]["processor_ratio"], 0.0);
    EXPECT_TRUE(near(rows[i]["ratio"], throughput(i / 2 * 2) / throughput(i))) << i;
  }
}

TEST(Bench, MeasuresEveryIntegratorInOneTable) {
  const auto run = aspic({"bench", "--backend", "reference", "--size", "3", "--duration", "0.02", "--repeats",
                          "1", "--integrator", "all", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto rows = nlohmann::json::parse(run.out)["measurements"];
  ASSERT_EQ(rows.size(), std::size(all_integrators));
  for (std::size_t i = 0; i < rows.size(); ++i)
    EXPECT_EQ(rows[i]["integrator"], std::string(name_of(all_integrators[i])));
  const auto some = aspic({"bench", "--backend", "reference", "--size", "3", "--duration", "0.02",
                           "--repeats", "1", "--integrator", "midpoint,runge-kutta-4"});
  EXPECT_NE(some.out.find("midpoint "), std::string::npos) << some.out;
  EXPECT_NE(some.out.find("runge-kutta-4 "), std::string::npos) << some.out;
}

TEST(Bench, KeepsWhatItMeasuredBeforeAnError) {
  const auto run =
      aspic({"bench", "--backend", "reference", "--size", "3,2000", "--duration", "0.02", "--json"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("particles-per-edge"), std::string::npos) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["measurements"].size(), 1u);
}

TEST(Bench, MeasuresKernelsOnADeviceAndWarnsOfShortRepeats) {
  const auto run = aspic({"bench", "--backend", "gpu:gather,cpu", "--size", "3", "--duration", "0.005",
                          "--repeats", "1", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto rows = nlohmann::json::parse(run.out)["measurements"];
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_GT(rows[0]["kernel_milliseconds_per_step"], 0.0);
  EXPECT_GT(rows[0]["milliseconds_per_step"], 0.0);
  EXPECT_TRUE(rows[1]["kernel_milliseconds_per_step"].is_null());
  EXPECT_NE(run.err.find("gpu:gather, 3 per edge, explicit-euler: a repeat has 5 steps"), std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find("Raise --duration"), std::string::npos) << run.err;
}

TEST(Bench, LargestStepIsTheIntegratorsOwn) {
  const auto run = aspic({"bench", "--backend", "reference", "--size", "3", "--duration", "0.05", "--repeats",
                          "1", "--timestep", "largest", "--integrator", "explicit-euler", "--integrator",
                          "implicit-euler", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("\"timestep\": 0.016666666666666666"), std::string::npos) << run.out;
}

TEST(Bench, RefusesWhatItCannotMeasure) {
  EXPECT_EQ(aspic({"bench", "--size", "1"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--integrator", "leapfrog"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--timestep", "0.1"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--integrator", "midpoint,leapfrog"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--warm-up", "-1"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--seconds", "0"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--seconds", "1", "--duration", "1"}).exit_code, 2);
  EXPECT_EQ(aspic({"bench", "--backend", "reference:gather"}).exit_code, 2);
  const auto undamped = aspic({"bench", "--backend", "reference", "--size", "3", "--timestep", "largest",
                               "--set", "cube[0].structural.damping=0", "--set", "cube[0].shear.damping=0",
                               "--set", "cube[0].bending.damping=0"});
  EXPECT_EQ(undamped.exit_code, 3) << undamped.err;
}

}  // namespace
}  // namespace aspic

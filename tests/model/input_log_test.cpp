#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "aspic/inputs.h"

namespace aspic {
namespace {

Inputs channel(double value) {
  return {.channels = {value}};
}

TEST(InputLog, HoldsFromEachStepOn) {
  InputLog log;
  EXPECT_TRUE(log.at(7).empty());
  EXPECT_EQ(log.next_change(0), std::nullopt);
  log.set(5, channel(1.0));
  log.set(9, channel(2.0));
  log.set(12, {});
  EXPECT_TRUE(log.at(4).empty());
  EXPECT_EQ(log.at(5), channel(1.0));
  EXPECT_EQ(log.at(8), channel(1.0));
  EXPECT_EQ(log.at(9), channel(2.0));
  EXPECT_TRUE(log.at(1000).empty());
  EXPECT_EQ(log.next_change(0), 5u);
  EXPECT_EQ(log.next_change(5), 9u);
  EXPECT_EQ(log.next_change(12), std::nullopt);
}

TEST(InputLog, KeepsNothingThatChangesNothing) {
  InputLog log;
  log.set(3, {});
  EXPECT_TRUE(log.empty());
  log.set(4, channel(1.0));
  log.set(6, channel(1.0));
  EXPECT_EQ(log.entries().size(), 1u);
}

TEST(InputLog, WhatIsSetTakesThePlaceOfAllThatFollowed) {
  InputLog log;
  for (const std::uint64_t step : {2u, 4u, 6u}) log.set(step, channel(static_cast<double>(step)));
  log.set(4, channel(9.0));
  EXPECT_EQ(log.entries().size(), 2u);
  EXPECT_EQ(log.at(100), channel(9.0));
  log.forget_from(3);
  EXPECT_EQ(log.at(100), channel(2.0));
  log.set(2, {});
  EXPECT_TRUE(log.empty());
}

TEST(InputLog, KeepsItsTimesWithAnotherTimeStep) {
  InputLog log;
  log.set(10, channel(1.0));
  log.set(15, channel(2.0));
  EXPECT_EQ(log.with_timestep(0.001, 0.001), log);
  const InputLog finer = log.with_timestep(0.001, 0.0005), coarser = log.with_timestep(0.001, 0.01);
  EXPECT_EQ(finer.next_change(0), 20u);
  EXPECT_EQ(finer.next_change(20), 30u);
  ASSERT_EQ(coarser.entries().size(), 2u);
  EXPECT_EQ(coarser.entries()[0].step, 1u);
  EXPECT_EQ(coarser.entries()[1].step, 2u);
}

TEST(InputLog, EveryNumberIsInTheHash) {
  InputLog log;
  Inputs inputs;
  inputs.pulls = {{1, {1.0, 2.0, 3.0}, 4.0, 5.0, false}};
  inputs.pinned = {6};
  inputs.released = {7};
  inputs.channels = {8.0};
  log.set(3, inputs);
  const auto hash_of = [](std::uint64_t step, const Inputs& changed) {
    InputLog other;
    other.set(step, changed);
    return other.hash();
  };
  EXPECT_EQ(hash_of(3, inputs), log.hash());
  std::vector<Inputs> others(8, inputs);
  others[0].pulls[0].particle = 2;
  others[1].pulls[0].anchor.y = 2.5;
  others[2].pulls[0].stiffness = 4.5;
  others[3].pulls[0].damping = 5.5;
  others[4].pulls[0].ball = true;
  others[5].pinned = {5};
  others[6].released = {8};
  others[7].channels = {8.5};
  std::vector<std::uint64_t> hashes = {log.hash(), hash_of(4, inputs)};
  for (const Inputs& other : others) hashes.push_back(hash_of(3, other));
  std::ranges::sort(hashes);
  EXPECT_EQ(std::ranges::adjacent_find(hashes), hashes.end());
  EXPECT_EQ(log.hash_text().size(), 16u);
}

}  // namespace
}  // namespace aspic

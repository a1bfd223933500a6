#include "model/inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "support/model_building.h"

namespace aspic {
namespace {

using ::testing::HasSubstr;

/// Six particles in a row, of which 1 and 4 are pinned.
Model row() {
  std::vector<Vec3> places;
  for (int i = 0; i < 6; ++i) places.push_back({1.0 * i, 0.0, 0.0});
  Model model = test::particles(places, std::vector<Vec3>(6));
  model.mass.set(2, 4.0);
  model.inverse_mass.set(2, 0.25);
  for (const std::size_t i : {1u, 4u}) model.inverse_mass.set(i, 0.0);
  return model;
}

std::string refusal(const Inputs& inputs, Precision precision = Precision::single) {
  const auto taken = rounded_inputs(row(), inputs, precision);
  EXPECT_FALSE(taken.ok());
  if (taken.ok()) return "";
  EXPECT_EQ(taken.error().code, ErrorCode::usage);
  return taken.error().message();
}

TEST(Inputs, AreRoundedAndSorted) {
  Inputs inputs;
  inputs.pulls = {{3, {0.1, -0.0, 0.0}, 1.0 / 3.0, 0.0}, {3, {0.2, 0.0, 0.0}, 1.0, 2.0}};
  inputs.pinned = {5, 0, 2};
  inputs.released = {4, 1};
  inputs.channels = {0.1, -0.0};
  const auto single = rounded_inputs(row(), inputs, Precision::single);
  ASSERT_TRUE(single.ok()) << single.error().message();
  EXPECT_EQ(single->pulls[0], *rounded_pull(row(), inputs.pulls[0], Precision::single));
  EXPECT_EQ(single->pulls[1].anchor.x, double{0.2f});
  EXPECT_EQ(single->pinned, (std::vector<std::uint32_t>{0, 2, 5}));
  EXPECT_EQ(single->released, (std::vector<std::uint32_t>{1, 4}));
  EXPECT_EQ(single->channels, (std::vector<double>{double{0.1f}, 0.0}));
  EXPECT_FALSE(std::signbit(single->channels[1]));
  EXPECT_EQ(rounded_inputs(row(), inputs, Precision::double_)->channels[0], 0.1);
}

TEST(Inputs, WhatIsWrongIsNamed) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal({{{0, {}, 1.0, 0.0}, {6, {}, 1.0, 0.0}}}), HasSubstr("pulls[1]: particle 6"));
  EXPECT_THAT(refusal({.pinned = {0, 7}}), HasSubstr("pinned[1]: there is no particle 7; the scene has 6"));
  EXPECT_THAT(refusal({.pinned = {3, 0, 3}}), HasSubstr("pinned: particle 3 is listed twice"));
  EXPECT_THAT(refusal({.released = {4, 3}}), HasSubstr("released: particle 3 is already free"));
  EXPECT_THAT(refusal({.pinned = {1}, .released = {1}}), HasSubstr("particle 1 is both"));
  EXPECT_THAT(refusal({.channels = {0.0, infinity}}), HasSubstr("channels[1]: inf is not finite"));
  EXPECT_THAT(refusal({.channels = {1e39}}), HasSubstr("channels[0]: 1e+39 is not finite in single"));
  EXPECT_TRUE(rounded_inputs(row(), {.channels = {1e39}}, Precision::double_).ok());
  EXPECT_THAT(refusal({.pulls = std::vector<Pull>(most_pulls + 1)}), HasSubstr("at most 256"));
  EXPECT_TRUE(rounded_inputs(row(), {.pulls = std::vector<Pull>(most_pulls)}, Precision::single).ok());
  EXPECT_THAT(refusal({.channels = std::vector<double>(most_channels + 1)}), HasSubstr("at most 65536"));
}

TEST(Inputs, WeightsFollowThePins) {
  const Model model = row();
  const auto weights = [&](const Inputs& inputs) {
    const Runs<double> runs = inverse_mass_under(model, inputs);
    std::vector<double> all(runs.begin(), runs.end());
    for (std::uint32_t i = 0; i < all.size(); ++i) EXPECT_EQ(inverse_mass_of(model, inputs, i), all[i]) << i;
    return all;
  };
  EXPECT_EQ(weights({}), (std::vector<double>{1.0, 0.0, 0.25, 1.0, 0.0, 1.0}));
  EXPECT_EQ(weights({.pinned = {0, 2, 5}}), (std::vector<double>{0.0, 0.0, 0.0, 1.0, 0.0, 0.0}));
  EXPECT_EQ(weights({.pinned = {1, 3}}), (std::vector<double>{1.0, 0.0, 0.25, 0.0, 0.0, 1.0}));
  EXPECT_EQ(weights({.pinned = {2}, .released = {1, 4}}),
            (std::vector<double>{1.0, 1.0, 0.0, 1.0, 1.0, 1.0}));
}

}  // namespace
}  // namespace aspic

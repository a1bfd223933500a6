#include "render/color_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/cube.h"
#include "render/quantity.h"
#include "support/model_building.h"

namespace aspic {
namespace {

/// The inverse of from_oklab (Ottosson, 2020).
Oklab to_oklab(const Color& linear) {
  const double r = static_cast<double>(linear[0]), g = static_cast<double>(linear[1]),
               b = static_cast<double>(linear[2]);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

Color texel(const std::vector<std::byte>& texels, std::size_t i) {
  const auto channel = [&](std::size_t c) {
    return static_cast<float>(srgb_to_linear(std::to_integer<int>(texels[4 * i + c]) / 255.0));
  };
  return {channel(0), channel(1), channel(2)};
}

TEST(ColorMap, SrgbGoesThereAndBack) {
  for (int i = 0; i <= 255; ++i) EXPECT_NEAR(linear_to_srgb(srgb_to_linear(i / 255.0)), i / 255.0, 1e-7);
}

TEST(ColorMap, OklabOfWhiteIsWhite) {
  // Ottosson's matrices are given to ten digits and white to within a few units of the eighth.
  const Oklab white = to_oklab({1.0f, 1.0f, 1.0f});
  EXPECT_NEAR(white[0], 1.0, 1e-7);
  EXPECT_NEAR(white[1], 0.0, 1e-7);
  EXPECT_NEAR(white[2], 0.0, 1e-7);
  const Color back = from_oklab(to_oklab({0.2f, 0.5f, 0.1f}));
  EXPECT_NEAR(back[0], 0.2f, 1e-6f);
  EXPECT_NEAR(back[1], 0.5f, 1e-6f);
  EXPECT_NEAR(back[2], 0.1f, 1e-6f);
}

/// Whether texels from `first` to `last` are equally far apart, lightness going one way. Fifteen texels
/// apart, so that rounding to 8 bits (half a step of 1/255 per channel, under 0.003 in Oklab) is small beside
/// the distance.
void expect_uniform(const std::vector<std::byte>& texels, std::size_t first, std::size_t last, bool rises) {
  std::vector<double> steps;
  for (std::size_t i = first; i + 15 <= last; i += 15) {
    const Oklab a = to_oklab(texel(texels, i)), b = to_oklab(texel(texels, i + 15));
    steps.push_back(std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    EXPECT_EQ(b[0] > a[0], rises) << "lightness turns at texel " << i;
  }
  double mean = 0.0;
  for (const double step : steps) mean += step / static_cast<double>(steps.size());
  for (const double step : steps) EXPECT_NEAR(step, mean, 0.1 * mean + 0.006);
}

TEST(ColorMap, EachIsPerceptuallyUniform) {
  for (const ScaleMap map : {ScaleMap::violet_yellow, ScaleMap::heat, ScaleMap::gray}) {
    const auto texels = color_map_texels(map);
    ASSERT_EQ(texels.size(), 4u * 256);
    SCOPED_TRACE(name_of(map));
    expect_uniform(texels, 0, 255, true);
  }
}

TEST(ColorMap, BlueRedMeetsInLightGrayAndItsHalvesMatch) {
  const auto texels = color_map_texels(ScaleMap::blue_red);
  expect_uniform(texels, 0, 120, true);
  expect_uniform(texels, 135, 255, false);
  for (const std::size_t i : {127u, 128u}) {
    const Oklab middle = to_oklab(texel(texels, i));
    EXPECT_GT(middle[0], 0.9);
    EXPECT_LT(std::hypot(middle[1], middle[2]), 0.01);
  }
  for (std::size_t i = 0; i < 128; i += 16) {
    const Oklab a = to_oklab(texel(texels, i)), b = to_oklab(texel(texels, 255 - i));
    EXPECT_NEAR(a[0], b[0], 0.01) << "neither sign looks stronger";
    EXPECT_LT(a[2], b[2]) << "blue to the left";
  }
}

TEST(ColorMap, AutomaticKnowsWhatHasASign) {
  ViewSettings view;
  for (const auto& [color, map] : {std::pair(ViewColor::strain, ScaleMap::violet_yellow),
                                   {ViewColor::signed_strain, ScaleMap::blue_red}}) {
    view.color = color;
    EXPECT_EQ(chosen_map(view), map);
  }
  view.scale.map = ScaleMap::gray;
  EXPECT_EQ(chosen_map(view), ScaleMap::gray);
}

TEST(Quantity, RoundsUpToOneTwoFive) {
  EXPECT_DOUBLE_EQ(round_up(0.013), 0.02);
  EXPECT_DOUBLE_EQ(round_up(5.0), 5.0);
  EXPECT_DOUBLE_EQ(round_up(5.1), 10.0);
  EXPECT_DOUBLE_EQ(round_up(700.0), 1000.0);
}

TEST(Quantity, SpeedRangeIsThatOfTheFall) {
  // The highest particle stands at 9 + 2 m over a plane at −1 m: √(2·9.8·12) = 15.3 m/s.
  const Model model = test::build(test::cube_on_plane(4));
  const QuantityRange range = default_range(model, ViewColor::speed);
  EXPECT_DOUBLE_EQ(range[0], 0.0);
  EXPECT_DOUBLE_EQ(range[1], 20.0);
  // k·r/10 of the stiffest: bending springs of 2·4/3 m at 2000 N/m, 533 N.
  EXPECT_DOUBLE_EQ(default_range(model, ViewColor::force)[1], 1000.0);
}

TEST(Quantity, EndsAreThoseOfTheViewOrOfTheImage) {
  const Model model = test::build(test::cube_on_plane(4));
  ViewSettings view;
  view.color = ViewColor::strain;
  using Ends = QuantityRange;
  const auto ends = [&](const Ends& seen) { return range_for(model, view, seen); };
  const auto expect = [](const Ends& got, const Ends& wanted) {
    // Sums and multiples of a step: a few roundings.
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(got[i], wanted[i], 1e-14);
  };
  expect(ends({0.01, 0.04}), {0.0, 0.2});
  view.scale.to = 0.05;
  expect(ends({0.01, 0.04}), {0.0, 0.05});
  view.scale.from = 0.1;
  expect(ends({0.01, 0.04}), {0.1, 0.05});
  EXPECT_FALSE(follows_image(view));

  view.scale.range = ScaleRange::automatic;
  EXPECT_TRUE(follows_image(view));
  expect(ends({0.0131, 0.0427}), {0.01, 0.045});
  expect(ends({0.01, 0.03}), {0.01, 0.03});
  expect(ends({0.0, 1e-7}), {0.0, 2e-4});         // noise: a thousandth of the model's range
  expect(ends({1.0, 0.0}), {0.0, 0.2});           // nothing in the image
  expect(ends({0.0, std::nan("")}), {0.0, 0.2});  // after a divergence

  view.scale.range = ScaleRange::symmetric;
  view.color = ViewColor::signed_strain;
  expect(ends({-0.013, 0.004}), {-0.02, 0.02});
  expect(ends({0.0, 0.0}), {-1e-4, 1e-4});
  view.color = ViewColor::material;
  EXPECT_FALSE(follows_image(view));
}

TEST(Quantity, LegendNamesUnitAndRange) {
  ViewSettings view;
  view.color = ViewColor::strain;
  const Legend legend = legend_for(view, {0.0, 0.2});
  EXPECT_EQ(legend.marks[0], "0 %");
  EXPECT_EQ(legend.marks[1], "10 %");
  EXPECT_EQ(legend.marks[2], "≥ 20 %");
  EXPECT_EQ(legend_for(view, {0.02, 0.2}).marks[0], "≤ 2 %");
  EXPECT_EQ(legend_for(view, {0.2, 0.0}).marks[0], "≥ 20 %");
  EXPECT_EQ(legend_for(view, {0.2, 0.0}).marks[2], "0 %");
  view.scale.range = ScaleRange::automatic;
  EXPECT_EQ(legend_for(view, {0.0, 0.2}).marks[2], "20 %");
  view.color = ViewColor::signed_strain;
  const Legend sign = legend_for(view, {-0.05, 0.05});
  EXPECT_EQ(sign.map, ScaleMap::blue_red);
  EXPECT_EQ(sign.marks[0], "−5 %");
  EXPECT_EQ(sign.marks[1], "0 %");
  view.color = ViewColor::energy;
  EXPECT_EQ(legend_for(view, {0.0, 2.0}).marks[2], "2 J");
  view.color = ViewColor::material;
  EXPECT_TRUE(legend_for(view, {0.0, 1.0}).empty());
  view.draw.shear = true;
  ASSERT_EQ(legend_for(view, {0.0, 1.0}).entries.size(), 1u);
}

}  // namespace
}  // namespace aspic

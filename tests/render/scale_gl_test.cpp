// Scales of colors: what an image's ends are, and what its colors say.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/springs.h"
#include "render/studio.h"

namespace aspic {
namespace {

class Scale : public test::Studio {
 protected:
  static constexpr int width = 160, height = 120;

  static ImageOptions colored(ViewColor color, ScaleRange range) {
    ImageOptions options;
    options.view.camera = {.position = {0.0, 0.0, 12.0}, .target = {0.0, 0.0, 0.0}};
    options.view.color = color;
    options.view.scale.range = range;
    options.legend = false;
    return options;
  }
  static Model lonely_cube() {
    ModelSettings settings = test::cube_on_plane(4, 0.0);
    settings.terrain.clear();
    return test::build(settings);
  }
  /// The cube stretched along x, in motion.
  static State stretched(const Model& model, double by) {
    State state = initial_state(model, Precision::single);
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      state.velocity[i] = {0.0, state.position[i].x + 3.0, 0.0};
      state.position[i].x *= by;
    }
    return state;
  }

  /// What colors show of the springs and of the particles, by their definitions.
  struct Shown {
    std::vector<double> springs, particles;
  };
  static Shown shown(const Model& model, const State& state, ViewColor color) {
    Shown all;
    const std::size_t count = state.position.size();
    std::vector<double> sum(count, 0.0), springs(count, 0.0);
    std::vector<Vec3> force(count);
    for (const Spring& spring : springs_of(model)) {
      const SpringClass& c = model.spring_classes[spring.spring_class];
      const Vec3 e = state.position[spring.a] - state.position[spring.b];
      const double L = length(e), stretch = L - c.rest_length;
      const double strength =
          c.stiffness * stretch + c.damping * dot(state.velocity[spring.a] - state.velocity[spring.b], e) / L;
      const double value = color == ViewColor::strain          ? std::abs(stretch) / c.rest_length
                           : color == ViewColor::signed_strain ? stretch / c.rest_length
                           : color == ViewColor::energy        ? 0.5 * c.stiffness * stretch * stretch
                                                               : std::abs(strength);
      all.springs.push_back(value);
      for (const std::uint32_t end : {spring.a, spring.b}) {
        sum[end] += value;
        springs[end] += 1.0;
        force[end] = force[end] + ((end == spring.a ? -1.0 : 1.0) * strength / L) * e;
      }
    }
    for (std::size_t i = 0; i < count; ++i)
      all.particles.push_back(color == ViewColor::force    ? length(force[i])
                              : color == ViewColor::energy ? 0.5 * sum[i]
                              : color == ViewColor::speed  ? length(state.velocity[i])
                                                           : sum[i] / springs[i]);
    return all;
  }
};

TEST_F(Scale, AutomaticEndsHoldWhatTheImageShows) {
  const Model model = lonely_cube();
  const State state = stretched(model, 1.037);
  for (const ViewColor color :
       {ViewColor::strain, ViewColor::signed_strain, ViewColor::force, ViewColor::energy, ViewColor::speed}) {
    for (const bool springs : {false, true}) {
      SCOPED_TRACE(fmt::format("{} {}", name_of(color), springs));
      ImageOptions options = colored(color, ScaleRange::automatic);
      options.view.draw.shear = springs;
      (void)draw(model, state, options, width, height);
      Shown all = shown(model, state, color);
      if (springs && color != ViewColor::speed)
        all.particles.insert(all.particles.end(), all.springs.begin(), all.springs.end());
      const auto [low, high] = std::ranges::minmax(all.particles);
      const QuantityRange expected = range_for(model, options.view, {low, high}), got = renderer().range();
      // Round ends are the same numbers, however single precision rounds what lies between them.
      EXPECT_EQ(got, expected) << got[0] << " … " << got[1] << ", not " << expected[0] << " … "
                               << expected[1];
      EXPECT_LT(got[0], got[1]);
    }
  }
  ImageOptions options = colored(ViewColor::strain, ScaleRange::fixed);
  (void)draw(model, state, options, width, height);
  EXPECT_EQ(renderer().range(), default_range(model, ViewColor::strain));
}

TEST_F(Scale, SpeedsOfBallsCount) {
  Model model;
  model.simulation.gravity = {};
  model.balls.push_back({0.5, 1.0, 0, {0.0, 0.0, 0.0}, {7.3, 0.0, 0.0}, {}});
  model.balls.push_back({0.5, 1.0, 0, {2.0, 0.0, 0.0}, {1.9, 0.0, 0.0}, {}});
  (void)draw(model, initial_state(model, Precision::single), colored(ViewColor::speed, ScaleRange::automatic),
             width, height);
  EXPECT_EQ(renderer().range(), range_for(model, colored(ViewColor::speed, ScaleRange::automatic).view,
                                          {static_cast<double>(1.9f), static_cast<double>(7.3f)}));
}

TEST_F(Scale, ActuationIsBlueWhereRestLengthsAreShortAndRedWhereTheyAreLong) {
  ModelSettings settings;
  settings.simulation.gravity = {};
  settings.cubes.emplace_back().particles_per_edge = 4;
  settings.cubes[0].position = {};
  settings.actuators.emplace_back().amplitude = 0.15;
  settings.actuators[0].signal = Signal::input;
  const Model model = test::build(settings);
  EXPECT_EQ(default_range(model, ViewColor::actuation), (QuantityRange{-0.2, 0.2}));
  const State state = initial_state(model, Precision::single);
  const auto shown = [&](double w, ViewColor color) {
    ImageOptions options = colored(color, ScaleRange::automatic);
    options.channels = {w};
    (void)draw(model, state, options, width, height);
    return renderer().range();
  };
  for (const double w : {1.0, -1.0, 0.5}) {
    const auto [low, high] = shown(w, ViewColor::actuation);
    EXPECT_LT(low, 0.15 * w);
    EXPECT_GT(high, 0.15 * w);
    EXPECT_LT(high - low, 1e-3);
  }
  const auto redness = [&](double w) {
    ImageOptions options = colored(ViewColor::actuation, ScaleRange::fixed);
    options.channels = {w};
    const test::Image image = draw(model, state, options, width, height);
    return image.channel(width / 2, height / 2, 0) - image.channel(width / 2, height / 2, 2);
  };
  EXPECT_GT(redness(1.0), redness(0.0) + 40);
  EXPECT_LT(redness(-1.0), redness(0.0) - 40);
  // Springs that are not stretched have the strain of their present rest lengths, and their damping again.
  const auto [low, high] = shown(1.0, ViewColor::signed_strain);
  EXPECT_LT(low, -0.12);
  EXPECT_LT(high, 0.0);
}

TEST_F(Scale, SignedStrainIsBlueWhereShortAndRedWhereLong) {
  const Model model = lonely_cube();
  const auto redness = [&](double by) {
    const test::Image image = draw(model, stretched(model, by),
                                   colored(ViewColor::signed_strain, ScaleRange::fixed), width, height);
    return image.channel(width / 2, height / 2, 0) - image.channel(width / 2, height / 2, 2);
  };
  EXPECT_GT(redness(1.15), redness(1.0) + 40);
  EXPECT_LT(redness(0.85), redness(1.0) - 40);
  // The colors of a scale with its ends exchanged are those of the other sign.
  ImageOptions turned = colored(ViewColor::signed_strain, ScaleRange::fixed);
  turned.view.scale.from = 0.1;
  turned.view.scale.to = -0.1;
  const test::Image image = draw(model, stretched(model, 1.15), turned, width, height);
  EXPECT_LT(image.channel(width / 2, height / 2, 0) - image.channel(width / 2, height / 2, 2),
            redness(1.0) - 40);
}

TEST_F(Scale, EachMapGivesAnotherImage) {
  const Model model = lonely_cube();
  std::vector<std::vector<std::byte>> seen;
  for (const auto& map : scale_maps) {
    ImageOptions options = colored(ViewColor::strain, ScaleRange::automatic);
    options.view.scale.map = map.value;
    auto image = draw(model, stretched(model, 1.1), options, width, height).rgb;
    if (map.value == ScaleMap::violet_yellow)
      EXPECT_EQ(image, seen.front()) << "what automatic stands for";
    else
      for (const auto& other : seen) EXPECT_NE(image, other) << map.name;
    seen.push_back(std::move(image));
  }
}

}  // namespace
}  // namespace aspic

// Signals, what they make of rest lengths, and which springs follow them.
#include "model/actuation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/actuators.h"
#include "model/inputs.h"
#include "model/springs.h"
#include "support/model_building.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Two materials side by side along x, two layers high.
ModelSettings worm() {
  ModelSettings settings;
  settings.materials = {{1000.0, 1e5, 0.1, "muscle"}, {500.0, 3e4, 0.3, "fat"}};
  VoxelsSettings& voxels = settings.voxels.emplace_back();
  voxels.name = "worm";
  voxels.size = 0.25;
  voxels.layers = {{"1122", "1122"}, {"1112", "1.12"}};
  voxels.palette = {{"1", "muscle"}, {"2", "fat"}};
  return settings;
}

ActuatorSettings swelling(double amplitude) {
  ActuatorSettings actuator;
  actuator.amplitude = amplitude;
  actuator.signal = Signal::table;
  actuator.table = {{0.0, 1.0}, {1.0, 1.0}};
  return actuator;
}

Actuator with(Signal signal) {
  Actuator actuator;
  actuator.signal = signal;
  actuator.frequency = 2.0;
  actuator.amplitude = 0.5;
  return actuator;
}

TEST(Signals, SineIsThatOfTheTextbook) {
  for (int n = -4000; n <= 4000; ++n) {
    const double u = n / 997.0;
    EXPECT_NEAR(sine_of_turns(u), std::sin(2.0 * std::numbers::pi * (u - std::floor(u))), 8 * eps) << u;
  }
  for (const double u : {0.0, 0.5, 1.0, -3.0, 1e9}) EXPECT_EQ(sine_of_turns(u), 0.0) << u;
  for (const double u : {0.25, 7.25, -0.75}) EXPECT_EQ(sine_of_turns(u), 1.0) << u;
}

TEST(Signals, HaveTheirShapes) {
  const auto at = [](Signal signal, double theta) { return signal_at(with(signal), theta, 0.0, 9.0); };
  EXPECT_EQ(at(Signal::square, 0.0), 1.0);
  EXPECT_EQ(at(Signal::square, 0.499), 1.0);
  EXPECT_EQ(at(Signal::square, 0.5), -1.0);
  EXPECT_EQ(at(Signal::square, -0.25), -1.0);
  for (const auto& [theta, w] :
       {std::pair{0.0, 0.0}, {0.125, 0.5}, {0.25, 1.0}, {0.5, 0.0}, {0.75, -1.0}, {0.875, -0.5}})
    EXPECT_EQ(at(Signal::triangle, theta), w) << theta;
  EXPECT_EQ(at(Signal::input, 0.3), 9.0) << "an input knows no phase";
  Actuator table = with(Signal::table);
  table.table = {{0.0, 1.0}, {1.0, 3.0}, {1.0, -1.0}, {4.0, 2.0}};
  for (const auto& [theta, w] :
       {std::pair{0.0, 1.0}, {0.5, 2.0}, {1.0, -1.0}, {2.5, 0.5}, {4.0, 1.0}, {4.5, 2.0}, {-1.0, 1.0}})
    EXPECT_EQ(signal_at(table, theta, 0.0, 0.0), w) << theta;
}

TEST(Signals, BeginAtTheirStartAndGrowOverTheRamp) {
  Actuator actuator = with(Signal::square);
  actuator.frequency = 0.0;
  actuator.start = 1.0;
  actuator.ramp = 0.5;
  const auto at = [&](double time) { return signal_at(actuator, 0.0, time, 0.0); };
  EXPECT_EQ(at(0.999), 0.0);
  EXPECT_EQ(at(1.0), 0.0);
  EXPECT_EQ(at(1.25), 0.5);
  EXPECT_EQ(at(1.5), 1.0);
  EXPECT_LT(at(1.0001), 1e-6) << "it begins with no slope";
  actuator.ramp = 0.0;
  EXPECT_EQ(at(1.0), 1.0);
  // The phase counts from the start on.
  Actuator wave = with(Signal::triangle);
  wave.start = 1.0;
  EXPECT_EQ(signal_at(wave, 0.0, 1.125, 0.0), 1.0);
  EXPECT_EQ(signal_at(wave, 0.125, 1.0625, 0.0), 1.0);
}

TEST(Actuation, AllOfACubeStretchesAlike) {
  ModelSettings settings = test::cube_on_plane(4);
  const Model passive = test::build(settings);
  settings.actuators.push_back(swelling(0.25));
  const Model model = test::build(settings);
  EXPECT_FALSE(model.bodies[0].box()) << "its springs are listed";
  const std::vector<Spring> before = all_springs(passive), after = all_springs(model);
  ASSERT_EQ(before.size(), after.size());
  const std::vector<double> r = rest_lengths(model, 7, 0.5, {});
  for (std::size_t s = 0; s < before.size(); ++s) {
    EXPECT_EQ(before[s].a, after[s].a);
    EXPECT_EQ(before[s].b, after[s].b);
    const SpringClass &of = passive.spring_classes[before[s].spring_class],
                      &acted = model.spring_classes[after[s].spring_class];
    EXPECT_EQ(of.rest_length, acted.rest_length);
    EXPECT_EQ(of.stiffness, acted.stiffness);
    EXPECT_EQ(of.type, acted.type);
    EXPECT_EQ(r[after[s].spring_class], of.rest_length * 1.25);
  }
  EXPECT_EQ(count(model).listed, predict_counts(settings).listed);
}

TEST(Actuation, AmplitudeZeroKeepsEveryBitOfRestLengths) {
  ModelSettings settings = worm();
  settings.actuators.push_back(swelling(0.0));
  settings.actuators[0].axis = BodyAxis::y;
  settings.actuators.push_back(swelling(0.0));
  settings.actuators[1].select.materials = {"fat"};
  const Model model = test::build(settings);
  ASSERT_FALSE(model.actuation.empty());
  const std::vector<double> r = rest_lengths(model, 3, 0.0, {});
  for (std::size_t c = 0; c < r.size(); ++c) EXPECT_EQ(r[c], model.spring_classes[c].rest_length);
}

// Stretched along one axis by λ, a body of such rest lengths is at rest as a whole.
TEST(Actuation, AlongAnAxisSpringsHaveTheLengthOfTheStretchedCell) {
  for (const BodyAxis axis : {BodyAxis::x, BodyAxis::y, BodyAxis::z}) {
    ModelSettings settings = worm();
    settings.voxels[0].rotation = {{1.0, 0.3, 0.7}, 40.0};
    settings.actuators.push_back(swelling(0.4));
    settings.actuators[0].axis = axis;
    const Model model = test::build(settings);
    settings.voxels[0].rotation.angle = 0.0;
    const State rest = initial_state(test::build(settings), Precision::double_);
    const std::vector<double> r = rest_lengths(model, 0, 0.0, {});
    for (const Spring& s : all_springs(model)) {
      Vec3 e = rest.position[s.a] - rest.position[s.b];
      e[static_cast<int>(axis) - 1] *= 1.4;
      EXPECT_NEAR(r[s.spring_class], length(e), 8 * eps);
    }
  }
  ModelSettings settings;
  settings.cloths.emplace_back().rotation = {{1.0, 0.2, 0.1}, 70.0};
  settings.actuators.push_back(swelling(0.4));
  settings.actuators[0].axis = BodyAxis::x;
  const Model model = test::build(settings);
  settings.cloths[0].rotation.angle = 0.0;
  const State rest = initial_state(test::build(settings), Precision::double_);
  const std::vector<double> r = rest_lengths(model, 0, 0.0, {});
  for (const Spring& s : all_springs(model)) {
    Vec3 e = rest.position[s.a] - rest.position[s.b];
    e.x *= 1.4;
    EXPECT_NEAR(r[s.spring_class], length(e), 1e-5 * length(e));
  }
}

// Σkᵢ(L − rᵢ) = K(L − R) with R = Σkᵢrᵢ/K.
TEST(Actuation, SharedSpringsHaveTheMeanByStiffness) {
  ModelSettings settings = worm();
  settings.voxels[0].layers = {{"12"}};
  settings.actuators.push_back(swelling(0.2));
  settings.actuators[0].select.materials = {"muscle"};
  const Model model = test::build(settings);
  const State rest = initial_state(model, Precision::double_);
  const std::vector<double> r = rest_lengths(model, 0, 0.0, {});
  int shared = 0;
  for (const Spring& s : all_springs(model)) {
    const double xa = rest.position[s.a].x, xb = rest.position[s.b].x;
    const double r0 = model.spring_classes[s.spring_class].rest_length;
    const bool left = std::min(xa, xb)<-0.1, right = std::max(xa, xb)> 0.1;
    const bool across = left && right, between = !left && !right;
    // Springs of both cells: in the face between them, and over two steps along the row.
    const double share = across || between ? 1e5 / (1e5 + 3e4) : left ? 1.0 : 0.0;
    EXPECT_NEAR(r[s.spring_class], r0 * (1.0 + 0.2 * share), 4 * eps);
    shared += across || between;
  }
  EXPECT_EQ(shared, 6 + 4);
}

TEST(Actuation, SelectsByMaterialBoxMaskAndType) {
  const auto acted = [](const ActuatorSettings& actuator) {
    ModelSettings settings = worm();
    settings.actuators.push_back(actuator);
    const Model model = test::build(settings);
    const std::vector<double> r = rest_lengths(model, 0, 0.0, {});
    std::size_t n = 0;
    for (const Spring& s : all_springs(model))
      n += r[s.spring_class] > model.spring_classes[s.spring_class].rest_length;
    return n;
  };
  const std::size_t all = acted(swelling(0.1));
  ModelSettings settings = worm();
  EXPECT_EQ(all, count(test::build(settings)).springs());
  ActuatorSettings by_material = swelling(0.1), by_box = by_material, by_mask = by_material,
                   by_type = by_material;
  by_material.select.materials = {"fat"};
  by_box.select.box = BoxSettings{{0.2, -9.0, -9.0}, {9.0, 9.0, 9.0}};
  by_mask.select.voxels = {{"...1", "...1"}, {"...1", "...1"}};
  EXPECT_EQ(acted(by_box), acted(by_mask)) << "middles of cells from the body's center";
  EXPECT_LT(acted(by_box), acted(by_material));
  by_type.select.springs = {"bending"};
  EXPECT_EQ(acted(by_type), count(test::build(settings)).bending);
  ActuatorSettings turned = by_box;
  settings.voxels[0].rotation = {{0.0, 1.0, 0.0}, 180.0};
  settings.voxels[0].position = {5.0, 5.0, 5.0};
  settings.actuators = {turned};
  const Model model = test::build(settings);
  EXPECT_EQ(acted(turned), static_cast<std::size_t>(std::ranges::count_if(
                               all_springs(model),
                               [&](const Spring& s) {
                                 return rest_lengths(model, 0, 0.0, {})[s.spring_class] >
                                        model.spring_classes[s.spring_class].rest_length;
                               })))
      << "the body's own frame";
}

// A wave of length λ runs along +x at the speed λ·f: at x it is where it was at 0 a time x/(λf) ago.
TEST(Actuation, PhaseAlongAnAxisIsAWaveThatRunsThere) {
  ModelSettings settings = worm();
  settings.voxels[0].layers = {{"11111111"}};
  settings.simulation.timestep = 0.001;
  ActuatorSettings& actuator = settings.actuators.emplace_back();
  actuator.phase = {0.1, BodyAxis::x, 2.0, {}};
  actuator.frequency = 5.0;
  const Model model = test::build(settings);
  ASSERT_EQ(model.actuation.drives.size(), 8u);
  RestLengths lengths(model);
  for (const double share : {0.0, 0.5}) {
    lengths.at(40, share, {});
    for (std::size_t cell = 0; cell < 8; ++cell) {
      const double x = 0.25 * (static_cast<double>(cell) - 3.5), t = 0.001 * (40 + share);
      const double w = std::sin(2.0 * std::numbers::pi * (5.0 * (t - x / (2.0 * 5.0)) + 0.1));
      EXPECT_NEAR(lengths.signals()[cell], w, 1e-14) << cell;
    }
  }
}

TEST(Actuation, PhasesByCell) {
  ModelSettings settings = worm();
  settings.voxels[0].layers = {{"112"}};
  ActuatorSettings& actuator = settings.actuators.emplace_back();
  actuator.phase.cells = "3 1 1: 0.25 0.75 0.25";
  actuator.frequency = 0.0;
  actuator.amplitude = 0.5;
  const Model model = test::build(settings);
  RestLengths lengths(model);
  lengths.at(0, 0.0, {});
  EXPECT_THAT(lengths.signals(), ElementsAre(1.0, -1.0)) << "cells of one phase share a drive";
}

TEST(Actuation, VolumeChangeIsThatOfACell) {
  ActuatorSettings actuator;
  actuator.volume_change = 0.5;
  EXPECT_NEAR(amplitude_of(actuator), std::cbrt(1.5) - 1.0, 2 * eps);
  actuator.axis = BodyAxis::z;
  EXPECT_EQ(amplitude_of(actuator), 0.5);
  actuator.axis = BodyAxis::none;
  for (const double v : {-0.9, 0.0, 1e-6, 6.8}) {
    actuator.volume_change = v;
    EXPECT_NEAR(std::pow(1.0 + amplitude_of(actuator), 3.0), 1.0 + v, 8 * eps * (1.0 + v)) << v;
  }
}

TEST(Actuation, SeveralAddUpAndCellsNeverVanish) {
  ModelSettings settings = test::cube_on_plane(2);
  settings.actuators = {swelling(0.3), swelling(-0.1)};
  EXPECT_NEAR(rest_lengths(test::build(settings), 0, 0.0, {}).back() /
                  test::build(settings).spring_classes.back().rest_length,
              1.2, 2 * eps);
  settings.actuators = {swelling(0.5)};
  settings.actuators[0].signal = Signal::input;
  const Model model = test::build(settings);
  const double r0 = model.spring_classes.back().rest_length;
  EXPECT_EQ(rest_lengths(model, 0, 0.0, {}).back(), r0) << "a channel that is not there is 0";
  EXPECT_EQ(rest_lengths(model, 0, 0.0, std::array{0.5}).back(), 1.25 * r0);
  EXPECT_NEAR(rest_lengths(model, 0, 0.0, std::array{-70.0}).back(), least_stretch * r0, 2 * eps * r0);
}

TEST(Actuation, RangesHoldWhatSignalsMake) {
  ModelSettings settings = worm();
  settings.actuators.emplace_back().select.materials = {"muscle"};
  settings.actuators.push_back(swelling(0.3));
  settings.actuators[1].axis = BodyAxis::x;
  const Model model = test::build(settings);
  const std::vector<LengthRange> ranges = rest_length_ranges(model);
  for (const std::uint64_t step : {0u, 100u, 250u, 750u}) {
    const std::vector<double> r = rest_lengths(model, step, 0.0, {});
    for (std::size_t c = 0; c < r.size(); ++c) {
      EXPECT_GE(r[c], ranges[c].least - eps);
      EXPECT_LE(r[c], ranges[c].most + eps);
    }
  }
}

TEST(Actuation, ConstantsMayChangeAndStructureMayNot) {
  ModelSettings settings = worm();
  ActuatorSettings& actuator = settings.actuators.emplace_back();
  actuator.phase.along = BodyAxis::x;
  const Model before = test::build(settings);
  actuator.amplitude = 0.3;
  actuator.frequency = 4.0;
  actuator.phase.wavelength = -0.7;
  actuator.phase.offset = 0.2;
  actuator.signal = Signal::square;
  actuator.start = 0.1;
  settings.materials[0].youngs_modulus = 5e4;
  EXPECT_TRUE(check_same_topology(before, test::build(settings)).ok());
  actuator.phase.along = BodyAxis::none;
  EXPECT_FALSE(check_same_topology(before, test::build(settings)).ok());
  settings.actuators.clear();
  EXPECT_FALSE(check_same_topology(before, test::build(settings)).ok());
}

TEST(Actuation, ChannelsAreThoseOfActuatorsWithInputs) {
  ModelSettings settings = worm();
  settings.actuators.resize(3);
  settings.actuators[0].signal = settings.actuators[2].signal = Signal::input;
  settings.actuators[2].name = "legs";
  const Model model = test::build(settings);
  EXPECT_THAT(input_names(model), ElementsAre("actuator[0]", "legs"));
  EXPECT_EQ(model.actuation.actuators[2].channel, 1u);
  EXPECT_TRUE(rounded_inputs(model, {.channels = {0.1, 0.2}}, Precision::single).ok());
  const auto refused = rounded_inputs(model, {.channels = {0.1, 0.2, 0.3}}, Precision::single);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().what,
              HasSubstr("channels[2]: the scene reads 2 channels: that of actuator[0], legs"));
  settings.actuators.resize(2);
  settings.actuators[0].signal = Signal::sine;
  EXPECT_THAT(rounded_inputs(test::build(settings), {.channels = {0.1}}, Precision::single).error().what,
              HasSubstr("no channel has an effect"));
}

TEST(Actuation, FaultsSayWhatIsWrong) {
  const auto fault = [](const ActuatorSettings& actuator) {
    ModelSettings settings = worm();
    settings.cloths.emplace_back();
    settings.actuators.push_back(actuator);
    const auto found = fault_of(settings, 0);
    return found ? found->key + ": " + found->message : std::string("none");
  };
  ActuatorSettings good;
  good.bodies = {"worm"};
  EXPECT_EQ(fault(good), "none");
  EXPECT_EQ(fault(ActuatorSettings()), "none");
  ActuatorSettings bad = good;
  bad.bodies = {"voxels[0]", "snake"};
  EXPECT_THAT(fault(bad),
              HasSubstr("body: there is no body \"snake\" of particles; the scene has worm, cloth[0]"));
  bad.bodies = {"worm", "voxels[0]"};
  EXPECT_THAT(fault(bad), HasSubstr("listed twice"));
  bad = good;
  bad.select.materials = {"bone"};
  EXPECT_THAT(fault(bad), HasSubstr("select.material: it names the material \"bone\""));
  bad = good;
  bad.select.box = BoxSettings{{5.0, 5.0, 5.0}, {6.0, 6.0, 6.0}};
  EXPECT_THAT(fault(bad), HasSubstr("select: it selects no cell of worm"));
  bad = good;
  bad.select.voxels = {{"11"}};
  EXPECT_THAT(fault(bad),
              HasSubstr("select.voxels: it has 2 × 1 × 1 cells along x, y and z, and worm has 4 × 2 × 2"));
  bad = good;
  bad.phase.cells = "4 2 2: 1";
  EXPECT_THAT(fault(bad), HasSubstr("phase.cells: it is not a list"));
  bad = good;
  bad.bodies = {"cloth[0]"};
  bad.phase.cells = "1 1 1: 1";
  EXPECT_THAT(fault(bad), HasSubstr("cloth[0] has no cells"));
  bad = good;
  bad.amplitude = -1.5;
  EXPECT_THAT(fault(bad), HasSubstr("amplitude: rest lengths would fall to -0.5"));
  bad.signal = Signal::input;
  EXPECT_EQ(fault(bad), "none");
  bad = good;
  bad.signal = Signal::table;
  bad.table = {{0.0, 0.0}, {2.0, 1.0}, {1.0, 0.0}};
  EXPECT_THAT(fault(bad), HasSubstr("table: times must ascend, and 1 follows 2"));
  bad.table = {{0.5, 0.0}, {1.0, 0.0}};
  EXPECT_THAT(fault(bad), HasSubstr("must be 0"));
  bad = good;
  bad.phase = {0.0, BodyAxis::x, 0.0, {}};
  EXPECT_THAT(fault(bad), HasSubstr("phase.wavelength"));
}

TEST(CellText, ComesBackAsItWas) {
  const CellNumbers cells = {{2, 1, 3}, {0.1, -2.5, 1e-300, 7.0, 0.0, 1.0 / 3.0}};
  const auto again = cell_numbers(to_cell_text(cells));
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->count, cells.count);
  EXPECT_EQ(again->numbers, cells.numbers);
  for (const char* const wrong : {"", "1 1: 1", "1 1 1 1", "1 1 1:", "1 1 1: x", "1 1 1: nan", "1 1 1: 1 2",
                                  "0 1 1:", "4095 4095 4095: 1", "-1 1 1: 1"})
    EXPECT_FALSE(cell_numbers(wrong).has_value()) << wrong;
}

}  // namespace
}  // namespace aspic

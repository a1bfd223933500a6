#include "render/quantity.h"

#include <algorithm>
#include <cmath>

#include "model/actuation.h"
#include "model/terrain.h"
#include "render/light_maps.h"
#include "render/overlay_text.h"
#include "render/section.h"

namespace aspic {
namespace {

double fall_height(const Model& model) {
  double highest = 0.0;
  const auto add = [&](const Vec3& x) {
    double least = model.terrain.empty() ? 0.0 : 1e300;
    for (const Terrain& t : model.terrain) least = std::min(least, signed_distance(t, x));
    highest = std::max(highest, least);
  };
  for (const Vec3& x : model.initial_position) add(x);
  for (const Ball& ball : model.balls) add(ball.initial_position);
  return highest;
}

struct ScaleWords {
  ViewColor color;
  std::string_view title, unit;
  double unit_size;
};
constexpr ScaleWords scales[] = {
    {ViewColor::strain, "strain of the springs", " %", 0.01},
    {ViewColor::signed_strain, "strain: − shortened, + stretched", " %", 0.01},
    {ViewColor::force, "force of the springs", " N", 1.0},
    {ViewColor::energy, "energy of the springs", " J", 1.0},
    {ViewColor::speed, "speed", " m/s", 1.0},
    {ViewColor::actuation, "rest lengths: − shortened, + stretched", " %", 0.01}};

Legend scale(const ScaleWords& words, const ViewSettings& view, const QuantityRange& range) {
  Legend legend;
  legend.title = words.title;
  legend.map = chosen_map(view);
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = range[0] + 0.5 * static_cast<double>(i) * (range[1] - range[0]);
    legend.marks[i] = short_number(value / words.unit_size) + std::string(words.unit);
  }
  if (follows_image(view)) return legend;
  // Values past an end take its color.
  const std::size_t low = range[1] < range[0] ? 1 : 0, high = 1 - low;
  legend.marks[2 * high] = "≥ " + legend.marks[2 * high];
  if (range[low] != 0.0 || has_sign(view.color)) legend.marks[2 * low] = "≤ " + legend.marks[2 * low];
  return legend;
}

/// As far as actuators change any rest length, both ways; a tenth where there are none.
QuantityRange actuation_range(const Model& model) {
  double most = 0.0;
  const std::vector<LengthRange> ranges = rest_length_ranges(model);
  for (std::size_t c = 0; c < ranges.size(); ++c) {
    const double rest = model.spring_classes[c].rest_length;
    most = std::max({most, ranges[c].most / rest - 1.0, 1.0 - ranges[c].least / rest});
  }
  const double end = most > 1e-9 ? round_up(most) : 0.1;
  return {-end, end};
}

/// The smallest round ends that hold both numbers, low < high.
QuantityRange round_ends(double low, double high) {
  const double step = round_up(0.1 * (high - low));
  // Sums of steps miss round numbers by a few units of the last place.
  return {step * std::floor(low / step + 1e-9), step * std::ceil(high / step - 1e-9)};
}

}  // namespace

double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0, 10.0}) {
    if (step * power >= value * (1.0 - 1e-12)) return step * power;
  }
  return 10.0 * power;
}

QuantityRange default_range(const Model& model, ViewColor color) {
  if (color == ViewColor::strain) return {0.0, 0.2};
  if (color == ViewColor::signed_strain) return {-0.1, 0.1};
  if (color == ViewColor::actuation) return actuation_range(model);
  double largest = color == ViewColor::energy ? 1e-3 : 1.0;
  if (color == ViewColor::speed) {
    largest = std::max(largest, std::sqrt(2.0 * length(model.simulation.gravity) * fall_height(model)));
    for (const Vec3& v : model.initial_velocity) largest = std::max(largest, length(v));
    for (const Ball& ball : model.balls) largest = std::max(largest, length(ball.initial_velocity));
  }
  for (const SpringClass& c : model.spring_classes) {
    const double stretch = 0.1 * c.rest_length;
    if (color == ViewColor::force) largest = std::max(largest, c.stiffness * stretch);
    if (color == ViewColor::energy) largest = std::max(largest, 0.5 * c.stiffness * stretch * stretch);
  }
  return {0.0, round_up(largest)};
}

bool follows_image(const ViewSettings& view) {
  return has_scale(view.color) && view.scale.range != ScaleRange::fixed;
}

bool share_scale(const ViewSettings& a, const ViewSettings& b) {
  return has_scale(a.color) && a.color == b.color && a.scale == b.scale;
}

QuantityRange widest(const QuantityRange& a, const QuantityRange& b) {
  return {std::min(a[0], b[0]), std::max(a[1], b[1])};
}

QuantityRange range_for(const Model& model, const ViewSettings& view, const QuantityRange& seen) {
  const QuantityRange of_model = default_range(model, view.color);
  if (!has_scale(view.color)) return of_model;
  if (view.scale.range == ScaleRange::fixed)
    return {view.scale.from.value_or(of_model[0]), view.scale.to.value_or(of_model[1])};
  auto [low, high] = seen;
  if (!std::isfinite(low) || !std::isfinite(high) || low > high) return of_model;
  const double least = 1e-3 * (of_model[1] - of_model[0]);
  if (view.scale.range == ScaleRange::symmetric) {
    const double end = round_up(std::max({0.5 * least, std::abs(low), std::abs(high)}));
    return {-end, end};
  }
  if (high - low < least) {
    low = of_model[0] < 0.0 ? low - 0.5 * least : std::max(low - 0.5 * least, 0.0);
    high = low + least;
  }
  return round_ends(low, high);
}

Legend legend_for(const ViewSettings& view, const QuantityRange& range) {
  const auto words = std::ranges::find(scales, view.color, &ScaleWords::color);
  if (words != std::end(scales)) return scale(*words, view, range);
  const DrawSettings draw = drawn_springs(view);
  Legend legend;
  for (const SpringType type : {SpringType::structural, SpringType::shear, SpringType::bending})
    if (draws(draw, type)) legend.entries.push_back({spring_color(type), std::string(name_of(type))});
  if (!legend.entries.empty()) legend.title = "springs";
  return legend;
}

}  // namespace aspic

#include "render/quantity.h"

#include <algorithm>
#include <cmath>

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

Legend scale(std::string title, const QuantityRange& range, double unit_size, std::string_view unit) {
  Legend legend;
  legend.title = std::move(title);
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = range[0] + 0.5 * static_cast<double>(i) * (range[1] - range[0]);
    legend.marks[i] = short_number(value / unit_size) + std::string(unit);
  }
  // Values past the upper end take its colour.
  legend.marks[2] = "≥ " + legend.marks[2];
  return legend;
}

}  // namespace

double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0, 10.0}) {
    if (step * power >= value * (1.0 - 1e-12)) return step * power;
  }
  return 10.0 * power;
}

QuantityRange default_range(const Model& model, ViewColour colour) {
  if (colour == ViewColour::strain) return {0.0, 0.2};
  double largest = 1.0;
  if (colour == ViewColour::speed) {
    largest = std::max(largest, std::sqrt(2.0 * length(model.simulation.gravity) * fall_height(model)));
    for (const Vec3& v : model.initial_velocity) largest = std::max(largest, length(v));
    for (const Ball& ball : model.balls) largest = std::max(largest, length(ball.initial_velocity));
  }
  if (colour == ViewColour::force) {
    for (const SpringClass& c : model.spring_classes)
      largest = std::max(largest, 0.1 * c.stiffness * c.rest_length);
  }
  return {0.0, round_up(largest)};
}

Legend legend_for(const ViewSettings& view, const QuantityRange& range) {
  if (view.colour == ViewColour::strain) return scale("strain of the springs", range, 0.01, " %");
  if (view.colour == ViewColour::force) return scale("force of the springs", range, 1.0, " N");
  if (view.colour == ViewColour::speed) return scale("speed", range, 1.0, " m/s");
  const DrawSettings draw = drawn_springs(view);
  Legend legend;
  for (const SpringType type : {SpringType::structural, SpringType::shear, SpringType::bending})
    if (draws(draw, type)) legend.entries.push_back({spring_colour(type), std::string(name_of(type))});
  if (!legend.entries.empty()) legend.title = "springs";
  return legend;
}

}  // namespace aspic

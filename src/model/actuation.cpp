#include "model/actuation.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/model.h"

namespace aspic {
namespace {

/// sin y and cos y for |y| ≤ π/4: their series, whose next term is below 1e-19.
double sine_series(double y) {
  const double z = y * y;
  double sum = 1.0;
  for (int n = 18; n >= 2; n -= 2) sum = 1.0 - sum * (z * (1.0 / (n * (n + 1.0))));
  return y * sum;
}
double cosine_series(double y) {
  const double z = y * y;
  double sum = 1.0;
  for (int n = 18; n >= 2; n -= 2) sum = 1.0 - sum * (z * (1.0 / (n * (n - 1.0))));
  return sum;
}

/// Between the points of a table that is `theta` periods old.
double table_at(const SignalTable& table, double theta) {
  if (table.empty()) return 0.0;
  const double length = table.back()[0];
  const double u = length > 0.0 ? theta - std::floor(theta / length) * length : 0.0;
  const auto after = std::ranges::upper_bound(table, u, {}, [](const auto& point) { return point[0]; });
  if (after == table.begin()) return table.front()[1];
  if (after == table.end()) return table.back()[1];
  const auto& [t0, w0] = *std::prev(after);
  const auto& [t1, w1] = *after;
  return w0 + (w1 - w0) * ((u - t0) / (t1 - t0));
}

double course_of(const Actuator& actuator, double theta) {
  const double u = theta - std::floor(theta);
  switch (actuator.signal) {
    case Signal::sine:
      return sine_of_turns(u);
    case Signal::square:
      return u < 0.5 ? 1.0 : -1.0;
    case Signal::triangle:
      return u < 0.25 ? 4.0 * u : u < 0.75 ? 2.0 - 4.0 * u : 4.0 * u - 4.0;
    case Signal::table:
      return table_at(actuator.table, theta);
    case Signal::input:
      break;
  }
  return 0.0;
}

/// λ − 1 of a spring's direction.
double along(const std::array<double, 3>& e, const std::array<double, 3>& squares) {
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) sum += squares[axis] * (e[axis] * (2.0 + e[axis]));
  return std::sqrt(1.0 + sum) - 1.0;
}

}  // namespace

double sine_of_turns(double u) {
  u = u - std::floor(u);
  const double quarters = std::floor(4.0 * u + 0.5);
  const double y = 2.0 * std::numbers::pi * (u - 0.25 * quarters);
  switch (static_cast<int>(quarters)) {
    case 1:
      return cosine_series(y);
    case 2:
      return -sine_series(y);
    case 3:
      return -cosine_series(y);
    default:
      return sine_series(y);
  }
}

double signal_at(const Actuator& actuator, double phase, double time, double channel) {
  const double since = time - actuator.start;
  if (since < 0.0) return 0.0;
  const double w =
      actuator.signal == Signal::input ? channel : course_of(actuator, actuator.frequency * since + phase);
  if (!(since < actuator.ramp)) return w;
  const double part = since / actuator.ramp;
  return w * (part * part * (3.0 - 2.0 * part));
}

std::uint64_t Actuation::bytes() const {
  const auto heap = [](const auto& list) {
    return list.capacity() * sizeof(typename std::decay_t<decltype(list)>::value_type);
  };
  std::uint64_t sum = heap(actuators) + heap(drives) + heap(stretches) + heap(shares) + heap(classes);
  for (const CellStretch& stretch : stretches) sum += heap(stretch.drives);
  return sum;
}

bool same_structure(const Actuation& a, const Actuation& b) {
  const auto same_actuator = [](const Drive& one, const Drive& other) {
    return one.actuator == other.actuator;
  };
  const auto same_stretch = [](const StretchShare& one, const StretchShare& other) {
    return one.stretch == other.stretch;
  };
  const auto same_class = [](const ActuatedClass& one, const ActuatedClass& other) {
    return one.spring_class == other.spring_class && one.first_share == other.first_share &&
           one.share_count == other.share_count;
  };
  return a.actuators.size() == b.actuators.size() && a.stretches == b.stretches &&
         std::ranges::equal(a.drives, b.drives, same_actuator) &&
         std::ranges::equal(a.shares, b.shares, same_stretch) &&
         std::ranges::equal(a.classes, b.classes, same_class);
}

RestLengths::RestLengths(const Model& model)
    : model_(&model),
      signals_(model.actuation.drives.size()),
      cells_(model.actuation.stretches.size()),
      lengths_(model.actuation.classes.size()) {}

std::span<const double> RestLengths::at(std::uint64_t step, double share, std::span<const double> channels) {
  const Actuation& all = model_->actuation;
  const double time = model_->simulation.timestep * (static_cast<double>(step) + share);
  for (std::size_t d = 0; d < signals_.size(); ++d) {
    const Actuator& actuator = all.actuators[all.drives[d].actuator];
    const double channel = actuator.channel < channels.size() ? channels[actuator.channel] : 0.0;
    signals_[d] = signal_at(actuator, all.drives[d].phase, time, channel);
  }
  for (std::size_t s = 0; s < cells_.size(); ++s) {
    Cells& cells = cells_[s] = {};
    for (const std::uint32_t d : all.stretches[s].drives) {
      const Actuator& actuator = all.actuators[all.drives[d].actuator];
      const double more = actuator.amplitude * signals_[d];
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (actuator.axis == BodyAxis::none || static_cast<std::size_t>(actuator.axis) == axis + 1)
          cells.e[axis] += more;
      cells.same = cells.same && actuator.axis == BodyAxis::none;
    }
    for (double& e : cells.e) e = std::max(e, least_stretch - 1.0);
  }
  for (std::size_t n = 0; n < lengths_.size(); ++n) {
    const ActuatedClass& of = all.classes[n];
    double sum = 0.0;
    for (std::uint32_t k = of.first_share; k < of.first_share + of.share_count; ++k) {
      const Cells& cells = cells_[all.shares[k].stretch];
      sum += all.shares[k].share * (cells.same ? cells.e[0] : along(cells.e, of.squares));
    }
    lengths_[n] = model_->spring_classes[of.spring_class].rest_length * (1.0 + sum);
  }
  return lengths_;
}

std::vector<double> rest_lengths(const Model& model, std::uint64_t step, double share,
                                 std::span<const double> channels) {
  std::vector<double> all;
  for (const SpringClass& each : model.spring_classes) all.push_back(each.rest_length);
  RestLengths lengths(model);
  std::size_t n = 0;
  for (const double r : lengths.at(step, share, channels)) all[model.actuation.classes[n++].spring_class] = r;
  return all;
}

std::vector<LengthRange> rest_length_ranges(const Model& model) {
  std::vector<LengthRange> ranges;
  for (const SpringClass& each : model.spring_classes) ranges.push_back({each.rest_length, each.rest_length});
  const Actuation& all = model.actuation;
  // Every way each cell may stretch, least and most.
  std::vector<std::array<std::array<double, 3>, 2>> ends;
  for (const CellStretch& stretch : all.stretches) {
    auto& [least, most] = ends.emplace_back();
    for (const std::uint32_t d : stretch.drives) {
      const Actuator& actuator = all.actuators[all.drives[d].actuator];
      double low = -1.0, high = 1.0;
      if (actuator.signal == Signal::table && !actuator.table.empty()) {
        const auto w = [](const auto& point) { return point[1]; };
        low = std::min(0.0, w(*std::ranges::min_element(actuator.table, {}, w)));
        high = std::max(0.0, w(*std::ranges::max_element(actuator.table, {}, w)));
      }
      const auto [less, more] = std::minmax({actuator.amplitude * low, actuator.amplitude * high});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (actuator.axis != BodyAxis::none && static_cast<std::size_t>(actuator.axis) != axis + 1) continue;
        least[axis] += less;
        most[axis] += more;
      }
    }
    for (auto* const end : {&least, &most})
      for (double& e : *end) e = std::max(e, least_stretch - 1.0);
  }
  for (const ActuatedClass& of : all.classes) {
    const double r = model.spring_classes[of.spring_class].rest_length;
    const bool one_way = of.squares[0] + of.squares[1] + of.squares[2] > 0.0;
    double sums[2] = {};
    for (std::uint32_t k = of.first_share; k < of.first_share + of.share_count; ++k)
      for (std::size_t end = 0; end < 2; ++end) {
        const auto& e = ends[all.shares[k].stretch][end];
        sums[end] += all.shares[k].share * (one_way ? along(e, of.squares) : e[0]);
      }
    ranges[of.spring_class] = {r * (1.0 + sums[0]), r * (1.0 + sums[1])};
  }
  return ranges;
}

}  // namespace aspic

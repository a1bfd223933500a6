#include "playback/history.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace aspic {

void History::clear() {
  // Numbers continue, so that no moment of the old run is taken for one of the new.
  first_number_ += stretches_.size();
  stretches_.clear();
}

void History::begin(const Setup& setup, const State& state, bool same) {
  Keyframes kept;
  if (!empty() && last().first == last().last && last().keyframes.count() == 1) {
    if (same && last().first == state.step) kept = std::move(last().keyframes);
    stretches_.pop_back();
  }
  stretches_.push_back({setup, state.step, state.step, std::move(kept), {}});
  add_keyframe(state);
}

void History::reach(std::uint64_t step) {
  last().last = std::max(last().last, step);
}

void History::add_keyframe(const State& state) {
  if (!last().keyframes.add(state)) return;
  reach(state.step);
  while (bytes() > most_bytes_ && keyframe_count() > 1) drop_oldest();
}

void History::set_inputs(std::uint64_t step, Inputs inputs) {
  last().inputs.set(step, std::move(inputs));
}

void History::thin(std::uint64_t bytes) {
  most_bytes_ = bytes;
  while (this->bytes() > bytes && keyframe_count() > stretches_.size()) {
    for (Stretch& stretch : stretches_) stretch.keyframes.thin();
  }
  while (this->bytes() > bytes && keyframe_count() > 1) drop_oldest();
}

void History::drop_oldest() {
  Stretch& oldest = stretches_.front();
  oldest.keyframes.drop_first();
  if (!oldest.keyframes.empty()) {
    oldest.first = oldest.keyframes.front().step;
    return;
  }
  stretches_.pop_front();
  ++first_number_;
}

void History::truncate(const Moment& moment) {
  while (end_moment().stretch > moment.stretch) stretches_.pop_back();
  Stretch& stretch = last();
  stretch.last = std::min(stretch.last, moment.step);
  stretch.keyframes.forget_after(moment.step);
  // What begins with the step from `moment` on belongs to what is forgotten.
  stretch.inputs.forget_from(moment.step);
}

Moment History::begin_moment() const {
  return {first_number_, stretches_.front().first};
}

Moment History::end_moment() const {
  return {first_number_ + stretches_.size() - 1, stretches_.back().last};
}

const Stretch& History::stretch(std::uint64_t number) const {
  assert(number >= first_number_ && number - first_number_ < stretches_.size());
  return stretches_[static_cast<std::size_t>(number - first_number_)];
}

Moment History::canonical(Moment moment) const {
  while (moment.stretch < end_moment().stretch && moment.step >= stretch(moment.stretch).last) {
    ++moment.stretch;
    moment.step = stretch(moment.stretch).first;
  }
  return moment;
}

std::optional<Moment> History::before(const Moment& moment) const {
  Moment m = moment;
  while (m.step <= stretch(m.stretch).first) {
    if (m.stretch == first_number_) return std::nullopt;
    --m.stretch;
    m.step = stretch(m.stretch).last;
  }
  --m.step;
  return m;
}

std::optional<Moment> History::after(const Moment& moment) const {
  Moment m = canonical(moment);
  if (m == end_moment()) return std::nullopt;
  ++m.step;
  return canonical(m);
}

Moment History::nearest(double time) const {
  Moment m = begin_moment();
  while (m.stretch < end_moment().stretch && time > stretch(m.stretch).time(stretch(m.stretch).last)) {
    ++m.stretch;
    m.step = stretch(m.stretch).first;
  }
  const Stretch& s = stretch(m.stretch);
  m.step = static_cast<std::uint64_t>(
      std::clamp(std::round(time / s.timestep()), static_cast<double>(s.first), static_cast<double>(s.last)));
  return canonical(m);
}

const Keyframe& History::keyframe(const Moment& moment) const {
  return stretch(moment.stretch).keyframes.before(moment.step);
}

Moment History::keyframes_before(const Moment& moment, std::size_t count) const {
  Moment m = moment;
  for (std::size_t n = 0; n < count; ++n) {
    const auto earlier = before(m);
    if (!earlier) break;
    m = {earlier->stretch, keyframe(*earlier).step};
  }
  return m;
}

const Inputs& History::inputs_at(const Moment& moment) const {
  return stretch(moment.stretch).inputs.at(moment.step);
}

std::optional<std::uint64_t> History::next_input_change(const Moment& moment) const {
  return stretch(moment.stretch).inputs.next_change(moment.step);
}

std::vector<double> History::changes() const {
  std::vector<double> times;
  for (std::size_t i = 1; i < stretches_.size(); ++i)
    times.push_back(stretches_[i].time(stretches_[i].first));
  return times;
}

std::uint64_t History::bytes() const {
  std::uint64_t sum = 0;
  for (const Stretch& s : stretches_) sum += s.bytes();
  return sum;
}

std::size_t History::keyframe_count() const {
  std::size_t count = 0;
  for (const Stretch& s : stretches_) count += s.keyframes.count();
  return count;
}

}  // namespace aspic

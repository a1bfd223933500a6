#include "playback/keyframes.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace aspic {

Keyframe pack(const State& state) {
  assert(state.precision == Precision::single);
  Keyframe k;
  k.step = state.step;
  k.particles = static_cast<std::uint32_t>(state.position.size());
  k.balls = static_cast<std::uint32_t>(state.ball_position.size());
  k.numbers.reserve(numbers_of(StateCarrier::particle) * k.particles +
                    numbers_of(StateCarrier::ball) * k.balls);
  for_each_vector(state, [&](const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) k.numbers.push_back(static_cast<float>(v[axis]));
  });
  return k;
}

State unpack(const Keyframe& keyframe) {
  State s;
  s.precision = Precision::single;
  s.step = keyframe.step;
  resize(s, keyframe.particles, keyframe.balls);
  const float* number = keyframe.numbers.data();
  for_each_vector(s, [&](Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<double>(*number++);
  });
  return s;
}

bool Keyframes::add(const State& state) {
  if (!frames_.empty() && frames_.back().step >= state.step) return false;
  frames_.push_back(pack(state));
  return true;
}

const Keyframe& Keyframes::before(std::uint64_t step) const {
  const auto later = std::ranges::upper_bound(frames_, step, {}, &Keyframe::step);
  assert(later != frames_.begin());
  return *(later - 1);
}

void Keyframes::thin() {
  std::deque<Keyframe> fewer;
  for (std::size_t i = 0; i < frames_.size(); i += 2) fewer.push_back(std::move(frames_[i]));
  frames_ = std::move(fewer);
}

void Keyframes::forget_after(std::uint64_t step) {
  while (frames_.size() > 1 && frames_.back().step > step) frames_.pop_back();
}

}  // namespace aspic

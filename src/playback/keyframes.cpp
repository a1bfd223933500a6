#include "playback/keyframes.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace aspic {

Keyframe pack(const State& state) {
  Keyframe k;
  k.step = state.step;
  k.particles = static_cast<std::uint32_t>(state.position.size());
  k.balls = static_cast<std::uint32_t>(state.ball_position.size());
  if (state.precision == Precision::double_) k.numbers = std::vector<double>();
  std::visit(
      [&]<class T>(std::vector<T>& numbers) {
        numbers.reserve(numbers_of(StateCarrier::particle) * k.particles +
                        numbers_of(StateCarrier::ball) * k.balls);
        for_each_vector(state, [&](const Vec3& v) {
          for (int axis = 0; axis < 3; ++axis) numbers.push_back(static_cast<T>(v[axis]));
        });
      },
      k.numbers);
  return k;
}

std::uint64_t Keyframe::bytes() const {
  return sizeof(Keyframe) +
         std::visit([](const auto& all) -> std::uint64_t { return all.size() * sizeof(all[0]); }, numbers);
}

State unpack(const Keyframe& keyframe) {
  State s;
  s.precision = keyframe.numbers.index() == 0 ? Precision::single : Precision::double_;
  s.step = keyframe.step;
  resize(s, keyframe.particles, keyframe.balls);
  std::visit(
      [&](const auto& numbers) {
        auto number = numbers.begin();
        for_each_vector(s, [&](Vec3& v) {
          for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<double>(*number++);
        });
      },
      keyframe.numbers);
  return s;
}

bool Keyframes::add(const State& state) {
  if (!frames_.empty() && frames_.back().step >= state.step) return false;
  frames_.push_back(pack(state));
  bytes_ += frames_.back().bytes();
  return true;
}

const Keyframe& Keyframes::before(std::uint64_t step) const {
  const auto later = std::ranges::upper_bound(frames_, step, {}, &Keyframe::step);
  assert(later != frames_.begin());
  return *(later - 1);
}

void Keyframes::drop_first() {
  bytes_ -= frames_.front().bytes();
  frames_.pop_front();
}

void Keyframes::thin() {
  std::deque<Keyframe> all = std::exchange(frames_, {});
  bytes_ = 0;
  for (std::size_t i = 0; i < all.size(); i += 2) {
    bytes_ += all[i].bytes();
    frames_.push_back(std::move(all[i]));
  }
}

void Keyframes::forget_after(std::uint64_t step) {
  while (frames_.size() > 1 && frames_.back().step > step) {
    bytes_ -= frames_.back().bytes();
    frames_.pop_back();
  }
}

}  // namespace aspic

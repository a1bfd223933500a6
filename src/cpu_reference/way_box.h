#pragma once
// Ways of many points, as the box around them.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace aspic::reference {

/// x, y, z and a fourth that is 0, or that nothing asks for: one load.
template <class T>
using Array4 = Eigen::Array<T, 4, 1>;

/// Around ways [m], or places; around none at first.
template <class T>
struct WayBox {
  Array4<T> low = Array4<T>::Constant(std::numeric_limits<T>::infinity());
  Array4<T> high = Array4<T>::Constant(-std::numeric_limits<T>::infinity());

  /// Of what has not moved.
  static WayBox still() { return {Array4<T>::Zero(), Array4<T>::Zero()}; }
  /// Of what may have gone anywhere.
  static WayBox anywhere() {
    constexpr T far = std::numeric_limits<T>::infinity();
    return {Array4<T>::Constant(-far), Array4<T>::Constant(far)};
  }
  void add(const Array4<T>& way) {
    low = low.min(way);
    high = high.max(way);
  }
  void add(const WayBox& other) {
    low = low.min(other.low);
    high = high.max(other.high);
  }
  /// Ways of `next` come after these.
  void go_on(const WayBox& next) {
    low += next.low;
    high += next.high;
  }
  /// How far anything of this and of the other is from each other, at most, in each direction.
  Array4<T> apart(const WayBox& other) const { return (high - other.low).max(other.high - low); }
  /// By how much the boxes are further from each other than `margin`; 0 or less where they are not.
  T beyond(const WayBox& other, T margin) const {
    return (low - other.high).max(other.low - high).maxCoeff() - margin;
  }
  /// The longest way.
  T longest() const { return std::sqrt(low.abs().max(high.abs()).square().sum()); }
};

}  // namespace aspic::reference

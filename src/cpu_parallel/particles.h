#pragma once
// Particles as the parallel solver holds them: one array per component, so that neighboring lanes of a
// vector register are neighboring particles.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <utility>
#include <vector>

namespace aspic::parallel {

/// Floats aligned for any vector register, zero at first, with room on both sides: a
/// register may be loaded from up to `margin` elements outside, whose values nobody uses.
class FloatArray {
 public:
  FloatArray() = default;
  FloatArray(std::size_t size, std::size_t margin) : FloatArray(size, margin, 1) {}
  FloatArray(FloatArray&&) = default;
  FloatArray& operator=(FloatArray&&) = default;
  FloatArray(const FloatArray&) = delete;
  FloatArray& operator=(const FloatArray&) = delete;

  /// Three arrays of one size, equally far from each other in memory.
  static std::array<FloatArray, 3> three(std::size_t size, std::size_t margin) {
    FloatArray first(size, margin, 3), second = first.part(1), third = first.part(2);
    return {std::move(first), std::move(second), std::move(third)};
  }

  std::uint64_t bytes() const { return all_ * sizeof(float); }
  float* data() { return data_.get() + margin_; }
  const float* data() const { return data_.get() + margin_; }
  float& operator[](std::size_t i) { return data()[i]; }
  float operator[](std::size_t i) const { return data()[i]; }

 private:
  static constexpr std::size_t alignment = 64, per_line = alignment / sizeof(float);
  static std::size_t rounded_up(std::size_t n) { return (n + per_line - 1) / per_line * per_line; }
  struct Free {
    void operator()(float* p) const { operator delete[](p, std::align_val_t(alignment)); }
  };
  FloatArray(std::size_t size, std::size_t margin, std::size_t parts) : margin_(rounded_up(margin)) {
    all_ = margin_ + rounded_up(size) + margin_;
    data_.reset(new (std::align_val_t(alignment)) float[parts * all_], Free());
    std::fill_n(data_.get(), parts * all_, 0.0f);
  }
  /// A further part of the same memory.
  FloatArray part(std::size_t n) const {
    FloatArray other;
    other.data_ = std::shared_ptr<float[]>(data_, data_.get() + n * all_);
    other.margin_ = margin_;
    other.all_ = all_;
    return other;
  }
  std::shared_ptr<float[]> data_;
  std::size_t margin_ = 0, all_ = 0;
};

/// A vector for each particle.
using VectorArray = std::array<FloatArray, 3>;

inline VectorArray vector_array(std::size_t size, std::size_t margin) {
  return FloatArray::three(size, margin);
}

/// Positions [m] and velocities [m/s].
struct Particles {
  VectorArray x, v;

  Particles() = default;
  Particles(std::size_t size, std::size_t margin)
      : x(vector_array(size, margin)), v(vector_array(size, margin)) {}
};

/// Bytes that arrays hold.
inline std::uint64_t bytes_of(const FloatArray& array) {
  return array.bytes();
}
template <class T, std::size_t N>
std::uint64_t bytes_of(const std::array<T, N>& arrays) {
  std::uint64_t sum = 0;
  for (const T& each : arrays) sum += bytes_of(each);
  return sum;
}
inline std::uint64_t bytes_of(const Particles& particles) {
  return bytes_of(particles.x) + bytes_of(particles.v);
}
template <class T>
std::uint64_t bytes_of(const std::vector<T>& list) {
  return list.capacity() * sizeof(T);
}

/// Consecutive particles.
struct Range {
  std::size_t first = 0, count = 0;
};

}  // namespace aspic::parallel

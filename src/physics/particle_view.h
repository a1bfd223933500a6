#pragma once
// Particles as balls see them, wherever they are kept.
#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "physics/phase.h"

namespace aspic::physics {

/// Positions [m] and velocities [m/s]: component c of vector number p is at [c][p·stride].
template <class T>
struct ParticleView {
  std::array<T*, 3> x, v;
  std::size_t stride;

  using Value = Vector<std::remove_const_t<T>>;
  static Value at(const std::array<T*, 3>& a, std::size_t i) { return {a[0][i], a[1][i], a[2][i]}; }
  Value position(std::uint32_t p) const { return at(x, p * stride); }
  Value velocity(std::uint32_t p) const { return at(v, p * stride); }
  void add_to(const std::array<T*, 3>& a, std::uint32_t p, const Value& change) const {
    for (std::size_t c = 0; c < 3; ++c) a[c][p * stride] += change[static_cast<Eigen::Index>(c)];
  }
};

/// Of vectors one after the other; nullptr where there are none.
template <class T>
std::array<T*, 3> components(T* vectors) {
  if (!vectors) return {};
  return {vectors, vectors + 1, vectors + 2};
}

/// Of the columns of a phase.
template <class T>
ParticleView<T> view_of(Phase<T>& phase) {
  return {components(phase.x.data()), components(phase.v.data()), 3};
}
template <class T>
ParticleView<const T> view_of(const Phase<T>& phase) {
  return {components(phase.x.data()), components(phase.v.data()), 3};
}

/// A box around points [m]; around none at first.
template <class T>
struct SearchBox {
  std::array<T, 3> min, max;
  SearchBox() {
    min.fill(std::numeric_limits<T>::infinity());
    max.fill(-std::numeric_limits<T>::infinity());
  }
};

/// Around particles first … end − 1. NaNs are not counted: they touch nothing.
template <class T>
SearchBox<T> box_of(const ParticleView<T>& particles, std::uint32_t first, std::uint32_t end) {
  SearchBox<T> box;
  for (std::size_t c = 0; c < 3; ++c) {
    const T* const x = particles.x[c];
    T least = box.min[c], most = box.max[c];
    for (std::size_t i = first * particles.stride; i < end * particles.stride; i += particles.stride) {
      least = x[i] < least ? x[i] : least;
      most = x[i] > most ? x[i] : most;
    }
    box.min[c] = least;
    box.max[c] = most;
  }
  return box;
}

}  // namespace aspic::physics

#pragma once
// What a model knows of each particle, in memory that grows with the bodies rather than with their particles.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <span>
#include <vector>

#include "aspic/vec.h"
#include "model/rotation.h"

namespace aspic {

/// Walks over anything that has values by index.
template <class Values>
class IndexIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = typename Values::value_type;
  using difference_type = std::ptrdiff_t;
  using pointer = const value_type*;
  using reference = value_type;

  IndexIterator() = default;
  IndexIterator(const Values& values, std::size_t at) : values_(&values), at_(at) {}
  value_type operator*() const { return (*values_)[at_]; }
  IndexIterator& operator++() {
    ++at_;
    return *this;
  }
  IndexIterator operator++(int) {
    const IndexIterator before = *this;
    ++at_;
    return before;
  }
  friend bool operator==(const IndexIterator& a, const IndexIterator& b) { return a.at_ == b.at_; }

 private:
  const Values* values_ = nullptr;
  std::size_t at_ = 0;
};

/// A value for each particle, held once for particles that follow one another and are alike. Any index must
/// be below size().
template <class T>
class Runs {
 public:
  using value_type = T;
  struct Run {
    std::size_t end;  ///< index after the last of them
    T value;
    friend bool operator==(const Run&, const Run&) = default;
  };

  Runs() = default;
  Runs(std::initializer_list<T> values) : Runs(std::vector<T>(values)) {}
  Runs(const std::vector<T>& values) {
    for (const T& value : values) push_back(value);
  }
  /// Each value converted.
  template <class U>
  explicit Runs(const Runs<U>& values) {
    for (const auto& run : values.runs()) push_back(static_cast<T>(run.value), run.end - size());
  }

  std::size_t size() const { return runs_.empty() ? 0 : runs_.back().end; }
  bool empty() const { return runs_.empty(); }
  const T& operator[](std::size_t i) const {
    return runs_.size() == 1 ? runs_.front().value : run_of(i)->value;
  }
  const T& back() const { return runs_.back().value; }
  auto begin() const { return IndexIterator(*this, 0); }
  auto end() const { return IndexIterator(*this, size()); }
  std::span<const Run> runs() const { return runs_; }

  void push_back(const T& value, std::size_t count = 1) {
    if (count == 0) return;
    if (!runs_.empty() && runs_.back().value == value)
      runs_.back().end += count;
    else
      runs_.push_back({size() + count, value});
  }
  void assign(std::size_t count, const T& value) {
    runs_.clear();
    push_back(value, count);
  }
  void set(std::size_t i, const T& value) {
    Runs changed;
    std::size_t first = 0;
    for (const Run& run : runs_) {
      const bool here = first <= i && i < run.end;
      changed.push_back(run.value, (here ? i : run.end) - first);
      if (here) {
        changed.push_back(value);
        changed.push_back(run.value, run.end - i - 1);
      }
      first = run.end;
    }
    *this = std::move(changed);
  }

  /// Whether both have the same values.
  friend bool operator==(const Runs&, const Runs&) = default;
  /// Bytes it holds on the heap.
  std::uint64_t bytes() const { return runs_.capacity() * sizeof(Run); }

 private:
  auto run_of(std::size_t i) const { return std::ranges::upper_bound(runs_, i, {}, &Run::end); }

  std::vector<Run> runs_;
};

/// Places of the points of a lattice: (i, j, k) is at center + turned((i, j, k)·spacing − half).
struct LatticePlaces {
  std::array<int, 3> particles = {};  ///< n₀, n₁, n₂; (i, j, k) has the number (i·n₁ + j)·n₂ + k
  double spacing = 0.0;               ///< [m]
  Vec3 half;                          ///< half its edges [m]
  Vec3 center;                        ///< [m]
  Rotation turned = Rotation({0.0, 0.0, 1.0}, 0.0);

  std::size_t count() const {
    return static_cast<std::size_t>(particles[0]) * static_cast<std::size_t>(particles[1]) *
           static_cast<std::size_t>(particles[2]);
  }
  Vec3 operator[](std::size_t local) const {
    const auto at = static_cast<int>(local);
    const auto& [ni, nj, nk] = particles;
    const int i = at / (nj * nk), j = at / nk % nj, k = at % nk;
    return center + turned({i * spacing - half.x, j * spacing - half.y, k * spacing - half.z});
  }
};

/// Where each particle is [m]. Any index must be below size().
class Places {
 public:
  using value_type = Vec3;

  Places() = default;
  Places(std::initializer_list<Vec3> listed) : listed_(listed) {}
  Places(std::vector<Vec3> listed) : listed_(std::move(listed)) {}

  std::size_t size() const { return lattices_.empty() ? listed_.size() : lattices_.back().end + tail(); }
  bool empty() const { return size() == 0; }
  Vec3 operator[](std::size_t i) const {
    const auto next = std::ranges::upper_bound(lattices_, i, {}, &Piece::end);
    if (next != lattices_.end() && i >= next->first()) return next->places[i - next->first()];
    return listed_[next == lattices_.begin() ? i : i - std::prev(next)->end + std::prev(next)->listed_before];
  }
  auto begin() const { return IndexIterator(*this, 0); }
  auto end() const { return IndexIterator(*this, size()); }
  /// Those of `count` particles from `first` on.
  std::vector<Vec3> list(std::size_t first, std::size_t count) const {
    std::vector<Vec3> all;
    all.reserve(count);
    for (std::size_t i = first; i < first + count; ++i) all.push_back((*this)[i]);
    return all;
  }

  void push_back(const Vec3& place) { listed_.push_back(place); }
  void append(const LatticePlaces& lattice) {
    lattices_.push_back({size() + lattice.count(), listed_.size(), lattice});
  }
  /// From here on all are listed.
  void set(std::size_t i, const Vec3& place) {
    if (!lattices_.empty()) *this = Places(list(0, size()));
    listed_[i] = place;
  }

  /// Bytes it holds on the heap.
  std::uint64_t bytes() const {
    return listed_.capacity() * sizeof(Vec3) + lattices_.capacity() * sizeof(Piece);
  }

 private:
  struct Piece {
    std::size_t end;            // index after the last of its particles
    std::size_t listed_before;  // listed particles before it
    LatticePlaces places;
    std::size_t first() const { return end - places.count(); }
  };
  std::size_t tail() const { return listed_.size() - lattices_.back().listed_before; }

  std::vector<Vec3> listed_;
  std::vector<Piece> lattices_;
};

}  // namespace aspic

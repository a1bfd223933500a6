#pragma once
// Springs of lattices some of whose cells are empty, or of several materials: in bands. A band is the springs
// of a slice of particles to neighbors one difference of indices on, as many of the slice as have one; so
// neighbors are read as they lie in memory. Slices that are alike share their bands.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "cpu_parallel/springs.h"

namespace aspic::parallel {

/// Springs of a slice's particles to upper neighbors.
struct Band {
  std::int32_t step;      ///< from a particle's index to its neighbor's, > 0
  std::uint16_t present;  ///< which of the slice's particles have this spring
  std::uint16_t kind;     ///< see Bands
};

/// A band of one spring class has its number, counted from the body's first, as its kind. Where particles of
/// a slice have springs of several classes, kinds from classes() on say which is whose.
class Bands {
 public:
  /// Spring classes by particle, counted from the body's first; any where there is no spring.
  using Mixture = std::array<std::uint16_t, slice>;
  /// Constants of a mixture's springs, by particle.
  struct Lanes {
    std::array<float, slice> stiffness, damping, rest_length;
  };

  /// The springs of a body without cords. None if they are of more kinds than a band can name.
  static std::optional<Bands> of(const Model& model, const Body& body);
  /// Of another model with the same springs.
  void set_constants(const Model& model);
  /// Of a spring class of the model; mixtures have it once rest_lengths_set() was called.
  void set_rest_length(std::uint32_t spring_class, float r) { rest_length_[spring_class - first_class_] = r; }
  void rest_lengths_set();

  std::size_t first() const { return first_; }
  std::size_t count() const { return count_; }
  /// The largest step, and the most bands of a slice.
  std::size_t reach() const { return reach_; }
  std::size_t most() const { return most_; }
  /// Of a slice, in ascending order of steps.
  std::span<const Band> bands(std::size_t slice_index) const {
    const std::uint32_t pattern = pattern_[slice_index];
    return std::span(bands_).subspan(start_[pattern], start_[pattern + 1] - start_[pattern]);
  }
  /// Classes of the body.
  std::size_t classes() const { return stiffness_.size(); }
  /// Of the kind classes() and those after it.
  const Lanes* lanes() const { return lanes_.data(); }
  /// By class.
  const std::vector<float>& stiffness() const { return stiffness_; }
  const std::vector<float>& damping() const { return damping_; }
  const std::vector<float>& rest_length() const { return rest_length_; }
  std::uint64_t bytes() const {
    return bytes_of(bands_) + bytes_of(start_) + bytes_of(pattern_) + bytes_of(mixtures_) + bytes_of(lanes_) +
           bytes_of(stiffness_) + bytes_of(damping_) + bytes_of(rest_length_);
  }

 private:
  Bands() = default;

  std::size_t first_ = 0, count_ = 0, reach_ = 0, most_ = 0;
  std::vector<Band> bands_;
  std::vector<std::uint32_t> start_;    // of each pattern's bands
  std::vector<std::uint32_t> pattern_;  // by slice
  std::vector<Mixture> mixtures_;
  std::vector<Lanes> lanes_;  // by mixture
  std::uint32_t first_class_ = 0;
  std::vector<float> stiffness_, damping_, rest_length_;
};

}  // namespace aspic::parallel

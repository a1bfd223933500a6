#pragma once
// Where the springs of a particle lead, as the vector kernels read it. A box needs no list: its neighbors
// follow from a particle's place in the lattice. All other bodies have lists, transposed in slices of 16
// particles.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cpu_parallel/particles.h"
#include "model/model.h"

namespace aspic::parallel {

/// Particles whose bits share a mask word, and whose lists lie side by side.
inline constexpr std::size_t slice = 16;

/// Constants of a spring class in single precision.
struct Constants {
  float stiffness, damping, rest_length;
  float slack;  ///< a shorter spring pulls nowhere: the rest length of a cord, else negative
  explicit Constants(const SpringClass& spring);
};

/// A direction in which particles of a lattice have a spring.
struct Direction {
  std::ptrdiff_t step;  ///< to the neighbor's index
  int planes;           ///< to the neighbor's plane
  Constants constants;
  std::uint32_t spring_class;  ///< of the model
  /// What a spring of no length adds: the lower end gets +0 added, the upper end has +0 taken off, which
  /// changes the sign of a zero or does not.
  float nothing;
};

/// A lattice whose cells are all full. Its planes of particles with the same x follow one another.
class LatticeStencil {
 public:
  /// The lattice that `body` is: it must have a box().
  LatticeStencil(const Model& model, const Body& body);
  /// Of another model with the same springs.
  void set_constants(const Model& model);

  std::size_t first() const { return first_; }
  std::size_t planes() const { return planes_; }
  std::size_t plane_size() const { return rows_ * row_size_; }
  std::size_t row_size() const { return row_size_; }
  std::size_t reach() const { return 2 * plane_size() + 2 * row_size_ + 2; }  ///< largest step

  /// In ascending neighbor index.
  std::span<const Direction> directions() const { return directions_; }
  /// For each direction one word for `slice` particles of any plane, from the plane's particle `at` on, a
  /// multiple of `slice`: which of them have the neighbor, provided that its plane exists.
  const std::uint16_t* neighbors(std::size_t at) const { return &bits_[at / slice * directions_.size()]; }
  std::uint64_t bytes() const { return bytes_of(directions_) + bytes_of(bits_); }

 private:
  std::size_t first_, planes_, rows_, row_size_;
  std::vector<Direction> directions_;
  std::vector<std::uint16_t> bits_;
};

/// Any body: lists of incident springs in ascending neighbor index.
class SpringLists {
 public:
  /// One place in the lists of `slice` particles; neighbors are global indices.
  struct Slot {
    std::array<std::int32_t, slice> neighbor, spring_class;
    std::array<float, slice> nothing;  ///< as in Direction
    std::uint16_t present;             ///< which of the particles have this many springs
  };

  SpringLists(const Model& model, const Body& body);
  /// Of another model with the same springs.
  void set_constants(const Model& model);
  /// Of a spring class of the model.
  void set_rest_length(std::uint32_t spring_class, float r) {
    rest_length_[spring_class] = r;
    if (slack_[spring_class] >= 0.0f) slack_[spring_class] = r;
  }

  std::size_t first() const { return first_; }
  std::size_t count() const { return count_; }
  std::span<const Slot> slots(std::size_t slice_index) const {
    return std::span(slots_).subspan(start_[slice_index], start_[slice_index + 1] - start_[slice_index]);
  }
  /// By class of the model: component arrays, for gathering.
  const std::vector<float>& stiffness() const { return stiffness_; }
  const std::vector<float>& damping() const { return damping_; }
  const std::vector<float>& rest_length() const { return rest_length_; }
  const std::vector<float>& slack() const { return slack_; }
  std::uint64_t bytes() const {
    return bytes_of(slots_) + bytes_of(start_) + bytes_of(stiffness_) + bytes_of(damping_) +
           bytes_of(rest_length_) + bytes_of(slack_);
  }

 private:
  std::size_t first_, count_;
  std::vector<Slot> slots_;
  std::vector<std::size_t> start_;  // of each slice's slots
  std::vector<float> stiffness_, damping_, rest_length_, slack_;
};

}  // namespace aspic::parallel

#pragma once
// SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
#include <cstdint>

namespace aspic {

/// Successive 64-bit numbers, the same on every machine.
class SplitMix64 {
 public:
  static constexpr std::uint64_t gamma = 0x9e3779b97f4a7c15ull;

  explicit constexpr SplitMix64(std::uint64_t seed) : state_(seed) {}
  constexpr std::uint64_t operator()() { return mix(state_ += gamma); }
  /// A number in [0, 1), a multiple of 2⁻⁵³.
  constexpr double share() { return static_cast<double>((*this)() >> 11) * 0x1p-53; }

  /// The generator's finaliser: a bijection of 64-bit words.
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

}  // namespace aspic

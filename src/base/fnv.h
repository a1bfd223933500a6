#pragma once
// FNV-1a, 64 and 128 bit (Fowler, Noll, Vo; offset basis and prime from draft-eastlake-fnv).
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace aspic {

/// Accumulates bytes into a 64-bit FNV-1a hash.
class Fnv1a {
 public:
  void add_bytes(std::span<const std::byte> bytes) {
    for (const std::byte b : bytes) hash_ = (hash_ ^ static_cast<std::uint64_t>(b)) * 0x100000001b3ull;
  }

  /// Adds the little-endian bytes of an integer or of a float's or double's bits.
  void add(std::uint32_t bits) { add_little_endian(bits, 4); }
  void add(std::uint64_t bits) { add_little_endian(bits, 8); }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

  std::uint64_t value() const { return hash_; }

 private:
  void add_little_endian(std::uint64_t bits, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      const auto b = static_cast<std::byte>(bits >> (8 * i));
      add_bytes({&b, 1});
    }
  }
  std::uint64_t hash_ = 0xcbf29ce484222325ull;
};

/// The same of 128 bits: for names of millions of things, no two of which may be equal.
class Fnv1a128 {
 public:
  void add_bytes(std::span<const std::byte> bytes) {
    constexpr Bits prime = (Bits{1} << 88) + 0x13b;
    for (const std::byte b : bytes) hash_ = (hash_ ^ static_cast<std::uint64_t>(b)) * prime;
  }
  /// 32 lower-case hexadecimal digits.
  std::string digits() const {
    std::string text;
    for (int shift = 124; shift >= 0; shift -= 4)
      text += "0123456789abcdef"[static_cast<unsigned>(hash_ >> shift) & 15u];
    return text;
  }

 private:
  __extension__ using Bits = unsigned __int128;
  Bits hash_ = (Bits{0x6c62272e07bb0142} << 64) + 0x62b821756295c58d;
};

}  // namespace aspic

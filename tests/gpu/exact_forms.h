#pragma once
// shaders/compute/exact.glsl as C++: the text that devices run, on a processor whose quotients and roots are
// made inexact.
#include <array>
#include <cstdint>
#include <span>

namespace aspic::testing {

/// Results with other bits than IEEE 754 gives.
struct WrongForms {
  std::uint64_t reciprocals = 0;           ///< of 1/b, b in [1, 2)
  std::uint64_t roots = 0;                 ///< of √x, x in [1, 4)
  std::uint64_t reciprocals_of_roots = 0;  ///< of 1/√x with the root rounded, x in [1, 4)
};

/// One set of defines.
struct ExactForm {
  const char* name;
  float (*div)(float a, float b);
  float (*rcp)(float b);
  float (*sqrt)(float x);
  /// Every `stride`-th of 2^23 reciprocals and 2^24 roots.
  WrongForms (*count_wrong)(std::uint32_t stride);
};

/// Units in the last place that the device's quotients, roots and inverse roots are off by. At first 0.
extern int& device_fault;

/// Whether the processor has an fma in hardware, which the forms use then; else doubles take its place.
bool has_fused_fma();

/// Slow, with one Newton step, with two.
std::span<const ExactForm, 3> exact_forms();

/// a·b + c rounded once, by arithmetic in double precision alone.
float emulated_fma(float a, float b, float c);

}  // namespace aspic::testing

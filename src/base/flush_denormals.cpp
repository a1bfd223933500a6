#include "base/flush_denormals.h"

#include <limits>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace aspic {
namespace {

#if defined(__x86_64__)

// MXCSR: all exceptions masked, round to nearest, flush-to-zero, denormals-are-zero.
constexpr std::uint64_t ours = 0x1f80 | 0x8000 | 0x0040;

std::uint64_t environment() {
  return _mm_getcsr();
}
void set_environment(std::uint64_t to) {
  _mm_setcsr(static_cast<unsigned>(to));
}

#elif defined(__aarch64__)

// FPCR: no traps, round to nearest, FZ (operands and results, single and double).
constexpr std::uint64_t ours = 1ull << 24;

std::uint64_t environment() {
  std::uint64_t now = 0;
  asm volatile("mrs %0, fpcr" : "=r"(now)::"memory");
  return now;
}
void set_environment(std::uint64_t to) {
  asm volatile("msr fpcr, %0" ::"r"(to) : "memory");
}

#else

constexpr std::uint64_t ours = 0;

std::uint64_t environment() {
  return 0;
}
void set_environment(std::uint64_t) {}

#endif

}  // namespace

// Neither is inline: a call keeps the caller's operations on their side of the change.
FlushDenormals::FlushDenormals(bool on) : before_(on ? environment() : ours) {
  if (before_ != ours) set_environment(ours);
}

FlushDenormals::~FlushDenormals() {
  if (before_ != ours) set_environment(before_);
}

bool FlushDenormals::is_on() {
  return (environment() & ours) == ours;
}

bool flushes_denormals() {
  volatile float least = std::numeric_limits<float>::min();
  volatile float half = least * 0.5f;
  return half == 0.0f;
}

}  // namespace aspic

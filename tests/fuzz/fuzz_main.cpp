// libFuzzer's entry: one program for each target, which ASPIC_FUZZ_TARGET names.
#include <cstddef>
#include <cstdint>

#include "fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  aspic::fuzz::ASPIC_FUZZ_TARGET.run({reinterpret_cast<const char*>(data), size});
  return 0;
}

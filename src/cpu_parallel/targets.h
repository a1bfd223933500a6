#pragma once
// Instruction sets that Highway leaves out, in every file compiled once for each: they bring nothing over the
// next lower one here.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)

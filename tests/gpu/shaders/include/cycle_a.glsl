#include "include/cycle_b.glsl"

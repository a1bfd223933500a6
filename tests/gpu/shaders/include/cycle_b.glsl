// b
#include "include/cycle_a.glsl"

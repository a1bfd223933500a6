// line 1 of middle
#include "include/inner.glsl"
// line 3 of middle

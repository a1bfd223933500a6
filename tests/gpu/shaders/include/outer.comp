// line 1 of outer
#include "include/middle.glsl"
// line 3 of outer
  #  include "include/inner.glsl"  // a second time: nothing
// line 5 of outer

// one
#include "include/nowhere.glsl"

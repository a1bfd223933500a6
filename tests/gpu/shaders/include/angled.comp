#include <include/inner.glsl>

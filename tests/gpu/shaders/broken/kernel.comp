#include "compute/dispatch.glsl"
#include "broken/part.glsl"

void main() {
  part();
}

// A process that draws pictures, and nothing else.
#include <cstdio>

#include "run/drawer.h"

int main() {
  const aspic::Status served = aspic::serve_pictures();
  if (served) return 0;
  std::fprintf(stderr, "%s\n", served.error().message().c_str());
  return 6;
}

// Writes docs/scene-reference.md to standard output.
#include <cstdio>
#include <string>

#include "scene/reference.h"

int main() {
  const std::string page = aspic::scene_reference("--set");
  const bool written =
      std::fwrite(page.data(), 1, page.size(), stdout) == page.size() && std::fflush(stdout) == 0;
  return written ? 0 : 6;
}

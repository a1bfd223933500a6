// Browsers have no files for a scene to name, and do not say how much memory they have.
#include "base/memory.h"
#include "scene/reader.h"

namespace aspic {

void reader::read_files(Reader&, const std::vector<diagnostics::Source>&, const LoadOptions&) {}

std::optional<std::uint64_t> available_memory() {
  return {};
}

}  // namespace aspic

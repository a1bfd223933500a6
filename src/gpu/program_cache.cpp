#include "gpu/program_cache.h"

#include <utility>

namespace aspic::gl {

Result<std::shared_ptr<const Program>> ProgramCache::compute(const ShaderLibrary& library,
                                                             std::string_view path,
                                                             std::span<const Define> defines) {
  ASPIC_TRY(auto source, library.flatten(path, defines));
  std::string name(path);
  for (const Define& d : defines) name += '\n' + d.name + ' ' + d.value;
  const auto found = entries_.find(name);
  if (found != entries_.end() && found->second.text == source.text()) return found->second.program;

  std::string text = source.text();
  ASPIC_TRY(auto made, Program::compute(context_, source));
  ++compiled_;
  auto program = std::make_shared<const Program>(std::move(made));
  entries_.insert_or_assign(std::move(name), Entry{std::move(text), program});
  return program;
}

}  // namespace aspic::gl

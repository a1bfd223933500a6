#pragma once
// Linked compute programs of one context, kept for whoever asks for the same source again.
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "gpu/program.h"

namespace aspic::gl {

/// Compiling a kernel takes a driver up to a third of a second, part of it at the first dispatch; a solver
/// that is rebuilt for another constant needs the same kernels. Belongs to a Context
/// (Context::programs()).
class ProgramCache {
 public:
  explicit ProgramCache(Context& context) : context_(context) {}

  /// As Program::compute, compiled only if this kernel with these defines assembled to another text the last
  /// time, or was never asked for: so an edited shader file is noticed. Of each kernel and set of defines the
  /// last text alone is kept. Uniforms are shared with everybody else who holds the program: set them before
  /// each dispatch. Must not outlive the context.
  Result<std::shared_ptr<const Program>> compute(const ShaderLibrary& library, std::string_view path,
                                                 std::span<const Define> defines = {});

  /// Programs kept.
  std::size_t size() const { return entries_.size(); }
  /// Programs compiled so far.
  std::uint64_t compiled() const { return compiled_; }

 private:
  struct Entry {
    std::string text;
    std::shared_ptr<const Program> program;
  };
  Context& context_;
  std::map<std::string, Entry, std::less<>> entries_;  // by path and defines
  std::uint64_t compiled_ = 0;
};

}  // namespace aspic::gl

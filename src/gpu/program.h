#pragma once
// A compute or graphics program: compiled, linked and checked.
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "base/result.h"
#include "gpu/context.h"
#include "gpu/name.h"
#include "gpu/shader_source.h"

namespace aspic::gl {

/// What OpenGL 4.3 guarantees to a compute shader; no kernel of the project uses more.
inline constexpr int max_storage_blocks = 8;

/// The shader files of a graphics program, relative to shaders/.
struct GraphicsStages {
  std::string_view vertex;
  std::string_view fragment;
  std::string_view geometry = {};  ///< empty: none
};

/// Owns one linked program. Movable; its context must outlive it and be current.
class Program {
 public:
  /// An empty handle: id 0.
  Program() = default;

  /// Compiles and links the compute shader `path` of the library.
  /// Errors: io (file or include missing), no_device (the driver refuses it: the log in our files and lines;
  /// or it has more than max_storage_blocks active storage blocks, named).
  static Result<Program> compute(Context& context, const ShaderLibrary& library, std::string_view path,
                                 std::span<const Define> defines = {});

  /// The same of a source that has been put together already.
  static Result<Program> compute(Context& context, const FlatShader& source);

  /// Compiles and links a vertex and a fragment shader, and a geometry shader where one is named; all get the
  /// same defines. Errors: io (file or include missing), no_device (the driver refuses one of them: the log
  /// in our files and lines; or the vertex shader has storage blocks, which OpenGL 4.3 does not guarantee).
  static Result<Program> graphics(Context& context, const ShaderLibrary& library,
                                  const GraphicsStages& stages, std::span<const Define> defines = {});

  /// Set the uniform at an explicit `layout(location = …)`; no need for the program to be in use.
  void set(int location, std::uint32_t value) const;
  void set(int location, std::int32_t value) const;
  void set(int location, float value) const;
  void set(int location, const std::array<float, 4>& value) const;
  void set(int location, const std::array<std::uint32_t, 4>& value) const;

  std::uint32_t id() const { return name_.id(); }
  /// The context it was made in; not of an empty handle.
  Context& context() const { return *context_; }
  /// The path it was compiled from; of a graphics program, the fragment shader's.
  const std::string& path() const { return path_; }
  /// Invocations per group along x, y, z, as its layout says; all 0 for a graphics program.
  const std::array<std::uint32_t, 3>& group_size() const { return group_size_; }

 private:
  Context* context_ = nullptr;
  Name name_;
  std::string path_;
  std::array<std::uint32_t, 3> group_size_ = {};
};

/// Linked compute programs of one context, kept for whoever asks for the same source again: compiling a
/// kernel takes a driver up to a third of a second, part of it at the first dispatch; a solver that is
/// rebuilt for another constant needs the same kernels. Belongs to a Context (Context::programs()).
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

#pragma once
// A compute or graphics program: compiled, linked and checked.
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/result.h"
#include "gpu/context.h"
#include "gpu/name.h"
#include "gpu/program_files.h"
#include "gpu/shader_source.h"

namespace aspic::gl {

/// What OpenGL 4.3 guarantees to a compute shader; no kernel of the project uses more.
inline constexpr int max_storage_blocks = 8;

/// The shader files of a program, relative to shaders/. Empty: no such stage.
struct ProgramStages {
  std::string_view vertex = {};
  std::string_view fragment = {};
  std::string_view geometry = {};
  std::string_view compute = {};
};

/// Owns one linked program. Movable; its context must outlive it and be current.
class Program {
 public:
  /// An empty handle: id 0. What is set in it or dispatched with it does nothing.
  Program() = default;

  /// Compiles and links the compute shader `path` of the library.
  /// Errors: io (file or include missing), no_device (the driver refuses it: the log in our files and lines;
  /// or it has more than max_storage_blocks active storage blocks, named).
  static Result<Program> compute(Context& context, const ShaderLibrary& library, std::string_view path,
                                 std::span<const Define> defines = {});

  /// Compiles and links a vertex and a fragment shader, and a geometry shader where one is named; all get the
  /// same defines. Errors: io (file or include missing), no_device (the driver refuses one of them: the log
  /// in our files and lines; or the vertex shader has storage blocks, which OpenGL 4.3 does not guarantee).
  static Result<Program> graphics(Context& context, const ShaderLibrary& library, const ProgramStages& stages,
                                  std::span<const Define> defines = {});

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
  friend class ProgramCache;
  /// One stage's source with its kind.
  struct Stage {
    std::uint32_t kind;
    FlatShader source;
    std::uint32_t shader = 0;  // 0: the program was a binary
  };
  static Result<std::vector<Stage>> flatten(const ShaderLibrary& library, const ProgramStages& stages,
                                            std::span<const Define> defines);
  /// Takes `binary`, if there is one that the driver accepts. Otherwise has the driver begin to compile and
  /// link, and asks for nothing that it would have to wait for. Legal after it: finish() alone.
  static Program start(Context& context, std::vector<Stage> stages,
                       const std::optional<ProgramBinary>& binary = {}, bool keeps_binary = false);
  /// Waits, and checks what came of it.
  Status finish();
  bool finished() const { return stages_.empty(); }
  bool compiles() const { return stages_.front().shader != 0; }
  Status check_compiled() const;
  Status check_blocks();
  ProgramBinary binary() const;

  Context* context_ = nullptr;
  Name name_;
  std::string path_;
  std::array<std::uint32_t, 3> group_size_ = {};
  std::vector<Stage> stages_;  // until finish()
  std::string key_;            // in a ProgramCache: of the device and the text
};

/// A program that others may hold too.
using SharedProgram = std::shared_ptr<const Program>;

/// Linked programs of one context, kept for whoever asks for the same source again: compiling a kernel takes
/// a driver up to a third of a second, part of it at the first dispatch; a solver that is rebuilt for another
/// constant needs the same kernels. Belongs to a Context (Context::programs()). Binaries of programs are kept
/// in the user's files, for the next process.
class ProgramCache {
 public:
  /// `folder` holds the binaries; empty: none are kept.
  explicit ProgramCache(Context& context, std::filesystem::path folder = {})
      : context_(context), files_(std::move(folder)) {}

  /// As Program::compute, compiled only if nothing of the same text was compiled for this context. Of each
  /// kernel and set of defines the last text alone is kept, so an edited shader file is noticed. Uniforms are
  /// shared with everybody else who holds the program: set them before each dispatch. Must not outlive the
  /// context.
  Result<SharedProgram> compute(const ShaderLibrary& library, std::string_view path,
                                std::span<const Define> defines = {});
  /// As Program::graphics, likewise.
  Result<SharedProgram> graphics(const ShaderLibrary& library, const ProgramStages& stages,
                                 std::span<const Define> defines = {});

  /// Begins to compile a program; the driver may do so while others are begun. No more may be done with it
  /// before finish(). Errors: io.
  Result<SharedProgram> start(const ShaderLibrary& library, const ProgramStages& stages,
                              std::span<const Define> defines = {});
  /// Waits for a program that start() returned. Errors: no_device, as Program::compute and Program::graphics.
  Status finish(const SharedProgram& program);

  /// Programs kept.
  std::size_t size() const { return entries_.size(); }
  /// Programs compiled so far.
  std::uint64_t compiled() const { return compiled_; }
  /// Programs made of a binary so far.
  std::uint64_t loaded() const { return loaded_; }
  const ProgramFiles& files() const { return files_; }

 private:
  struct Pending {
    std::string name;
    std::shared_ptr<Program> program;
  };
  std::string key_of(const std::vector<Program::Stage>& stages);

  Context& context_;
  ProgramFiles files_;
  std::optional<std::string> device_;                        // that binaries are of
  bool keeps_binaries_ = false;                              // the driver has them, and there is a folder
  std::map<std::string, std::shared_ptr<Program>> entries_;  // finished, by paths and defines
  std::vector<Pending> pending_;
  std::uint64_t compiled_ = 0, loaded_ = 0;
};

/// Programs that are needed together: begun one after the other, then waited for.
class ProgramBatch {
 public:
  explicit ProgramBatch(ProgramCache& cache) : cache_(cache) {}

  /// As ProgramCache::start.
  Result<SharedProgram> start(const ShaderLibrary& library, const ProgramStages& stages,
                              std::span<const Define> defines = {});
  /// Waits for all. Error: that of the first which failed, in the order in which they began.
  Status finish();

 private:
  ProgramCache& cache_;
  std::vector<SharedProgram> started_;
};

}  // namespace aspic::gl

// Shader files with their includes, from a directory as ASPIC_SHADER_DIR names one, and drivers' compile
// logs.
#include <array>
#include <filesystem>
#include <fstream>

#include "fuzz/targets.h"
#include "gpu/shader_source.h"
#include "support/temporary_directory.h"

namespace aspic::fuzz {
namespace {

constexpr std::array<const char*, 4> names = {"main.comp", "a.glsl", "b.glsl", "c.glsl"};

/// Every line of a flat shader comes from one of the files. The first part is the log, the others are the
/// files.
void run(std::string_view bytes) {
  static const test::TemporaryDirectory directory;
  const std::string_view log = bytes.substr(0, bytes.find('\0'));
  for (const char* name : names) {
    const std::size_t end = bytes.find('\0');
    bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
    const std::string_view part = bytes.substr(0, bytes.find('\0'));
    std::ofstream(directory.file(name), std::ios::binary | std::ios::trunc)
        .write(part.data(), static_cast<std::streamsize>(part.size()));
  }
  const gl::ShaderLibrary library(std::filesystem::path(directory.file("main.comp")).parent_path());
  const std::array<gl::Define, 1> defines = {{{"ASPIC_GROUP_SIZE", "64"}}};
  const auto flat = library.flatten("main.comp", defines);
  if (!flat) return require_message(flat.error(), {ErrorCode::io});
  require(flat->text().starts_with("#version 430 core\n"), "a flat shader begins with its version");
  int lines = 0;
  for (const char c : flat->text()) lines += c == '\n';
  for (int line = 1; line <= lines; ++line)
    require(!flat->origin(line).file.empty(), "every line has an origin");
  (void)flat->rewrite_log(log);
}

std::vector<std::string> seeds() {
  using namespace std::string_literals;
  std::vector<std::string> made = {
      "0:12(5): error: syntax error\n\0#include \"a.glsl\"\nvoid main() {}\n\0#include \"b.glsl\"\n\0int b;\n\0"s,
      "0(3) : error C1008: undefined variable\nERROR: 0:2: 'x' : undeclared\n\0#include \"a.glsl\"\n#include \"c.glsl\"\n\0float a;\0\0"s};
  for (const EmbeddedFile& shader : embedded_shaders())
    if (shader.text.size() < 2048) made.push_back("0:1(1): error: x\n\0"s + std::string(shader.text));
  return made;
}

std::vector<std::string> words() {
  using namespace std::string_literals;
  return {"\0"s,          "#include \"a.glsl\"\n", "#include \"b.glsl\"\n", "#include \"main.comp\"\n",
          "#include <x>", "#version 430\n",        "0:1(1): error: ",       "0(1) : error C1: ",
          "ERROR: 0:1: ", "#include \"../a\"\n",   "#include \".\"\n",      "2147483647"};
}

}  // namespace

const Target shader_target = {"shader", run, seeds, words};

}  // namespace aspic::fuzz

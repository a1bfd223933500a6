#include "fuzz/targets.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "scene/parameters.h"

namespace aspic::fuzz {

std::span<const Target> targets() {
  static const std::array all = {scene_target,   set_target,           view_target,      checkpoint_target,
                                 inputs_target,  configuration_target, state_csv_target, kept_state_target,
                                 npy_target,     shader_target,        mesh_obj_target,  mesh_stl_target,
                                 mesh_ply_target};
  return all;
}

const Target* find_target(std::string_view name) {
  const auto found = std::ranges::find(targets(), name, &Target::name);
  return found == targets().end() ? nullptr : &*found;
}

void require(bool kept, std::string_view promise) {
  if (!kept) throw std::logic_error(std::string(promise));
}

void require_message(const Error& error, std::initializer_list<ErrorCode> codes) {
  require(std::ranges::find(codes, error.code) != codes.end(),
          fmt::format("exit code {} is not among those promised: {}", static_cast<int>(error.code),
                      error.message()));
  require(!error.message().empty(), "an error has a message");
  // A message is a few lines, however large the input was.
  require(error.message().size() < (1u << 20), "a message is shorter than 1 MiB");
}

std::vector<std::string> scene_words() {
  std::vector<std::string> words = {
      "[[",   "]]",   "= {",   "nan", "inf",    "-inf", "1e308", "4.9e-324", "-0.0",  "0x7fffffffffffffff",
      "\"\"", "true", "false", "'''", "\"\"\"", "[0]",  "[1]",   "\\u001b",  "1e-38", "9223372036854775807"};
  const auto add = [&](std::string_view word) {
    if (std::ranges::find(words, word) == words.end()) words.emplace_back(word);
  };
  for (const Parameter& p : parameters()) {
    std::string path(p.path);
    if (const std::size_t brackets = path.find("[]"); brackets != std::string::npos) {
      add("[[" + path.substr(0, brackets) + "]]");
      path.replace(brackets, 2, "[0]");
    }
    add(path + "=");
    add(path.substr(path.rfind('.') == std::string::npos ? 0 : path.rfind('.') + 1) + " = ");
    for (const std::string_view word : p.words) add(fmt::format("\"{}\"", word));
    if (p.range.min != 0.0) add(fmt::format("{}", p.range.min));
    if (p.range.max != 0.0) add(fmt::format("{}", p.range.max));
  }
  return words;
}

}  // namespace aspic::fuzz

#include "command_line/command_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/printable.h"
#include "command_line/raw_options.h"
#include "scene/diagnostics.h"
#include "scene/parameters.h"

namespace aspic {
namespace {

bool has(const std::vector<std::string>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

/// The key of a scene that people look for under this option: `--integrator`, `--dt`. Empty: none.
std::string scene_key_like(std::string_view option) {
  std::string_view word = option.substr(std::min(option.find_first_not_of('-'), option.size()));
  for (const std::string_view other : {"dt", "h", "time-step", "step-size"})
    if (word == other) word = "timestep";
  for (const Parameter& p : parameters()) {
    const std::string_view table = p.section();
    if (table != "simulation" && table != "contact" && table != "cube[]") continue;
    if (p.path.substr(p.path.find_last_of('.') + 1) == word) return path_text(p.path, 0);
  }
  return "";
}

}  // namespace

Error unexpected_word(const CommandWords& command, const std::string& word) {
  const bool option = word.starts_with('-');
  const std::string shown = printable_line(word);
  const std::string name = shown.substr(0, shown.find('='));
  const std::string key = option && has(command.options, "--set") ? scene_key_like(name) : "";
  if (!key.empty())
    return usage("{0} has no option {1}, but scenes have this key: --set {2}=VALUE. See {0} --help.",
                 command.name, name, key);
  const std::vector<std::string>& known = option ? command.options : command.commands;
  std::string message = option ? fmt::format("{} has no option {}.", command.name, name)
                        : known.empty()
                            ? fmt::format("unexpected argument for {}: \"{}\".", command.name, shown)
                            : fmt::format("{} has no command \"{}\".", command.name, shown);
  const std::vector<std::string_view> candidates(known.begin(), known.end());
  const std::string_view near = diagnostics::nearest(name, candidates);
  if (!near.empty()) message += fmt::format(" Did you mean {}?", near);
  return usage("{} See {} --help.", message, command.name);
}

std::vector<std::string> given_options(const std::vector<std::string>& options,
                                       const std::vector<std::string>& words) {
  std::vector<std::string> given;
  for (const std::string& word : words) {
    const std::string name = word.substr(0, word.find('='));
    if (has(options, name)) given.push_back(name);
  }
  return given;
}

}  // namespace aspic

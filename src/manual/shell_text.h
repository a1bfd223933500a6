#pragma once
// What the completions of all shells share.
#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "manual/manual.h"

namespace aspic::manual {

/// Between single quotation marks, for bash, zsh and other shells of POSIX.
inline std::string in_quotes(std::string_view text) {
  std::string result = "'";
  for (const char c : text) c == '\'' ? result += "'\\''" : result += c;
  return result + "'";
}

inline std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : std::string(between)) + word;
  return text;
}

/// Words of options that are too many to be written at each one: every list of them once.
class LongLists {
 public:
  /// The number of a list from 1 on; 0 if it is short.
  std::size_t number_of(const std::vector<std::string>& words) {
    if (words.size() <= 12) return 0;
    const auto known = std::ranges::find(lists_, words);
    if (known != lists_.end()) return static_cast<std::size_t>(known - lists_.begin()) + 1;
    lists_.push_back(words);
    return lists_.size();
  }
  const std::vector<std::vector<std::string>>& lists() const { return lists_; }

 private:
  std::vector<std::vector<std::string>> lists_;
};

/// All commands that can be typed, each after those above it.
inline void collect(const CommandFacts& command, std::vector<const CommandFacts*>& all) {
  all.push_back(&command);
  for (const CommandFacts& below : command.commands) collect(below, all);
}

/// "scene list", empty for the program itself.
inline std::string below_program(const CommandFacts& command) {
  const std::size_t space = command.name.find(' ');
  return space == std::string::npos ? "" : command.name.substr(space + 1);
}

inline bool takes_value(const OptionFacts& option) {
  return !option.value.empty();
}

/// What an argument or a value is, where it is a name of something.
enum class NameKind { none, file, directory, scene };
inline NameKind kind_of(const OptionFacts& option) {
  if (option.value == "FILE") return NameKind::file;
  if (option.value == "DIR") return NameKind::directory;
  if (option.value == "SCENE") return NameKind::scene;
  return NameKind::none;
}

}  // namespace aspic::manual

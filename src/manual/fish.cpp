#include <fmt/format.h>

#include "manual/manual.h"
#include "manual/shell_text.h"

namespace aspic::manual {
namespace {

/// Between single quotation marks, where a backslash escapes them and itself.
std::string fish_quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') result += '\\';
    result += c;
  }
  return result + "'";
}

/// Words of -a are read as words of the shell once more.
std::string words_of_list(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) {
    list += list.empty() ? "" : " ";
    for (const char c : word) {
      if (c == '[' || c == ']') list += '\\';
      list += c;
    }
  }
  return fish_quoted(list);
}

/// Where a command's options are offered: after all of its words, and before those of a command below it.
std::string condition(const CommandFacts& command) {
  std::string text;
  const std::string words = below_program(command);
  for (std::size_t at = 0; at < words.size();) {
    const std::size_t end = std::min(words.find(' ', at), words.size());
    text += (text.empty() ? "" : "; and ") +
            fmt::format("__fish_seen_subcommand_from {}", words.substr(at, end - at));
    at = end + 1;
  }
  std::string below;
  for (const CommandFacts& other : command.commands) below += " " + last_word(other);
  if (!below.empty())
    text += (text.empty() ? "" : "; and ") + fmt::format("not __fish_seen_subcommand_from{}", below);
  return text;
}

std::string value_text(const CommandFacts& command, const OptionFacts& option) {
  const std::vector<std::string> words = known_values(command, option);
  if (!words.empty()) return " -x -a " + words_of_list(words);
  switch (kind_of(option)) {
    case NameKind::file:
      return " -r -F";
    case NameKind::directory:
      return " -x -a '(__fish_complete_directories)'";
    case NameKind::scene:
      return " -x -a " + words_of_list(scene_names()) + " -a '(__fish_complete_suffix .toml)'";
    case NameKind::none:
      break;
  }
  return " -x";
}

/// Lines for one command, of a program that is called `program`.
std::string command_lines(const CommandFacts& command, const std::string& program, const std::string& when) {
  std::string text;
  const std::string start = "complete -c " + program + (when.empty() ? "" : " -n " + fish_quoted(when));
  for (const CommandFacts& below : command.commands)
    text += fmt::format("{} -a {} -d {}\n", start, last_word(below), fish_quoted(below.summary));
  for (const OptionFacts& argument : command.arguments) {
    if (kind_of(argument) == NameKind::scene)
      text += fmt::format("{0} -a {1} -d 'built-in scene'\n{0} -a '(__fish_complete_suffix .toml)'\n", start,
                          words_of_list(scene_names()));
    else
      text += start + " -F\n";
  }
  for (const OptionFacts& option : command.options) {
    std::string names;
    for (const std::string& name : option.names)
      names += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    const std::string value = takes_value(option) ? value_text(command, option) : "";
    text += fmt::format("{}{}{} -d {}\n", start, names, value, fish_quoted(option.help));
  }
  return text;
}

}  // namespace

std::vector<TextFile> fish_completion(const CommandFacts& aspic) {
  const std::string first = "# Completion for fish. Made from the options of the programs.\n";
  std::vector<const CommandFacts*> all;
  collect(aspic, all);
  std::string program = first + "complete -c aspic -f\n", window = first + "complete -c aspic-view -f\n";
  for (const CommandFacts* command : all) {
    program += command_lines(*command, "aspic", condition(*command));
    if (command->name == "aspic view") window += command_lines(*command, "aspic-view", "");
  }
  return {{"fish/aspic.fish", program}, {"fish/aspic-view.fish", window}};
}

}  // namespace aspic::manual

#include <fmt/format.h>

#include "manual/manual.h"
#include "manual/shell_text.h"

namespace aspic::manual {
namespace {

/// Text within a specification of _arguments, where brackets, colons and backslashes have a meaning.
std::string plain(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

/// What completes a value: an action of _arguments.
std::string action(const CommandFacts& command, const OptionFacts& option, LongLists& lists) {
  const std::vector<std::string> words = known_values(command, option);
  if (const std::size_t number = lists.number_of(words)) return fmt::format("_aspic_list_{}", number);
  if (!words.empty()) return "(" + joined(words, " ") + ")";
  switch (kind_of(option)) {
    case NameKind::file:
      return "_files";
    case NameKind::directory:
      return "_files -/";
    case NameKind::scene:
      return "_aspic_scenes";
    case NameKind::none:
      break;
  }
  return " ";
}

std::string specifications(const CommandFacts& command, LongLists& lists) {
  std::string lines;
  for (const OptionFacts& option : command.options) {
    for (const std::string& name : option.names) {
      std::string specification =
          (option.repeatable ? "*" : "") + name + (takes_value(option) && name.starts_with("--") ? "=" : "");
      specification += "[" + plain(option.help) + "]";
      if (takes_value(option))
        specification += ":" + plain(option.value) + ":" + action(command, option, lists);
      lines += " \\\n    " + in_quotes(specification);
    }
  }
  for (const OptionFacts& argument : command.arguments)
    lines += " \\\n    " + in_quotes(std::string(argument.required ? ":" : "::") + argument.value + ":" +
                                     action(command, argument, lists));
  return lines;
}

std::string function_name(const CommandFacts& command) {
  std::string name = "_" + command.name;
  for (char& c : name)
    if (c == ' ' || c == '-') c = '_';
  return name + "_words";
}

/// A function for each command: its options, then its argument or the commands below it.
std::string command_function(const CommandFacts& command, LongLists& lists) {
  std::string text = function_name(command) + "() {\n";
  if (command.commands.empty()) return text + "  _arguments -S" + specifications(command, lists) + "\n}\n";
  std::string names, cases;
  for (const CommandFacts& below : command.commands) {
    names += " \\\n        " + in_quotes(last_word(below) + ":" + plain(below.summary));
    cases += fmt::format("        {}) {} ;;\n", last_word(below), function_name(below));
  }
  return text + "  local line state\n  _arguments -C -S" + specifications(command, lists) +
         " \\\n    '1: :->command' '*:: :->rest'\n  case $state in\n    command)\n      local -a commands\n  "
         "    commands=(" +
         names + ")\n      _describe command commands\n      ;;\n    rest)\n      case $line[1] in\n" +
         cases + "      esac\n      ;;\n  esac\n}\n";
}

}  // namespace

std::vector<TextFile> zsh_completion(const CommandFacts& aspic) {
  std::vector<const CommandFacts*> all;
  collect(aspic, all);
  std::string text =
      "#compdef aspic aspic-view\n# Completion for zsh. Made from the options of the "
      "programs.\n\n_aspic_scenes() {\n  _alternative " +
      in_quotes("scenes:built-in scene:(" + joined(scene_names(), " ") + ")") +
      " \\\n    'files:scene file:_files -g \"*.toml\"'\n}\n";
  LongLists lists;
  for (const CommandFacts* command : all) text += command_function(*command, lists);
  for (std::size_t i = 0; i < lists.lists().size(); ++i) {
    const std::vector<std::string>& words = lists.lists()[i];
    text += fmt::format("_aspic_list_{}() {{\n  compadd{} --", i + 1,
                        words.back().ends_with('=') ? " -S ''" : "");
    for (const std::string& word : words) text += " " + in_quotes(word);
    text += "\n}\n";
  }
  text +=
      "if [[ $service == aspic-view ]]; then\n  _aspic_view_words \"$@\"\nelse\n  _aspic_words \"$@\"\nfi\n";
  return {{"zsh/_aspic", text}};
}

}  // namespace aspic::manual

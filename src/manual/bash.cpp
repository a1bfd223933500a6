#include <fmt/format.h>

#include "manual/manual.h"
#include "manual/shell_text.h"

namespace aspic::manual {
namespace {

/// What follows an option: `command --option) …;;` of a case.
std::string value_case(const CommandFacts& command, const OptionFacts& option, LongLists& lists) {
  if (!takes_value(option)) return "";
  std::string patterns;
  for (const std::string& name : option.names)
    patterns += (patterns.empty() ? "" : " | ") + in_quotes(below_program(command) + " " + name);
  const std::vector<std::string> words = known_values(command, option);
  std::string offer;
  if (const std::size_t number = lists.number_of(words))
    offer = fmt::format("words=$list_{}", number);
  else if (!words.empty())
    offer = "words=" + in_quotes(joined(words, " "));
  else if (kind_of(option) == NameKind::file)
    offer = "names=file";
  else if (kind_of(option) == NameKind::directory)
    offer = "names=directory";
  return fmt::format("    {}) {};;\n", patterns, offer.empty() ? "" : offer + " ");
}

std::string command_case(const CommandFacts& command) {
  std::vector<std::string> options, commands;
  for (const OptionFacts& option : command.options)
    options.insert(options.end(), option.names.begin(), option.names.end());
  for (const CommandFacts& below : command.commands) commands.push_back(last_word(below));
  std::string text = fmt::format("        {})\n          options={}\n", in_quotes(below_program(command)),
                                 in_quotes(joined(options, " ")));
  if (!commands.empty()) text += "          words=" + in_quotes(joined(commands, " ")) + "\n";
  for (const OptionFacts& argument : command.arguments) {
    const bool scene = kind_of(argument) == NameKind::scene;
    if (scene) text += "          words=$scenes\n";
    text += scene ? "          names=toml\n" : "          names=file\n";
  }
  return text + "          ;;\n";
}

}  // namespace

std::vector<TextFile> bash_completion(const CommandFacts& aspic) {
  std::vector<const CommandFacts*> all;
  collect(aspic, all);
  std::string commands, values, cases;
  LongLists lists;
  for (const CommandFacts* command : all) {
    if (command != &aspic) commands += (commands.empty() ? "" : " | ") + in_quotes(below_program(*command));
    for (const OptionFacts& option : command->options) values += value_case(*command, option, lists);
    cases += command_case(*command);
  }
  std::string text =
      "# Completion of aspic and aspic-view for bash. Made from the options of the programs.\n";
  text += "_aspic() {\n  local scenes=" + in_quotes(joined(scene_names(), " ")) + "\n";
  for (std::size_t i = 0; i < lists.lists().size(); ++i)
    text += fmt::format("  local list_{}={}\n", i + 1, in_quotes(joined(lists.lists()[i], " ")));
  text +=
      R"(  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command= word names= words= options= i
  [[ ${COMP_WORDS[0]##*/} == aspic-view ]] && command=view
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${command:+$command }${COMP_WORDS[i]}
    case $word in
      )" +
      commands + R"() [[ $command == view ]] || command=$word ;;
    esac
  done
  # --option=value comes as three words.
  if [[ $current == = ]]; then
    current=
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  case "$command $previous" in
)" + values +
      R"(    *)
      case $command in
)" + cases +
      R"(      esac
      if [[ $current == -* || -z $words$names ]]; then
        words=$options names=
      fi
      ;;
  esac
  COMPREPLY=()
  [[ $words ]] && mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  [[ ${COMPREPLY[0]} == *= ]] && compopt -o nospace
  if [[ $names ]]; then
    compopt -o filenames
    local kind=-f ending='*'
    [[ $names == directory ]] && kind=-d
    [[ $names == toml ]] && ending='*.toml'
    while IFS= read -r word; do
      [[ $word == $ending || -d $word ]] && COMPREPLY+=("$word")
    done < <(compgen "$kind" -- "$current")
  fi
}
complete -F _aspic aspic aspic-view
)";
  return {{"bash/aspic", text}, {"bash/aspic-view", text}};
}

}  // namespace aspic::manual

#include "command_line/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "aspic/version.h"
#include "base/printable.h"
#include "command_line/command_table.h"
#include "command_line/command_words.h"

namespace aspic {
namespace {

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// The deepest command that was named.
const CLI::App& named_command(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : named_command(*parsed.front());
}

std::string full_name(const CLI::App& app) {
  return app.get_parent() ? full_name(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

CommandWords words_of(const CLI::App& app) {
  return {full_name(app), option_names(app), command_names(app)};
}

/// The name by which an option of several was given; its first where it was not.
std::string typed_name(const CLI::Option& option, const std::vector<std::string>& given) {
  for (const std::string& name : option.get_lnames())
    if (std::ranges::find(given, "--" + name) != given.end()) return "--" + name;
  return option.get_name();
}

/// Names that options had before 0.3, accepted until 0.4.
struct FormerName {
  std::string_view command, former, present;
};
constexpr FormerName former_names[] = {{"run", "--beside", "--variant"},
                                       {"run", "--page", "--html"},
                                       {"run", "--page-live", "--html-live"},
                                       {"bench", "--pictures", "--images"}};

/// A word of a command with the present name of its option.
std::string renamed(std::string_view command, const std::string& word) {
  const std::size_t end = std::min(word.find('='), word.size());
  for (const FormerName& name : former_names)
    if (command == name.command && std::string_view(word).substr(0, end) == name.former)
      return std::string(name.present) + word.substr(end);
  return word;
}

}  // namespace

Result<Command> parse_arguments(int argc, const char* const* argv) {
  std::vector<std::string> words(argv, argv + argc);
  for (std::size_t w = 2; w < words.size(); ++w) words[w] = renamed(words[1], words[w]);
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  argv = pointers.data();
  std::optional<Result<Command>> result;
  CommandTable table([&](const CLI::App& command, const std::function<Result<Command>()>& complete) {
    table.raw.given = given_options(option_names(command), {argv + 1, argv + argc});
    // What `view` and the processes of `run` and `sweep` are started with.
    for (std::vector<std::string>* words : {&table.run.words, &table.view.words, &table.sweep.words})
      words->assign(argv + 2, argv + argc);
    result.emplace(complete());
  });
  CLI::App& app = table.app;

  // What a sweep starts: an option of no person's, and none of --help.
  table.sweep.worker =
      argc > 2 && std::string_view(argv[1]) == "sweep" && std::string_view(argv[argc - 1]) == "--worker";
  if (table.sweep.worker) --argc;
  if (argc < 2) return usage("no command given.\n\n{}", app.help());
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForVersion&) {
    return Command(ShowText{"aspic " ASPIC_VERSION "\n"});
  } catch (const CLI::Success&) {
    const CLI::App& command = named_command(app);
    return Command(ShowText{command.help(command.get_parent() ? full_name(*command.get_parent()) : "")});
  } catch (const CLI::ParseError& error) {
    const CLI::App& command = named_command(app);
    const auto extras = command.remaining();
    // Where a command is missing, CLI11 reports that before the word in its place.
    const bool command_missing =
        command.get_require_subcommand_min() > 0 && command.get_subcommands().empty();
    if (!extras.empty()) return unexpected_word(words_of(command), extras.front());
    if (command_missing) {
      for (int i = &command == &app ? 1 : 2; i < argc; ++i) {
        const std::string word = argv[i];
        if (word != command.get_name()) return unexpected_word(words_of(command), word);
      }
    }
    const std::vector<std::string> given = given_options(option_names(command), {argv + 1, argv + argc});
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_items_expected_max() == 1 && option->count() > 1)
        return usage("{} is given {} times: give it once. See {} --help.", typed_name(*option, given),
                     option->count(), full_name(command));
      // The parser calls an option by the first of its names.
      const std::string opening = option->get_name() + ":";
      if (const std::string_view what = error.what(); what.starts_with(opening))
        return usage("{}{}. See {} --help.", typed_name(*option, given), what.substr(opening.size() - 1),
                     full_name(command));
    }
    return usage("{}. See {} --help.", error.what(), full_name(command));
  }
  return std::move(*result);
}

}  // namespace aspic

#pragma once
// What the commands and their options are, as plain data: for manual pages and completion.
#include <string>
#include <vector>

namespace aspic {

/// An option, or an argument of a command.
struct OptionFacts {
  std::vector<std::string> names;  ///< "--every"; of an argument its name without hyphens
  std::string value;               ///< of what kind its value is: "FILE", "on|off"; empty: it takes none
  std::string help;                ///< what it does, in a line
  std::string default_value;       ///< empty: none
  bool required = false;
  bool repeatable = false;
};

struct CommandFacts {
  std::string name;     ///< as it is typed: "aspic scene list"
  std::string summary;  ///< a sentence without a full stop
  std::string footer;   ///< examples and notes, which --help prints below the options
  std::vector<OptionFacts> arguments, options;
  std::vector<CommandFacts> commands;  ///< below it, in the order of --help
};

/// The program aspic with all of its commands.
CommandFacts describe_commands();

}  // namespace aspic

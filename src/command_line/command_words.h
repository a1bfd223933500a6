#pragma once
// Words of a command line against those that a command knows.
#include <string>
#include <vector>

#include "base/result.h"

namespace aspic {

/// A command with the words it takes.
struct CommandWords {
  std::string name;                   ///< "aspic run"
  std::vector<std::string> options;   ///< "--steps"
  std::vector<std::string> commands;  ///< below it
};

/// The error (usage) for a word that no option or argument takes, with what was probably meant.
Error unexpected_word(const CommandWords& command, const std::string& word);

/// Those of the options that are among the words, as they were typed.
std::vector<std::string> given_options(const std::vector<std::string>& options,
                                       const std::vector<std::string>& words);

}  // namespace aspic

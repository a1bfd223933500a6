#pragma once
// Manual pages and completion of the programs, made of their own options and of docs/commands.md.
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/command_facts.h"

namespace aspic::manual {

/// A file of an installation.
struct TextFile {
  std::string path;  ///< "man1/aspic-run.1", below the directory of all of them
  std::string text;
};

/// The sections of a page of Markdown with headings of the second level: by the heading without backticks,
/// the lines below it. What is above the first has the name "".
using Sections = std::map<std::string, std::vector<std::string>, std::less<>>;
Sections sections_of(std::string_view markdown);

/// Lines of Markdown as roff: paragraphs, tables of two columns, headings of the third level, code. Tables of
/// options are left out: the program knows them. Links become their text.
std::string roff_of(const std::vector<std::string>& markdown);

/// Text of people for roff: backslashes, hyphens and leading dots keep their meaning.
std::string roff_text(std::string_view text);

/// A page for each command, aspic.1 first. `date`: "2026-11-23". A section that a page needs must be there.
std::vector<TextFile> manual_pages(const CommandFacts& aspic, const Sections& commands_page,
                                   std::string_view date);

/// Values that completion offers for an option: words, and keys that end in =.
std::vector<std::string> known_values(const CommandFacts& command, const OptionFacts& option);

/// Names of the built-in scenes.
std::vector<std::string> scene_names();

/// Completion of `aspic` and of `aspic-view`, which has the options of `aspic view`.
std::vector<TextFile> bash_completion(const CommandFacts& aspic);
std::vector<TextFile> zsh_completion(const CommandFacts& aspic);
std::vector<TextFile> fish_completion(const CommandFacts& aspic);

/// The last word of a command's name: "list".
inline std::string last_word(const CommandFacts& command) {
  return command.name.substr(command.name.find_last_of(' ') + 1);
}

}  // namespace aspic::manual

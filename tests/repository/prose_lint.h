#pragma once
// A lint of the prose of pages and messages: the rules of CONTRIBUTING.md that a program can check.
#include <filesystem>
#include <string_view>
#include <vector>

#include "repository/text_lint.h"

namespace aspic::testing {

/// Readers of a page. Sentences of user pages have a limit.
enum class Readers { users, developers };

/// Offenses of a Markdown page in the order of lines. Code, link targets and labels of the window (*Label*)
/// are no prose. term: a word that misleads, with its replacement. spelling: a British spelling. opening: a
/// sentence that begins with What, Of, Refused or So. length: a sentence of more than 30 words; symbols do
/// not count. bracket: an unquoted [,
/// ], { or } in a shell command. output: a name that two commands of the page write.
std::vector<Offense> lint_prose(std::string_view page, Readers readers);

/// The language of a file.
enum class Language { cpp, python, javascript, html };

/// Offenses of the string literals with a space, and of the texts of HTML, which users see as messages, help,
/// tooltips and docstrings. The rules are those of user pages, line by line.
std::vector<Offense> lint_strings(std::string_view code, Language language = Language::cpp);

/// docstring: a docstring of a Python function, other than a property, that does not begin with an
/// imperative.
std::vector<Offense> lint_docstrings(std::string_view code);

/// tooltip: a tooltip of the window, a literal that begins with a verb such as Adds, with a sentence of more
/// than 12 words.
std::vector<Offense> lint_tooltips(std::string_view code);

/// README.md, CONTRIBUTING.md and all pages of docs, as paths below `root`, with their readers: developers
/// for the pages that docs/README.md lists under *Developers*.
std::vector<std::pair<std::filesystem::path, Readers>> prose_pages(const std::filesystem::path& root);

}  // namespace aspic::testing

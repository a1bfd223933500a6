#include "scene/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/lines.h"
#include "base/printable.h"
#include "scene/parameters.h"

namespace aspic::diagnostics {
namespace {

/// Problems of one file that are shown.
constexpr std::size_t most_shown = 20;
/// Lines longer than this are shown in part, around the culprit.
constexpr std::size_t shown_characters = 100;
/// Arguments longer than this are named in part; the line below shows the place.
constexpr std::size_t longest_label = 200;

/// The line as UTF-8 characters, fit for a terminal and each as wide as in the file, so that the caret stays
/// below the culprit: tabs as single spaces, control characters and bytes that are not UTF-8 as question
/// marks.
std::vector<std::string> characters_of(std::string_view line) {
  std::vector<std::string> characters;
  while (!line.empty()) {
    const Utf8Character c = first_character(line);
    if (c.code == '\t') {
      characters.emplace_back(" ");
    } else if (!c.valid || acts_on_terminal(c.code)) {
      characters.emplace_back("?");
    } else {
      characters.emplace_back(line.substr(0, c.size));
    }
    line.remove_prefix(c.size);
  }
  return characters;
}

/// Two lines: the text behind `gutter`, and the caret behind `blank_gutter` of the same width.
std::string line_with_caret(std::string_view line, std::uint32_t column, std::string_view gutter,
                            std::string_view blank_gutter) {
  const std::vector<std::string> characters = characters_of(line);
  const std::size_t culprit = column - 1;
  std::size_t begin = 0, end = characters.size();
  if (characters.size() > shown_characters) {
    begin = culprit > shown_characters / 2 ? culprit - shown_characters / 2 : 0;
    begin = std::min(begin, characters.size() - shown_characters);
    end = begin + shown_characters;
  }
  const std::string_view cut_before = begin > 0 ? "… " : "", cut_after = end < characters.size() ? " …" : "";
  std::string shown;
  for (std::size_t i = begin; i < end; ++i) shown += characters[i];
  const std::size_t indent = (begin > 0 ? 2 : 0) + culprit - begin;
  return fmt::format("{}{}{}{}\n{}{}^", gutter, cut_before, shown, cut_after, blank_gutter,
                     std::string(indent, ' '));
}

std::string rendered(const Source& source, const Problem& problem) {
  // A key or a name may hold a line feed.
  const std::string label = source.kind == Source::argument ? excerpt(source.label, longest_label)
                                                            : printable_line(source.label),
                    message = printable_line(problem.message);
  if (source.kind == Source::none) return fmt::format("{}: {}", label, message);
  const std::string_view line = line_of(source.text, problem.at.line);
  const std::uint32_t column = problem.at.column;
  if (source.kind == Source::argument) {
    return fmt::format("{}: {}\n{}", label, message, line_with_caret(line, column, "  ", "  "));
  }
  return fmt::format(
      "{}:{}:{}: {}\n{}", label, problem.at.line, column, message,
      line_with_caret(
          line, column, fmt::format("{:>4} | ", problem.at.line),
          fmt::format("{:>{}} | ", "", std::max<std::size_t>(4, std::to_string(problem.at.line).size()))));
}

}  // namespace

Error rejection(std::span<const Source> sources, std::vector<Problem> problems) {
  std::ranges::stable_sort(problems, {}, &Problem::at);
  problems.erase(std::unique(problems.begin(), problems.end()), problems.end());
  std::vector<std::string> texts(problems.size());  // those that are shown
  for (std::size_t i = 0; i < std::min(problems.size(), most_shown); ++i)
    texts[i] = rendered(sources[problems[i].at.source], problems[i]);
  return Error{ErrorCode::scene_rejected, joined(texts, "\n\n")};
}

std::string joined(std::span<const std::string> texts, std::string_view between) {
  const std::size_t shown = std::min(texts.size(), most_shown);
  std::string all = fmt::format("{}", fmt::join(texts.first(shown), between));
  if (texts.size() > shown) all += fmt::format("{}and {} more", between, texts.size() - shown);
  return all;
}

std::string list_text(std::span<const std::string_view> words, bool quoted) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += quoted ? fmt::format("\"{}\"", words[i]) : std::string(words[i]);
  }
  return text;
}

std::string table_text(std::string_view table_path) {
  if (table_path.empty()) return "the file";
  if (table_path.ends_with("[]")) return fmt::format("[[{}]]", table_path.substr(0, table_path.size() - 2));
  std::string text(table_path);
  if (const std::size_t brackets = text.find("[]"); brackets != std::string::npos) text.erase(brackets, 2);
  return fmt::format("[{}]", text);
}

std::string unknown_key(std::string_view table_path, std::string_view key) {
  std::vector<std::string_view> known = child_keys(table_path);
  if (const std::string_view near = nearest(key, known); !near.empty()) {
    return fmt::format("unknown key '{}' in {}{}", key, table_text(table_path), did_you_mean(near));
  }
  // The right key in the wrong table is the other common slip.
  std::vector<std::string_view> homes;
  for (const Parameter& p : parameters()) {
    const std::size_t dot = p.path.rfind('.');
    if (dot != std::string_view::npos && p.path.substr(dot + 1) == key) homes.push_back(p.path);
  }
  if (!homes.empty() && homes.size() <= 4) {
    return fmt::format("unknown key '{}' in {}; did you mean {}?", key, table_text(table_path),
                       list_text(homes, false));
  }
  return fmt::format("unknown key '{}' in {}; known are {}", key, table_text(table_path),
                     list_text(known, false));
}

}  // namespace aspic::diagnostics

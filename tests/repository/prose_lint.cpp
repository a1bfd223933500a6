#include "repository/prose_lint.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <utility>

namespace aspic::testing {
namespace {

struct Term {
  std::string_view words;  ///< lower case; the first of several forms
  std::string_view forms;  ///< endings of further forms, apart by spaces
  std::string_view better;
};
constexpr Term terms[] = {
    {"by the clock", "", "wall-clock time"},
    {"processor", "s", "CPU or CPU core"},
    {"picture", "s", "image or frame"},
    {"film", "s ed ing", "video"},
    {"rub", "s bed bing", "friction"},
    {"squash", "es ed", "compression"},
    {"room", "s", "module"},
    {"drawer", "s", "render worker"},
    {"beside", "", "next to"},
    {"nobody", "", "name who acts"},
    {"nothing but", "", "only"},
    {"goes on", "", "continues"},
    {"go on", "", "continue"},
    {"so many", "", "state the number"},
    {"that many", "", "state the number"},
    {"is told", "", "say who reports"},
    {"are told", "", "say who reports"},
    {"is looked at", "", "say who inspects"},
    {"are looked at", "", "say who inspects"},
    {"is none of", "", "state the fact"},
    {"are none of", "", "state the fact"},
    {"kept state", "", "window settings"},
};
/// Parts of words in British spelling, and the American ones.
constexpr std::pair<std::string_view, std::string_view> spellings[] = {{"colour", "color"},
                                                                       {"centre", "center"},
                                                                       {"centring", "centering"},
                                                                       {"neighbour", "neighbor"},
                                                                       {"behaviour", "behavior"},
                                                                       {"favour", "favor"},
                                                                       {"honour", "honor"},
                                                                       {"grey", "gray"},
                                                                       {"metre", "meter"},
                                                                       {"fibre", "fiber"},
                                                                       {"licence", "license"},
                                                                       {"offence", "offense"},
                                                                       {"defence", "defense"},
                                                                       {"artefact", "artifact"},
                                                                       {"analyse", "analyze"},
                                                                       {"cancelled", "canceled"},
                                                                       {"cancelling", "canceling"},
                                                                       {"labelled", "labeled"},
                                                                       {"travelled", "traveled"},
                                                                       {"modelled", "modeled"},
                                                                       {"anticlockwise", "counterclockwise"},
                                                                       {"alis", "aliz"},
                                                                       {"aris", "ariz"},
                                                                       {"elis", "eliz"},
                                                                       {"eris", "eriz"},
                                                                       {"imis", "imiz"},
                                                                       {"onis", "oniz"},
                                                                       {"oris", "oriz"},
                                                                       {"ganis", "ganiz"},
                                                                       {"cognis", "cogniz"},
                                                                       {"maris", "mariz"}};
/// Endings after parts of words that end in "is".
constexpr std::string_view verb_endings[] = {"e ", "ed ", "er ", "ers ", "es ", "ing ", "ation ", "ations "};
/// First words of docstrings.
constexpr std::string_view verbs[] = {
    "Act",     "Add",      "Advance", "Apply",  "Begin",     "Change",  "Check",  "Close",
    "Compare", "Create",   "End",     "Give",   "Interrupt", "Load",    "Make",   "Move",
    "Open",    "Pull",     "Raise",   "Read",   "Render",    "Replace", "Return", "Run",
    "Set",     "Simulate", "Store",   "Submit", "Wrap",      "Write",   "Yield"};
constexpr int most_tooltip_words = 12;
constexpr std::string_view openings[] = {"What", "Of", "Refused", "So"};
constexpr int most_words = 30;

bool is_letter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80;
}

/// A line without code, link targets, images and labels.
std::string prose_of(const std::string& line) {
  static const std::regex code("`+[^`]*`+"), target(R"(\]\([^)]*\))"), label(R"((^|[^*])\*[^* ][^*]*\*)");
  std::string text = std::regex_replace(line, code, "`");
  text = std::regex_replace(text, target, "]");
  return std::regex_replace(text, label, "$1`");
}

/// Lower-case words with a space before and behind each.
std::string words_of(const std::string& prose) {
  std::string words = " ";
  for (const char c : prose) {
    if (is_letter(c))
      words += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    else if (words.back() != ' ')
      words += ' ';
  }
  return words + ' ';
}

/// Sentences of a line: a cell of a table, or up to a full stop or colon, without what marks lists and
/// headings.
std::vector<std::string> sentences_of(const std::string& prose) {
  std::vector<std::string> found(1);
  for (std::size_t i = 0; i < prose.size(); ++i) {
    const bool cell = prose[i] == '|' && (i == 0 || prose[i - 1] != '\\');
    if (!cell) found.back() += prose[i];
    const bool stop = std::string_view(".:!?").find(prose[i]) != std::string_view::npos &&
                      (i + 1 == prose.size() || prose[i + 1] == ' ');
    if (cell || stop) found.emplace_back();
  }
  for (std::string& sentence : found) {
    const auto start = std::ranges::find_if(sentence, [](char c) { return is_letter(c) || c == '`'; });
    sentence.erase(sentence.begin(), start);
  }
  return found;
}

/// Words and numbers of a sentence; other symbols, as of formulas, do not count.
int length_of(const std::string& sentence) {
  static constexpr std::string_view marks = ".,;:'\"()*/%[]_-`";
  int count = 0;
  std::istringstream words(sentence);
  for (std::string word; words >> word;) {
    const auto plain = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) || marks.find(c) != std::string_view::npos;
    };
    count += std::ranges::all_of(word, plain) &&
             std::ranges::any_of(word, [](char c) { return is_letter(c) || c == '`'; });
  }
  return count;
}

/// Attributes and texts of HTML with their lines.
std::vector<std::pair<int, std::string>> texts_of(std::string_view html) {
  static const std::regex text(R"x(="([^"]*)"|>([^<>]+)<)x");
  std::vector<std::pair<int, std::string>> found;
  const std::string all(html);
  for (std::sregex_iterator at(all.begin(), all.end(), text), end; at != end; ++at) {
    const auto lines = std::count(all.begin(), all.begin() + at->position(), '\n');
    found.emplace_back(1 + static_cast<int>(lines), at->str(1) + at->str(2));
  }
  return found;
}

/// String literals of a file with their first lines; adjacent ones are one.
std::vector<std::pair<int, std::string>> literals_of(std::string_view code, Language language) {
  if (language == Language::html) return texts_of(code);
  const bool python = language == Language::python, script = language == Language::javascript;
  std::vector<std::pair<int, std::string>> found;
  bool adjacent = false;
  int line = 1;
  for (std::size_t i = 0; i < code.size(); ++i) {
    const char c = code[i];
    line += c == '\n';
    if (code.substr(i).starts_with(python ? "#" : "//")) {
      i = std::min(code.find('\n', i), code.size()) - 1;
      continue;
    }
    const bool raw = language == Language::cpp && code.substr(i, 2) == "R\"";
    const bool number = c == '\'' && !python && i > 0 && is_letter(code[i - 1]);  // 1'000
    if (!raw && (number || (c != '"' && c != '\'' && !(script && c == '`')))) {
      adjacent = adjacent && std::isspace(static_cast<unsigned char>(c));
      continue;
    }
    std::string close(1, c);
    std::size_t start = i + 1;
    if (raw) {
      start = code.find('(', i) + 1;
      close = ')' + std::string(code.substr(i + 2, start - i - 3)) + '"';
    } else if (python && code.substr(i, 3) == std::string(3, c)) {
      close = std::string(3, c);
      start = i + 3;
    }
    std::size_t end = start;
    while (end < code.size() && !code.substr(end).starts_with(close))
      end += !raw && code[end] == '\\' ? 2 : 1;
    const std::string text(code.substr(start, end - start));
    if (adjacent)
      found.back().second += text;
    else
      found.emplace_back(line, c == '\'' && language == Language::cpp ? "" : text);
    adjacent = true;
    line += static_cast<int>(std::ranges::count(text, '\n'));
    i = end + close.size() - 1;
  }
  return found;
}

class Page {
 public:
  explicit Page(Readers readers) : readers_(readers) {}

  void prose(int line, const std::string& text) {
    const std::string plain = prose_of(text), words = words_of(plain);
    for (const Term& term : terms) {
      std::istringstream endings{std::string(term.forms)};
      std::string ending;
      do {
        if (words.find(" " + std::string(term.words) + ending + " ") != std::string::npos)
          add(line, "term", std::string(term.words) + ending + ": " + std::string(term.better));
      } while (endings >> ending);
    }
    for (const auto& [british, american] : spellings)
      for (std::size_t at = words.find(british); at != std::string::npos; at = words.find(british, at + 1)) {
        const std::string_view rest = std::string_view(words).substr(at + british.size());
        if (!british.ends_with("is") || std::ranges::any_of(verb_endings, [&](std::string_view ending) {
              return rest.starts_with(ending);
            }))
          add(line, "spelling", std::string(british) + ": " + std::string(american));
      }
    for (const std::string& sentence : sentences_of(plain)) {
      for (const std::string_view opening : openings)
        if (sentence.starts_with(opening) && !is_letter(sentence[opening.size()]))
          add(line, "opening", sentence);
      if (const int length = length_of(sentence); readers_ == Readers::users && length > most_words)
        add(line, "length", std::to_string(length) + " words: " + sentence);
    }
    static const std::regex code("`(aspic [^`]*)`");
    for (std::sregex_iterator span(text.begin(), text.end(), code), end; span != end; ++span)
      command(line, span->str(1));
  }

  /// A line of a block; several that end in a backslash are one.
  void block(int line, std::string text) {
    const bool more = text.ends_with('\\');
    if (more) text.pop_back();
    if (joined_.empty()) first_ = line;
    joined_ += text;
    if (more) return;
    static const std::regex program(
        R"(^\s*(sudo )?(\w+=\S+ )*(aspic|build/\S+|scripts/\S+|tests/\S+|cmake|ctest|python3?|pip|dask|blender) .*)");
    if (std::regex_match(joined_, program)) command(first_, joined_);
    joined_.clear();
  }

  std::vector<Offense> take() {
    std::ranges::stable_sort(found_, {}, &Offense::line);
    return std::move(found_);
  }

 private:
  void command(int line, const std::string& text) {
    static const std::regex quoted(R"('[^']*'|"[^"]*"|\[[A-Z]+\])"), comment(R"((^|\s)#.*)"),
        output(R"((--(video|frames|html|html-live|state|series|checkpoint|export|out|runs)|>)[ =](\S+))");
    const std::string bare = std::regex_replace(std::regex_replace(text, quoted, "'"), comment, "");
    if (bare.find_first_of("[]{}") != std::string::npos) add(line, "bracket", text);
    for (std::sregex_iterator at(bare.begin(), bare.end(), output), end; at != end; ++at) {
      const auto [first, is_new] = outputs_.emplace(at->str(3), line);
      if (!is_new) add(line, "output", at->str(3) + " is written in line " + std::to_string(first->second));
    }
  }

  void add(int line, std::string rule, std::string text) {
    found_.push_back({line, std::move(rule), std::move(text)});
  }

  Readers readers_;
  std::vector<Offense> found_;
  std::map<std::string, int> outputs_;
  std::string joined_;
  int first_ = 0;
};

}  // namespace

std::vector<Offense> lint_prose(std::string_view text, Readers readers) {
  Page page(readers);
  std::istringstream lines{std::string(text)};
  bool fenced = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("```"))
      fenced = !fenced;
    else if (fenced || line.starts_with("    "))
      page.block(number, line);
    else
      page.prose(number, line);
  }
  return page.take();
}

std::vector<Offense> lint_strings(std::string_view code, Language language) {
  std::vector<Offense> found;
  for (const auto& [first, literal] : literals_of(code, language)) {
    static const std::regex escape(R"(\\n|\n)"), quote(R"(\\(.))");
    int line = first;
    for (std::sregex_token_iterator at(literal.begin(), literal.end(), escape, -1), end; at != end; ++at) {
      const std::string text = std::regex_replace(at->str(), quote, "$1");
      if (const auto start = text.find_first_not_of(' '); text.find(' ', start) != std::string::npos) {
        Page page(Readers::users);
        page.prose(line, text);
        std::ranges::move(page.take(), std::back_inserter(found));
      }
      line += at->second != literal.end() && *at->second == '\n';
    }
  }
  return found;
}

std::vector<Offense> lint_docstrings(std::string_view code) {
  static const std::regex function(R"(\s*(async )?def .*)"), first_word(R"x(\s*"{3}(\w*).*)x");
  std::vector<Offense> found;
  std::istringstream lines{std::string(code)};
  bool is_property = false, in_signature = false, is_body = false;
  int number = 0;
  for (std::string line; std::getline(lines, line); ++number) {
    std::smatch word;
    if (is_body && !is_property && std::regex_match(line, word, first_word) &&
        std::ranges::find(verbs, word.str(1)) == std::end(verbs))
      found.push_back({number + 1, "docstring",
                       "begins with \"" + word.str(1) + "\", which is no imperative of `verbs`"});
    if (is_body) is_property = false;
    is_property =
        is_property || line.find("@") < line.find("property") || line.find(".setter") != std::string::npos;
    in_signature = in_signature || std::regex_match(line, function);
    is_body = in_signature && line.ends_with(':');
    if (is_body) in_signature = false;
  }
  return found;
}

std::vector<Offense> lint_tooltips(std::string_view code) {
  static const std::regex verb(R"([A-Z][a-z]+s )");
  std::vector<Offense> found;
  for (const auto& [line, literal] : literals_of(code, Language::cpp)) {
    const std::string text = literal.substr(0, literal.find("\\n"));
    if (!text.ends_with('.') || !std::regex_search(text, verb, std::regex_constants::match_continuous))
      continue;
    for (const std::string& sentence : sentences_of(text))
      if (const int length = length_of(sentence); length > most_tooltip_words)
        found.push_back({line, "tooltip", std::to_string(length) + " words: " + sentence});
  }
  return found;
}

std::vector<std::pair<std::filesystem::path, Readers>> prose_pages(const std::filesystem::path& root) {
  const std::string list = contents(root / "docs/README.md");
  const std::string developers = list.substr(list.find("## Developers"));
  std::vector<std::pair<std::filesystem::path, Readers>> pages;
  for (const std::filesystem::path& file : written_files(root)) {
    if (file.extension() != ".md") continue;
    const bool in_docs = file.parent_path() == "docs";
    if (!in_docs && file != "README.md" && file != "CONTRIBUTING.md") continue;
    const bool listed =
        in_docs && developers.find("](" + file.filename().string() + ")") != std::string::npos;
    pages.emplace_back(file, listed ? Readers::developers : Readers::users);
  }
  return pages;
}

}  // namespace aspic::testing

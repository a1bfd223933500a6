#include "repository/class_lint.h"

#include <algorithm>
#include <cctype>
#include <regex>
#include <set>
#include <utility>

namespace aspic::testing {
namespace {

/// Without comments, literals and lines of the preprocessor.
std::string bare(std::string_view text) {
  std::string result;
  bool line_start = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const std::string_view two = text.substr(i, 2);
    if (two == "//" || (c == '#' && line_start)) {
      while (i < text.size() && text[i] != '\n') i += text[i] == '\\' ? 2 : 1;
      result += '\n';
      line_start = true;
      continue;
    }
    if (two == "/*") {
      i = std::min(text.find("*/", i + 2), text.size() - 2) + 1;
      continue;
    }
    // A quote after a digit separates digits.
    if (c == '"' || (c == '\'' && !(i > 0 && std::isalnum(static_cast<unsigned char>(text[i - 1]))))) {
      for (++i; i < text.size() && text[i] != c; ++i) i += text[i] == '\\' ? 1 : 0;
      continue;
    }
    line_start = c == '\n' || (line_start && std::isspace(static_cast<unsigned char>(c)));
    result += c;
  }
  return result;
}

/// The place behind the bracket that closes the one at `open`.
std::size_t behind(std::string_view text, std::size_t open, char opening, char closing) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == opening) ++depth;
    if (text[i] == closing && --depth == 0) return i + 1;
  }
  return text.size();
}

std::string last_name(const std::string& qualified) {
  const std::size_t colon = qualified.rfind(':');
  return colon == std::string::npos ? qualified : qualified.substr(colon + 1);
}

/// The name and the parameters of a method that is declared; empty: it declares no method that counts.
std::string method_of(const std::string& declaration, const std::string& class_name) {
  static const std::regex other(R"(^\s*(friend|using|typedef|enum|struct|class|static_assert)\b)");
  static const std::regex before_name(R"(^\s*(template\s*<[^;]*?>\s+(?=[A-Za-z]))?)");
  static const std::regex name(R"(([~A-Za-z_]\w*)\s*\()");
  if (std::regex_search(declaration, other)) return "";
  const std::string text = std::regex_replace(declaration, before_name, "");
  std::smatch match;
  if (!std::regex_search(text, match, name)) return "";
  const std::string head = match.prefix().str();
  const auto count = [&](char c) { return std::ranges::count(head, c); };
  // What is called there is a default value, or the name is a type's argument: std::function<void(int)> f.
  if (head.find('=') != std::string::npos || count('<') != count('>')) return "";
  if (text.substr(0, text.find('(')).find("operator") != std::string::npos) return "";
  if (match.str(1) == last_name(class_name) || match.str(1).starts_with("~")) return "";
  const auto open = static_cast<std::size_t>(match.position(0) + match.length(0)) - 1;
  const std::size_t end = behind(text, open, '(', ')');
  if (text.find("= delete", end) != std::string::npos) return "";
  static const std::regex blanks(R"(\s+)");
  return match.str(1) + std::regex_replace(text.substr(open, end - open), blanks, " ");
}

std::size_t count_methods(const std::string& class_name, bool is_struct, std::string_view body) {
  static const std::regex access(R"(^\s*(public|private|protected)\s*:(?!:))");
  static const std::regex inner(R"(^\s*(class|struct|enum|union)\b[^(]*$)");
  static const std::regex value(R"((=|[,:]\s*\w+)\s*$)");
  std::set<std::string> methods;
  std::string declaration;
  bool is_public = is_struct;
  const auto end = [&] {
    if (is_public) methods.insert(method_of(declaration, class_name));
    declaration.clear();
  };
  for (std::size_t i = 0; i < body.size(); ++i) {
    std::cmatch match;
    if (declaration.find_first_not_of(" \n") == std::string::npos &&
        std::regex_search(body.data() + i, body.data() + body.size(), match, access,
                          std::regex_constants::match_continuous)) {
      is_public = match.str(1) == "public";
      i += static_cast<std::size_t>(match.length(0)) - 1;
      declaration.clear();
    } else if (body[i] == ';') {
      end();
    } else if (body[i] == '{') {
      i = behind(body, i, '{', '}') - 1;
      if (std::regex_search(declaration, inner))
        declaration.clear();
      else if (declaration.find(')') != std::string::npos && !std::regex_search(declaration, value))
        end();
      else
        declaration += "{}";
    } else {
      declaration += body[i];
    }
  }
  methods.erase("");
  return methods.size();
}

}  // namespace

std::vector<ClassSize> class_sizes(std::string_view header) {
  static const std::regex opening(
      R"((enum\s+)?\b(class|struct)\s+([A-Za-z_][\w:]*)\s*(final\s*)?(:[^;{(]*)?\{)");
  const std::string text = bare(header);
  std::vector<ClassSize> classes;
  for (std::sregex_iterator match(text.begin(), text.end(), opening), none; match != none; ++match) {
    if ((*match)[1].matched) continue;
    const auto open = static_cast<std::size_t>(match->position(0) + match->length(0)) - 1;
    const std::size_t end = behind(text, open, '{', '}');
    const std::string_view body = std::string_view(text).substr(open + 1, end - open - 2);
    classes.push_back({match->str(3), count_methods(match->str(3), match->str(2) == "struct", body)});
  }
  return classes;
}

}  // namespace aspic::testing

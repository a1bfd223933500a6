#include "repository/comment_lint.h"

#include <cctype>
#include <regex>
#include <sstream>
#include <utility>

namespace aspic::testing {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\n");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

/// A line without its comment and without what its literals hold.
std::string code_of(const std::string& line) {
  std::string code;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line.compare(i, 2, "//") == 0) break;
    // A quote after a digit separates digits.
    const bool literal = line[i] == '"' || (line[i] == '\'' && !(i > 0 && std::isalnum(line[i - 1])));
    code += line[i];
    if (!literal) continue;
    const char quote = line[i];
    for (++i; i < line.size() && line[i] != quote; ++i) i += line[i] == '\\' ? 1 : 0;
    code += quote;
  }
  return code;
}

const std::regex type_head(R"(^(template\s*<[^;]*?>\s*)?(class|struct|union)\b[^()=]*$)");
const std::regex enum_head(R"(^enum\b[^()=]*$)");

/// The word that a declaration introduces, without its template arguments.
std::string name_of(std::string text) {
  static const std::regex template_head(R"(^(template\s*<.*?>\s+(?=[A-Za-z\[]))+)");
  static const std::regex attributes(R"(\[\[.*?\]\]\s*)");
  static const std::regex type(R"((?:class|struct|union|enum)\s+(?:class\s+)?(?:ASPIC_API\s+)?(\w+))");
  static const std::regex alias(R"(^using\s+(\w+))");
  static const std::regex function(R"((~?\w+)\s*\()");
  static const std::regex data(R"((\w+)\s*(\[.*\])?\s*(=|,|\{|$))");
  text = std::regex_replace(std::regex_replace(text, attributes, ""), template_head, "");
  std::smatch match;
  if (std::regex_search(text, match, alias)) return match.str(1);
  if (std::regex_search(text, type_head) || std::regex_search(text, enum_head))
    return std::regex_search(text, match, type) ? match.str(1) : text;
  const std::string head = text.substr(0, text.find('='));
  if (std::regex_search(head, match, function)) return match.str(1);
  return std::regex_search(text, match, data) ? match.str(1) : text;
}

class Reader {
 public:
  std::vector<Uncommented> read(std::string_view header) {
    std::istringstream lines{std::string(header)};
    bool goes_on = false;  // a line of the preprocessor with a backslash at its end
    for (std::string line; std::getline(lines, line);) {
      ++line_;
      const std::string text = trimmed(line);
      const bool directive = goes_on || text.starts_with('#');
      goes_on = directive && text.ends_with('\\');
      if (directive) continue;
      if (text.starts_with("//") || text.empty()) {
        above_ = text.starts_with("///") && !text.starts_with("///<");
        if (text.empty()) shared_.clear();
        continue;
      }
      take(code_of(line), line.find("///<") != std::string::npos);
      above_ = false;
    }
    return std::move(found_);
  }

 private:
  enum class Kind { space, type, list };
  struct Value {
    int line;
    std::string name;
    bool commented;
  };
  struct Scope {
    Kind kind = Kind::space;
    std::string name = {};
    bool visible = true;
    std::vector<Value> values = {};  // of an enumeration
  };

  void take(const std::string& code, bool behind) {
    // The comment behind is that of every declaration on the line, also of those that end here.
    behind_ = behind_ || behind;
    for (const char c : code) {
      if (text_.empty()) {
        if (std::isspace(static_cast<unsigned char>(c))) continue;
        start_ = line_;
        commented_ = above_;
        behind_ = behind;
      }
      take(c);
    }
    if (!text_.empty()) text_ += ' ';
  }

  void take(char c) {
    if (braces_ > 0) {  // a body or an initializer
      if (c == '{') ++braces_;
      if (c == '}' && --braces_ == 0 && is_body_) declare();
      return;
    }
    if (c == '(') ++brackets_;
    if (c == ')') --brackets_;
    if (brackets_ > 0 || (c != '{' && c != '}' && c != ';' && c != ':' && c != ',')) {
      text_ += c;
      return;
    }
    const std::string head = trimmed(text_);
    Scope& scope = scopes_.back();
    if (c == ':' && (head == "public" || head == "protected" || head == "private")) {
      scope.visible = head != "private";
      text_.clear();
    } else if (c == '{' && head.starts_with("namespace")) {
      hidden_.push_back(hidden_.back());
      enter({});
    } else if (c == '{' && (std::regex_search(head, type_head) || std::regex_search(head, enum_head))) {
      static const std::regex structure(R"(\b(struct|union|enum)\b)");
      const Kind kind = std::regex_search(head, enum_head) ? Kind::list : Kind::type;
      hidden_.push_back(hidden_.back() || !scope.visible);
      const Scope inner = {kind, name_of(head), std::regex_search(head, structure)};
      declare(true);
      enter(inner);
    } else if (c == '{') {
      braces_ = 1;
      is_body_ = head.find(')') != std::string::npos && !head.ends_with('=');
    } else if (c == '}') {
      if (scope.kind == Kind::list) leave_list();
      if (scopes_.size() > 1) {
        scopes_.pop_back();
        hidden_.pop_back();
      }
      text_.clear();
    } else if (c == ';' || (c == ',' && scope.kind == Kind::list)) {
      declare();
    } else {
      text_ += c;
    }
  }

  void enter(Scope scope) {
    scopes_.push_back(std::move(scope));
    text_.clear();
  }

  void leave_list() {
    declare();
    bool any = false;
    for (const Value& value : scopes_.back().values) any = any || value.commented;
    for (const Value& value : scopes_.back().values)
      if (any && !value.commented && !hidden_.back()) found_.push_back({value.line, value.name});
  }

  /// Ends the declaration that was read so far; `opens`: it is a type whose members follow.
  void declare(bool opens = false) {
    static const std::regex exempt(
        R"(^friend\b|\bfriend\b.*\(|^static_assert\b|\boperator\b|=\s*(default|delete)$|^(template\s*<.*>\s*)?(struct|class|enum)\b[^({=]*$)");
    const std::string text = trimmed(std::exchange(text_, ""));
    Scope& scope = scopes_.back();
    if (text.empty()) return;
    const std::string name = name_of(text);
    const bool commented = commented_ || behind_;
    if (scope.kind == Kind::list) {
      scope.values.push_back({start_, name, commented});
      return;
    }
    if (is_hidden(opens) || (!opens && std::regex_search(text, exempt))) return;
    if (name == scope.name || name.starts_with('~')) return;
    if (commented)
      shared_ = text.find('(') != std::string::npos ? name : "";
    else if (shared_ != name)
      found_.push_back({start_, name});
  }

  /// Whether nobody outside sees what is declared here. The entry of a type that opens is there already.
  bool is_hidden(bool opens) const { return hidden_.back() || (!opens && !scopes_.back().visible); }

  int line_ = 0, start_ = 0;
  int braces_ = 0, brackets_ = 0;
  bool above_ = false, behind_ = false, commented_ = false, is_body_ = false;
  std::string text_, shared_;
  std::vector<Scope> scopes_ = {{}};
  std::vector<bool> hidden_ = {false};  // by scope: inside of something private
  std::vector<Uncommented> found_;
};

}  // namespace

std::vector<Uncommented> uncommented(std::string_view header) {
  return Reader().read(header);
}

}  // namespace aspic::testing

#include "gpu/precise_lint.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>

#include "gpu/glsl_tokens.h"

namespace aspic::testing {
namespace {

bool is_float_type(const std::string& t) {
  static const std::set<std::string> types = {"float", "vec2", "vec3", "vec4", "double", "dvec2", "dvec3",
                                              "dvec4", "mat2", "mat3", "mat4", "dmat2",  "dmat3", "dmat4"};
  return types.contains(t);
}

bool is_other_type(const std::string& t) {
  static const std::set<std::string> types = {"int",   "uint",  "bool",  "ivec2", "ivec3", "ivec4",
                                              "uvec2", "uvec3", "uvec4", "bvec2", "bvec3", "bvec4"};
  return types.contains(t);
}

bool is_forbidden(const std::string& t) {
  static const std::set<std::string> names = {
      "inversesqrt", "normalize", "length",      "dot",          "cross",
      "mix",         "distance",  "reflect",     "refract",      "faceforward",
      "smoothstep",  "pow",       "exp",         "exp2",         "log",
      "log2",        "sin",       "cos",         "tan",          "asin",
      "acos",        "atan",      "sinh",        "cosh",         "tanh",
      "asinh",       "acosh",     "atanh",       "mod",          "modf",
      "radians",     "degrees",   "determinant", "outerProduct", "matrixCompMult",
      "inverse",     "sqrt"};
  return names.contains(t);
}

bool is_float_literal(const std::string& t) {
  if (t.empty() || !(std::isdigit(static_cast<unsigned char>(t.front())) || t.front() == '.')) return false;
  return t != "." && t.find_first_of(".eEf") != std::string::npos && !t.starts_with("0x");
}

bool is_zero(const std::string& t) {
  if (!is_float_literal(t)) return false;
  return std::ranges::none_of(t.substr(0, t.find_first_of("eE")),
                              [](char c) { return c >= '1' && c <= '9'; });
}

class Linter {
 public:
  Linter(std::string_view path, std::string_view text) : path_(path), tokens_(tokens_of(text)) {}

  std::vector<Offense> run() {
    for (at_ = 0; at_ < tokens_.size(); ++at_) {
      check_scope();
      check_declaration();
      check_call();
      check_zero();
      if (in_code()) {
        check_store();
        if (text() == "return" && returns_float_) check_expression("inexact-return", at_ + 1);
      }
    }
    std::ranges::stable_sort(offenses_, {}, &Offense::line);
    return std::move(offenses_);
  }

 private:
  enum class Scope { data, code };
  struct Variable {
    bool is_float;
    bool precise;
  };

  const std::string& text(std::ptrdiff_t offset = 0) const {
    static const std::string none;
    const auto i = static_cast<std::ptrdiff_t>(at_) + offset;
    return i >= 0 && i < static_cast<std::ptrdiff_t>(tokens_.size())
               ? tokens_[static_cast<std::size_t>(i)].text
               : none;
  }
  bool in_code() const { return !scopes_.empty() && scopes_.back() == Scope::code; }
  void offend(const char* rule, std::size_t i) {
    offenses_.push_back({tokens_[i].line, rule, tokens_[i].text});
  }

  void check_scope() {
    if (text() == "{") {
      const bool function = scopes_.empty() && text(-1) == ")";
      scopes_.push_back(function || in_code() ? Scope::code : Scope::data);
    } else if (text() == "}" && !scopes_.empty()) {
      scopes_.pop_back();
    }
  }

  void check_declaration() {
    const bool is_float = is_float_type(text());
    if ((!is_float && !is_other_type(text())) || !is_name(text(1))) return;
    if (text(2) == "(" && scopes_.empty()) {
      returns_float_ = is_float;
      return;
    }
    const bool precise = text(-1) == "precise" || (text(-1) == "const" && text(-2) == "precise");
    // All names of `float a = …, b;`: a comma outside brackets starts the next; a parameter list ends at its
    // comma.
    int depth = 0;
    declare(at_ + 1, is_float, precise);
    for (std::size_t i = at_ + 2; i < tokens_.size() && !scopes_.empty(); ++i) {
      const std::string& t = tokens_[i].text;
      if (t == "(" || t == "[" || t == "{") ++depth;
      if ((t == ")" || t == "]" || t == "}") && --depth < 0) break;
      if (t == ";") break;
      if (t == "," && depth == 0) declare(i + 1, is_float, precise);
    }
  }

  void declare(std::size_t i, bool is_float, bool precise) {
    if (i >= tokens_.size()) return;
    variables_[tokens_[i].text] = {is_float, precise};
    if (in_code() && is_float && !precise) offend("missing-precise", i);
  }

  void check_call() {
    if (text(1) != "(" || text(-1) == ".") return;
    const bool device = path_ == "compute/device_arithmetic.glsl";
    if (is_forbidden(text()) && !(device && text().ends_with("sqrt"))) offend("forbidden", at_);
    if (text() == "fma" && !device) offend("fma", at_);
    if (in_code()) check_arguments();
  }

  /// `precise` need not reach what is computed within the arguments of a call. Constructors are no calls, and
  /// bit casts take integers; a call within an argument is looked at by itself.
  void check_arguments() {
    static const std::set<std::string> no_calls = {"if",     "for",  "while",           "switch",
                                                   "return", "else", "uintBitsToFloat", "intBitsToFloat"};
    if (!is_name(text()) || no_calls.contains(text()) || is_float_type(text()) || is_other_type(text()))
      return;
    bool is_float = false;
    std::size_t operation = 0;  // the argument's first; 0: none yet
    std::vector<bool> passed;   // for each open bracket: an index or another call
    for (std::size_t i = at_ + 1; i < tokens_.size(); ++i) {
      const std::string& t = tokens_[i].text;
      const bool within = std::ranges::find(passed, true) != passed.end();
      if (t == "(" || t == "[") {
        passed.push_back(!passed.empty() &&
                         (t == "[" || (is_name(tokens_[i - 1].text) && !is_float_type(tokens_[i - 1].text))));
      } else if (t == ")" || t == "]") {
        passed.pop_back();
      } else if (!within) {
        const auto variable = variables_.find(t);
        is_float =
            is_float || is_float_literal(t) || (variable != variables_.end() && variable->second.is_float);
        const bool sum = (t == "+" || t == "-") && is_operand(tokens_[i - 1].text);
        if (operation == 0 && (t == "*" || t == "/" || sum)) operation = i;
      }
      if (!passed.empty() && (t != "," || passed.size() > 1)) continue;
      if (is_float && operation > 0) offend("inexact-argument", operation);
      if (passed.empty()) return;
      is_float = false, operation = 0;
    }
  }

  void check_zero() {
    if (!is_zero(text())) return;
    std::ptrdiff_t before = -1;
    std::ptrdiff_t after = 1;
    if (text(-1) == "(" && text(1) == ")" && is_float_type(text(-2))) before = -3, after = 2;
    const auto sum = [](const std::string& t) { return t == "+" || t == "-"; };
    const std::string& left = text(before - 1);
    const bool binary =
        is_name(left) ? left != "return" : left == ")" || left == "]" || std::isdigit(first(left));
    if (sum(text(after)) || text(before) == "+=" || text(before) == "-=" || (sum(text(before)) && binary))
      offend("adds-zero", at_);
  }

  static unsigned char first(const std::string& t) {
    return t.empty() ? static_cast<unsigned char>(0) : static_cast<unsigned char>(t.front());
  }

  /// An assignment whose target is a float that nobody declared precise.
  void check_store() {
    const bool compound = text() == "+=" || text() == "-=" || text() == "*=" || text() == "/=";
    if (text() != "=" && !compound) return;
    const Variable* target = nullptr;
    std::ptrdiff_t i = -1;
    for (int depth = 0; target == nullptr; --i) {
      const std::string& t = text(i);
      if (t.empty() || (depth == 0 && (t == ";" || t == "{" || t == "}" || t == "("))) return;
      if (t == "]") ++depth;
      if (t == "[") --depth;
      const auto found = variables_.find(t);
      // Swizzles and members of unknown structs are passed over, up to a name whose type is known.
      if (depth == 0 && found != variables_.end()) target = &found->second;
    }
    if (!target->is_float || target->precise) return;
    if (compound)
      offend("inexact-store", at_);
    else
      check_expression("inexact-store", at_ + 1);
  }

  /// Arithmetic from token i to the end of the statement, but for indices and the arguments of bit casts.
  void check_expression(const char* rule, std::size_t i) {
    const auto skip = [&](const char* open, const char* close) {
      for (int depth = 0; i < tokens_.size(); ++i) {
        if (tokens_[i].text == open) ++depth;
        if (tokens_[i].text == close && --depth == 0) return;
      }
    };
    for (; i < tokens_.size() && tokens_[i].text != ";"; ++i) {
      const std::string& t = tokens_[i].text;
      if (t == "[") {
        skip("[", "]");
      } else if ((t == "uintBitsToFloat" || t == "intBitsToFloat") && i + 1 < tokens_.size()) {
        skip("(", ")");
      } else if (t == "*" || t == "/" || t == "sqrt" ||
                 ((t == "+" || t == "-") && is_operand(tokens_[i - 1].text))) {
        offend(rule, i);
        return;
      }
    }
  }

  static bool is_operand(const std::string& t) {
    return t == ")" || t == "]" || std::isdigit(first(t)) || first(t) == '.' || (is_name(t) && t != "return");
  }

  std::string path_;
  std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::vector<Scope> scopes_;
  std::map<std::string, Variable> variables_;
  bool returns_float_ = false;
  std::vector<Offense> offenses_;
};

}  // namespace

bool opted_out(std::string_view text) {
  constexpr std::string_view mark = "// not-exact:";
  const std::string_view line = text.substr(0, text.find('\n'));
  return line.starts_with(mark) && line.find_first_not_of(" \t\r", mark.size()) != std::string_view::npos;
}

std::vector<Offense> lint(std::string_view path, std::string_view text) {
  return Linter(path, text).run();
}

}  // namespace aspic::testing

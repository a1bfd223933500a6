#include "gpu/portable_lint.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "gpu/glsl_tokens.h"

namespace aspic::testing {
namespace {

using Tokens = std::span<const Token>;
using Names = std::set<std::string, std::less<>>;

/// The text without comments. Line breaks that a backslash continues come later, so that line numbers stay.
std::string logical_lines(std::string_view text) {
  std::string bare;
  std::size_t owed = 0;  // line breaks
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::string_view two = text.substr(i, 2);
    if (two == "//") {
      i = std::min(text.find('\n', i), text.size()) - 1;
    } else if (two == "/*") {
      const std::size_t end = std::min(text.find("*/", i + 2), text.size());
      bare += ' ';
      bare.append(static_cast<std::size_t>(std::ranges::count(text.substr(i, end - i), '\n')), '\n');
      i = end + 1;
    } else if (two == "\\\n") {
      ++owed, ++i;
    } else {
      bare += text[i];
      if (text[i] == '\n') bare.append(std::exchange(owed, 0), '\n');
    }
  }
  return bare;
}

/// The place behind the bracket that closes the one at `open`.
std::size_t behind(Tokens tokens, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < tokens.size(); ++i) {
    const std::string& t = tokens[i].text;
    if (t == "(" || t == "[" || t == "{") ++depth;
    if ((t == ")" || t == "]" || t == "}") && --depth == 0) return i + 1;
  }
  return tokens.size();
}

/// What `separator`s outside brackets separate; of no tokens one empty part.
std::vector<Tokens> parts_of(Tokens tokens, std::string_view separator) {
  std::vector<Tokens> parts;
  std::size_t first = 0;
  for (std::size_t i = 0; i < tokens.size();) {
    const std::string& t = tokens[i].text;
    if (t == separator) {
      parts.push_back(tokens.subspan(first, i - first));
      first = i + 1;
    }
    i = t == "(" || t == "[" || t == "{" ? behind(tokens, i) : i + 1;
  }
  parts.push_back(tokens.subspan(first));
  return parts;
}

std::string joined(Tokens tokens) {
  std::string text;
  for (const Token& token : tokens) text += token.text;
  return text;
}

class Preprocessor {
 public:
  /// With every branch, a macro with several definitions has the one numbered `definition`, or its last.
  Preprocessor(Branches branches, std::size_t definition, std::vector<PortabilityOffense>& offenses)
      : branches_(branches), definition_(definition), offenses_(offenses) {}

  std::vector<Token> run(std::string_view text) {
    const std::string lines = logical_lines(text);
    int number = 1;
    for (std::size_t at = 0; at < lines.size(); ++number) {
      const std::size_t end = std::min(lines.find('\n', at), lines.size());
      const std::string_view line = std::string_view(lines).substr(at, end - at);
      at = end + 1;
      const std::size_t mark = line.find_first_not_of(" \t");
      if (mark != std::string_view::npos && line[mark] == '#') {
        flush();
        direct(tokens_of(line.substr(mark + 1), number), line);
      } else if (taken()) {
        std::ranges::move(tokens_of(line, number), std::back_inserter(pending_));
      }
    }
    flush();
    return std::move(out_);
  }

  /// The most definitions that a macro has.
  std::size_t most_definitions() const {
    std::size_t most = 1;
    for (const auto& [name, macros] : macros_) most = std::max(most, macros.size());
    return most;
  }

 private:
  struct Macro {
    bool takes_arguments = false;
    std::vector<std::string> parameters;
    std::vector<Token> body;
  };
  struct Condition {
    bool taken;     // this branch
    bool finished;  // one was taken, or none may be
  };

  bool taken() const { return std::ranges::all_of(conditions_, &Condition::taken); }
  void flush() {
    std::ranges::move(expanded(pending_, {}), std::back_inserter(out_));
    pending_.clear();
  }
  void offend(const Token& token, const char* rule) { offenses_.push_back({token.line, rule, token.text}); }

  void direct(Tokens line, std::string_view raw) {
    if (line.empty()) return;
    const std::string& word = line.front().text;
    const Tokens rest = line.subspan(1);
    if (word.starts_with("if")) {
      const bool seen = taken();
      const bool holds = seen && condition(word, rest);
      conditions_.push_back({holds, branches_ == Branches::taken && (holds || !seen)});
    } else if (word == "elif" || word == "else") {
      if (conditions_.empty()) return;
      Condition& last = conditions_.back();
      last.taken = !last.finished && (word == "else" || condition("if", rest));
      last.finished = branches_ == Branches::taken && (last.finished || last.taken);
    } else if (word == "endif") {
      if (!conditions_.empty()) conditions_.pop_back();
    } else if (!taken()) {
      return;
    } else if (word == "define" && !rest.empty()) {
      define(rest, raw);
    } else if (word == "undef" && !rest.empty() && branches_ == Branches::taken) {
      macros_.erase(rest.front().text);
    } else if (word == "extension" || word == "pragma" || word == "line") {
      // How NVIDIA's compiler unrolls loops: no effect on results, and others ignore it.
      if (!raw.ends_with("pragma optionNV(unroll none)")) offend(line.front(), "directive");
    }
  }

  void define(Tokens rest, std::string_view raw) {
    const std::string& name = rest.front().text;
    if (name.find("__") != std::string::npos) offend(rest.front(), "reserved-name");
    Macro macro;
    std::size_t body = 1;
    if (raw.find(name + "(") != std::string_view::npos && rest.size() > 1 && rest[1].text == "(") {
      macro.takes_arguments = true;
      body = behind(rest, 1);
      for (const Tokens parameter : parts_of(rest.subspan(2, body - 3), ","))
        macro.parameters.push_back(joined(parameter));
    }
    macro.body.assign(rest.begin() + static_cast<std::ptrdiff_t>(body), rest.end());
    std::vector<Macro>& all = macros_[name];
    if (branches_ == Branches::taken) all.clear();
    all.push_back(std::move(macro));
  }

  bool condition(const std::string& word, Tokens rest) {
    if (rest.empty()) return true;
    // What is for C++ is no branch of a shader.
    if (branches_ == Branches::every) return word != "ifdef" || !rest.front().text.starts_with("__");
    if (word != "if") return macros_.contains(rest.front().text) == (word == "ifdef");
    std::vector<Token> tokens;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (rest[i].text != "defined") {
        tokens.push_back(rest[i]);
        continue;
      }
      const std::size_t name = std::min(i + (rest[i + 1].text == "(" ? 2 : 1), rest.size() - 1);
      tokens.push_back({macros_.contains(rest[name].text) ? "1" : "0", rest[i].line});
      i = name == i + 2 ? name + 1 : name;
    }
    tokens = expanded(tokens, {});
    std::size_t at = 0;
    return value(tokens, at, 1) != 0;
  }

  static int rank(const std::string& t) {
    static const std::map<std::string, int> ranks = {
        {"||", 1}, {"&&", 2}, {"|", 3},  {"^", 4},  {"&", 5}, {"==", 6}, {"!=", 6}, {"<", 7},  {">", 7},
        {"<=", 7}, {">=", 7}, {"<<", 8}, {">>", 8}, {"+", 9}, {"-", 9},  {"*", 10}, {"/", 10}, {"%", 10}};
    const auto found = ranks.find(t);
    return found == ranks.end() ? 0 : found->second;
  }

  /// The value from token `at` on, of operators of this rank or a higher one.
  long value(Tokens t, std::size_t& at, int least) {
    if (at >= t.size()) return 0;
    const Token& first = t[at++];
    long left = 0;
    if (first.text == "(") {
      left = value(t, at, 1);
      ++at;
    } else if (first.text == "!" || first.text == "-" || first.text == "~") {
      const long operand = value(t, at, 11);
      left = first.text == "!" ? operand == 0 : first.text == "-" ? -operand : ~operand;
    } else if (is_name(first.text)) {
      offend(first, "undefined-macro");
    } else {
      left = std::strtol(first.text.c_str(), nullptr, 0);
    }
    while (at < t.size() && rank(t[at].text) >= least) {
      const std::string& o = t[at++].text;
      const long right = value(t, at, rank(o) + 1);
      left = o == "||"    ? left != 0 || right != 0
             : o == "&&"  ? left != 0 && right != 0
             : o == "|"   ? left | right
             : o == "^"   ? left ^ right
             : o == "&"   ? left & right
             : o == "=="  ? left == right
             : o == "!="  ? left != right
             : o == "<"   ? left < right
             : o == ">"   ? left > right
             : o == "<="  ? left <= right
             : o == ">="  ? left >= right
             : o == "<<"  ? left << right
             : o == ">>"  ? left >> right
             : o == "+"   ? left + right
             : o == "-"   ? left - right
             : o == "*"   ? left * right
             : right == 0 ? 0
             : o == "/"   ? left / right
                          : left % right;
    }
    return left;
  }

  std::vector<Token> expanded(Tokens tokens, const Names& hidden) const {
    std::vector<Token> result;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      const Token& token = tokens[i];
      const auto found = macros_.find(token.text);
      const bool called = i + 1 < tokens.size() && tokens[i + 1].text == "(";
      if (found == macros_.end() || found->second.empty() || hidden.contains(token.text)) {
        result.push_back(token);
        continue;
      }
      const Macro& macro = found->second[std::min(definition_, found->second.size() - 1)];
      if (macro.takes_arguments && !called) {
        result.push_back(token);
        continue;
      }
      std::map<std::string, std::vector<Token>> arguments;
      if (macro.takes_arguments) {
        const std::size_t end = behind(tokens, i + 1);
        const auto parts = parts_of(tokens.subspan(i + 2, end - i - 3), ",");
        for (std::size_t p = 0; p < std::min(parts.size(), macro.parameters.size()); ++p)
          arguments[macro.parameters[p]] = expanded(parts[p], hidden);
        i = end - 1;
      }
      std::vector<Token> body;
      for (const Token& part : macro.body) {
        const auto argument = arguments.find(part.text);
        if (argument == arguments.end())
          body.push_back({part.text, token.line});
        else
          body.insert(body.end(), argument->second.begin(), argument->second.end());
      }
      Names within = hidden;
      within.insert(token.text);
      std::ranges::move(expanded(body, within), std::back_inserter(result));
    }
    return result;
  }

  Branches branches_;
  std::size_t definition_;
  std::vector<PortabilityOffense>& offenses_;
  std::map<std::string, std::vector<Macro>> macros_;
  std::vector<Condition> conditions_;
  std::vector<Token> pending_, out_;
};

bool is_qualifier(std::string_view t) {
  static const Names words = {"const",   "in",        "out",      "inout",    "uniform",       "buffer",
                              "shared",  "coherent",  "volatile", "restrict", "readonly",      "writeonly",
                              "precise", "invariant", "flat",     "smooth",   "noperspective", "centroid"};
  return words.contains(t);
}

bool is_swizzle(std::string_view t) {
  return t.size() <= 4 && (t.find_first_not_of("xyzw") == std::string_view::npos ||
                           t.find_first_not_of("rgba") == std::string_view::npos);
}

bool is_assignment(std::string_view t) {
  static const Names words = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^="};
  return words.contains(t);
}

class PortableLinter {
 public:
  PortableLinter(Tokens tokens, Branches branches, std::vector<PortabilityOffense>& offenses)
      : tokens_(tokens), branches_(branches), offenses_(offenses) {}

  void run() {
    int depth = 0;
    for (const Token& token : tokens_) {
      if (is_name(token.text) && token.text.find("__") != std::string::npos) offend(token, "reserved-name");
      depth += (token.text == "{") - (token.text == "}");
    }
    if (depth != 0) offend(tokens_.back(), "unbalanced");
    // Declarations first, so that the order of alternatives does not matter.
    std::vector<Function> functions;
    for (std::size_t at = 0; at < tokens_.size();) {
      const std::size_t first = at;
      while (at < tokens_.size() && tokens_[at].text != ";" && tokens_[at].text != "{")
        at = tokens_[at].text == "(" ? behind(tokens_, at) : at + 1;
      const Tokens head = tokens_.subspan(first, at - first);
      const bool has_body = at < tokens_.size() && tokens_[at].text == "{";
      const std::size_t body = at;
      at = has_body ? behind(tokens_, at) : at + 1;
      const auto bracket = parameters_at(head);
      if (bracket < head.size()) {
        Function function = function_of(head, bracket);
        function.has_body = has_body;
        if (has_body) function.body = tokens_.subspan(body + 1, at - body - 2);
        functions.push_back(function);
        continue;
      }
      if (!has_body) {
        if (contains(head, "shared") && contains(head, "=")) offend(head.front(), "shared-initializer");
        continue;
      }
      const Tokens members = tokens_.subspan(body + 1, at - body - 2);
      std::size_t end = at;
      while (end < tokens_.size() && tokens_[end].text != ";") ++end;
      if (contains(head, "struct"))
        types_[head.back().text].merge(members_of(members));
      else
        add_block(head, members, tokens_.subspan(at, end - at));
      at = end + 1;
    }
    for (const Function& function : functions) {
      const std::string& name = function.name->text;
      std::vector<bool>& out = out_parameters_[name];
      out.resize(std::max(out.size(), function.parameters.size()), false);
      for (std::size_t p = 0; p < function.parameters.size(); ++p)
        if (contains(function.parameters[p], "out")) out[p] = true;
      if (function.has_body) defined_.insert(name);
    }
    for (const Function& function : functions) {
      if (function.has_body)
        check(function);
      else if (branches_ == Branches::taken && !defined_.contains(function.name->text))
        offend(*function.name, "undefined-function");
    }
  }

 private:
  struct Member {
    std::string type;
    std::size_t dimensions = 0;
  };
  using Members = std::map<std::string, Member>;
  struct Function {
    const Token* name;
    bool has_value;
    std::vector<Tokens> parameters;
    Tokens body = {};
    bool has_body = false;  // else a prototype
  };

  void offend(const Token& token, const char* rule) { offenses_.push_back({token.line, rule, token.text}); }
  static bool contains(Tokens tokens, std::string_view word) {
    return std::ranges::find(tokens, word, &Token::text) != tokens.end();
  }

  /// Where the parameters of a function begin in what stands before its body; the end: it is none.
  static std::size_t parameters_at(Tokens head) {
    for (std::size_t i = 2; i < head.size(); ++i) {
      if (head[i].text == "=") break;
      if (head[i].text == "(" && is_name(head[i - 1].text) && head[i - 1].text != "layout") return i;
    }
    return head.size();
  }
  static Function function_of(Tokens head, std::size_t bracket) {
    Function function{&head[bracket - 1], head[bracket - 2].text != "void", {}};
    const std::size_t end = behind(head, bracket);
    if (end > bracket + 2) function.parameters = parts_of(head.subspan(bracket + 1, end - bracket - 2), ",");
    return function;
  }

  bool is_type(const std::string& t) const {
    static const Names scalars = {"float", "double", "int", "uint", "bool"};
    const auto vector_of = [&](std::string_view word) {
      const std::size_t at = t.find(word);
      return at <= 1 && at != std::string::npos && t.size() > at + word.size() &&
             std::isdigit(static_cast<unsigned char>(t[at + word.size()]));
    };
    return scalars.contains(t) || vector_of("vec") || vector_of("mat") || types_.contains(t);
  }

  /// The members of a struct or block, or the variables of a declaration.
  static Members members_of(Tokens tokens) {
    Members members;
    for (Tokens line : parts_of(tokens, ";")) {
      while (!line.empty() && (is_qualifier(line.front().text) || line.front().text == "layout"))
        line = line.subspan(line.front().text == "layout" ? behind(line, 1) : 1);
      if (line.size() < 2) continue;
      Member member{line.front().text, 0};
      std::size_t at = 1;
      for (; at < line.size() && line[at].text == "["; at = behind(line, at)) ++member.dimensions;
      for (const Tokens name : parts_of(line.subspan(at), ",")) {
        if (name.empty()) continue;
        Member own = member;
        for (std::size_t i = 1; i < name.size() && name[i].text == "["; i = behind(name, i)) ++own.dimensions;
        members[name.front().text] = own;
      }
    }
    return members;
  }

  void add_block(Tokens head, Tokens members, Tokens instance) {
    const bool is_buffer = contains(head, "buffer");
    if (!is_buffer && !contains(head, "uniform")) return;  // of inputs and outputs
    if (!contains(head, is_buffer ? "std430" : "std140")) offend(head.back(), "block-layout");
    for (std::size_t i = 0; i + 3 < members.size(); ++i)
      if (members[i].text == "[" && members[i + 1].text == "]") offend(members[i - 1], "unsized-array");
    if (!is_buffer) return;
    if (instance.empty()) {
      buffers_.merge(members_of(members));
      return;
    }
    types_[head.back().text] = members_of(members);
    buffers_[instance.front().text] = {head.back().text, instance.size() > 1 ? 1u : 0u};
  }

  void check(const Function& function) {
    const Tokens body = function.body;
    Names locals;
    for (const Tokens parameter : function.parameters)
      for (const Token& token : parameter) locals.insert(token.text);
    if (function.has_value && !ends_with_return(body)) offend(*function.name, "missing-return");
    for (std::size_t i = 0; i < body.size(); ++i) {
      if (is_type(body[i].text) && i + 1 < body.size() && is_name(body[i + 1].text)) declare(body, i, locals);
      if (body[i].text == ".") check_target(body, i);
      const auto called = out_parameters_.find(body[i].text);
      if (called == out_parameters_.end() || i + 1 >= body.size() || body[i + 1].text != "(") continue;
      for (const Tokens argument : parts_of(body.subspan(i + 2, behind(body, i + 1) - i - 3), ","))
        check_argument(argument, locals);
    }
  }

  static bool ends_with_return(Tokens body) {
    if (body.empty()) return false;
    std::size_t last = body.size() - 1;
    while (last > 0 && body[last - 1].text != ";" && body[last - 1].text != "}" && body[last - 1].text != "{")
      --last;
    return body[last].text == "return";
  }

  /// The variables of the declaration whose type is at `type`.
  void declare(Tokens body, std::size_t type, Names& locals) {
    std::size_t end = type + 1;
    while (end < body.size() && body[end].text != ";" && body[end].text != ")")
      end = body[end].text == "(" || body[end].text == "[" || body[end].text == "{" ? behind(body, end)
                                                                                    : end + 1;
    for (const Tokens name : parts_of(body.subspan(type + 1, end - type - 1), ",")) {
      if (name.empty()) continue;
      locals.insert(name.front().text);
      const bool is_array = name.size() > 1 && name[1].text == "[";
      if (!is_array && !contains(name, "=") && reads_first(body.subspan(end), name.front().text))
        offend(name.front(), "uninitialized");
    }
  }

  /// Whether the variable is read where it first stands.
  bool reads_first(Tokens rest, const std::string& name) const {
    std::size_t at = 0;
    while (at < rest.size() && !(rest[at].text == name && (at == 0 || rest[at - 1].text != "."))) ++at;
    if (at == rest.size()) return false;
    std::size_t after = at + 1;
    while (after + 1 < rest.size() && (rest[after].text == "[" || rest[after].text == "."))
      after = rest[after].text == "[" ? behind(rest, after) : after + 2;
    if (after < rest.size() && rest[after].text == "=") return false;
    // An argument that the function sets?
    std::size_t argument = 0;
    int depth = 0;
    for (std::size_t i = at; i-- > 0 && rest[i].text != ";";) {
      const std::string& t = rest[i].text;
      if (t == ")" || t == "]") ++depth;
      if (t == "," && depth == 0) ++argument;
      if ((t == "(" || t == "[") && --depth < 0) {
        const auto function = i > 0 ? out_parameters_.find(rest[i - 1].text) : out_parameters_.end();
        return function == out_parameters_.end() || argument >= function->second.size() ||
               !function->second[argument];
      }
    }
    return true;
  }

  void check_target(Tokens body, std::size_t dot) {
    if (dot + 2 >= body.size() || !is_swizzle(body[dot + 1].text) || body[dot + 1].text.size() < 2) return;
    std::size_t after = dot + 2;
    while (after + 1 < body.size() && (body[after].text == "[" || body[after].text == "."))
      after = body[after].text == "[" ? behind(body, after) : after + 2;
    if (after > dot + 2 && after < body.size() && is_assignment(body[after].text))
      offend(body[dot + 1], "complex-target");
  }

  void check_argument(Tokens argument, const Names& locals) {
    while (argument.size() > 2 && argument.front().text == "(" && behind(argument, 0) == argument.size())
      argument = argument.subspan(1, argument.size() - 2);
    if (const auto choices = parts_of(argument, "?"); choices.size() > 1) {
      for (const Tokens side : parts_of(argument.subspan(choices[0].size() + 1), ":"))
        check_argument(side, locals);
      return;
    }
    if (argument.empty() || locals.contains(argument.front().text)) return;
    const auto root = buffers_.find(argument.front().text);
    if (root == buffers_.end()) return;
    Member at = root->second;
    for (std::size_t i = 1; i < argument.size();) {
      if (argument[i].text == "[") {
        if (at.dimensions > 0) --at.dimensions;
        i = behind(argument, i);
      } else if (argument[i].text == "." && i + 1 < argument.size()) {
        const auto type = types_.find(at.type);
        if (at.dimensions > 0 || type == types_.end()) return;  // a swizzle or a length
        const auto member = type->second.find(argument[i + 1].text);
        if (member == type->second.end()) return;
        at = member->second;
        i += 2;
      } else {
        return;  // arithmetic
      }
    }
    offenses_.push_back({argument.front().line, "block-argument", joined(argument)});
  }

  Tokens tokens_;
  Branches branches_;
  std::vector<PortabilityOffense>& offenses_;
  std::map<std::string, Members> types_;
  Members buffers_;  // members of blocks without, and instances of blocks with a name
  std::map<std::string, std::vector<bool>> out_parameters_;  // of our functions
  Names defined_;
};

}  // namespace

std::vector<PortabilityOffense> lint_portability(std::string_view text, Branches branches) {
  std::vector<PortabilityOffense> offenses;
  std::size_t definitions = 1;
  for (std::size_t definition = 0; definition < definitions; ++definition) {
    Preprocessor preprocessor(branches, definition, offenses);
    const std::vector<Token> tokens = preprocessor.run(text);
    definitions = preprocessor.most_definitions();
    PortableLinter(tokens, branches, offenses).run();
  }
  const auto key = [](const PortabilityOffense& o) { return std::tie(o.line, o.rule, o.text); };
  std::ranges::sort(offenses, {}, key);
  // std::ranges::unique() returns a subrange that clang 14 rejects.
  offenses.erase(std::unique(offenses.begin(), offenses.end()), offenses.end());
  return offenses;
}

}  // namespace aspic::testing

#include <fmt/format.h>

#include "scene/document.h"

namespace aspic::document {
namespace {

class Scanner {
 public:
  Scanner(std::string_view text, std::uint32_t source) : text_(text) { here_.source = source; }

  std::optional<Problem> scan() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        pass_string(c);
        continue;
      }
      if (c == '#') {
        while (at_ < text_.size() && !ends_line(text_[at_])) advance();
        continue;
      }
      if (const auto problem = count(c)) return problem;
      advance();
    }
    return std::nullopt;
  }

 private:
  void advance() {
    const auto byte = static_cast<unsigned char>(text_[at_++]);
    if (byte == '\n') {
      ++here_.line;
      here_.column = 1;
    } else if (at_ == text_.size() || (static_cast<unsigned char>(text_[at_]) & 0xc0u) != 0x80u) {
      ++here_.column;  // in characters: the next byte begins one
    }
  }
  void advance(std::size_t bytes) {
    for (; bytes > 0 && at_ < text_.size(); --bytes) advance();
  }
  /// Any character that some parser might take for the end of a line: nothing hides behind one.
  static bool ends_line(char c) { return c == '\n' || c == '\r' || c == '\v' || c == '\f'; }
  bool follows(std::string_view word) const { return text_.substr(at_).starts_with(word); }

  void pass_string(char quote) {
    const std::string three(3, quote);
    const bool long_one = follows(three);
    advance(long_one ? 3 : 1);
    while (at_ < text_.size()) {
      if (quote == '"' && text_[at_] == '\\') {
        advance(2);
      } else if (long_one && follows(three)) {
        // Up to two more quotation marks belong to the string.
        advance(3);
        for (int n = 0; n < 2 && at_ < text_.size() && text_[at_] == quote; ++n) advance();
        return;
      } else if (!long_one && (text_[at_] == quote || ends_line(text_[at_]))) {
        advance();
        return;
      } else {
        advance();
      }
    }
  }

  /// Brackets of table headers count as arrays do: they hold no values.
  std::optional<Problem> count(char c) {
    if (c == '.') {
      if (++dots_ == deepest_nesting)
        return Problem{
            here_, fmt::format("a key has more than {} parts here: no scene is that deep", deepest_nesting)};
      return std::nullopt;
    }
    if (c == '[' || c == '{') {
      if (++depth_ > deepest_nesting)
        return Problem{
            here_,
            fmt::format("more than {} arrays and tables are inside each other here: no scene is that deep",
                        deepest_nesting)};
    }
    if ((c == ']' || c == '}') && depth_ > 0) --depth_;
    if (c == '[' || c == ']' || c == '{' || c == '}' || c == ',' || c == '=' || c == '\n') dots_ = 0;
    return std::nullopt;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  Position here_;
  int dots_ = 0, depth_ = 0;
};

}  // namespace

std::optional<Problem> too_deep(std::string_view text, std::uint32_t source) {
  return Scanner(text, source).scan();
}

}  // namespace aspic::document

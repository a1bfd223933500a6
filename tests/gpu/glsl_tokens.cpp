#include "gpu/glsl_tokens.h"

#include <algorithm>
#include <cctype>

namespace aspic::testing {

bool is_name(std::string_view t) {
  return !t.empty() && (std::isalpha(static_cast<unsigned char>(t.front())) || t.front() == '_');
}

std::vector<Token> tokens_of(std::string_view text, int line) {
  std::vector<Token> tokens;
  bool fresh_line = true;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '\n') {
      ++line, ++i, fresh_line = true;
    } else if (std::isspace(static_cast<unsigned char>(c))) {
      ++i;
    } else if (text.substr(i, 2) == "//") {
      i = std::min(text.find('\n', i), text.size());
    } else if (text.substr(i, 2) == "/*") {
      const std::size_t end = std::min(text.find("*/", i + 2), text.size() - 2) + 2;
      line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                                          text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      i = end;
    } else if (c == '#' && fresh_line) {
      const std::size_t end = std::min(text.find('\n', i), text.size());
      const std::size_t define = text.substr(i, end - i).find("define ");
      i = define == std::string_view::npos ? end : i + define + 7;
    } else {
      fresh_line = false;
      std::size_t end = i + 1;
      const auto word = [](char x) { return std::isalnum(static_cast<unsigned char>(x)) || x == '_'; };
      if (word(c) || (c == '.' && end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])))) {
        const bool number = !is_name(text.substr(i, 1));
        while (end < text.size() && (word(text[end]) || (number && text[end] == '.') ||
                                     (number && (text[end] == '+' || text[end] == '-') &&
                                      (text[end - 1] == 'e' || text[end - 1] == 'E'))))
          ++end;
      } else if (end < text.size() && std::string_view("=+-<>&|").find(text[end]) != std::string_view::npos &&
                 (text[end] == '=' || text[end] == c)) {
        ++end;
      }
      tokens.push_back({std::string(text.substr(i, end - i)), line});
      i = end;
    }
  }
  return tokens;
}

}  // namespace aspic::testing

#pragma once
// GLSL as tokens, for the lints of shaders.
#include <string>
#include <string_view>
#include <vector>

namespace aspic::testing {

struct Token {
  std::string text;
  int line = 0;  ///< from 1
};

/// Whether the token begins as an identifier or keyword does.
bool is_name(std::string_view token);

/// Names, numbers and operators; comments gone, and of preprocessor lines only what a #define puts in place.
/// `line` is the number of the first line.
std::vector<Token> tokens_of(std::string_view text, int line = 1);

}  // namespace aspic::testing

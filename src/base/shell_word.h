#pragma once
#include <string>

namespace aspic {

/// A word of a command line as a POSIX shell takes it for one word, in quotation marks where it needs them.
std::string shell_word(const std::string& word);

}  // namespace aspic

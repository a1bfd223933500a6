#pragma once
// Files of inputs (docs/files.md).
#include <string_view>

namespace aspic {

/// Whether a text is a log of inputs, right or wrong, rather than a scene: TOML with no keys but a log's.
bool is_input_log(std::string_view text);

}  // namespace aspic

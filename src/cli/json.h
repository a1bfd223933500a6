#pragma once
// Summaries as JSON.
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace aspic::cli {

/// Members keep the order in which they were added. Infinite numbers, which JSON lacks, are written as null.
using Json = nlohmann::ordered_json;

/// null for nothing.
template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}
inline Json or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
}

/// Indented by two spaces, with a line end, in ASCII: other characters are escaped, so that none acts on a
/// terminal. Text that is not UTF-8 (a file name) has its bad bytes replaced.
inline std::string to_text(const Json& json) {
  return json.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace aspic::cli

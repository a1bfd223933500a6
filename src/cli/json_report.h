#pragma once
// Summaries as JSON: a small ordered tree, so that the JSON library stays in one translation unit.
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace aspic::cli {

class JsonValue;
/// Members keep the order in which they were added.
using JsonObject = std::vector<std::pair<std::string, JsonValue>>;
using JsonArray = std::vector<JsonValue>;

/// null, a boolean, a number, a text, an array or an object. Infinite numbers, which JSON lacks, become null.
class JsonValue {
 public:
  using Content =
      std::variant<std::nullptr_t, bool, std::uint64_t, double, std::string, JsonArray, JsonObject>;

  JsonValue(std::nullptr_t = nullptr) : content_(nullptr) {}
  JsonValue(bool value) : content_(value) {}
  JsonValue(std::uint64_t value) : content_(value) {}
  JsonValue(std::uint32_t value) : content_(std::uint64_t{value}) {}
  JsonValue(double value) : content_(value) {}
  JsonValue(const char* value) : content_(std::string(value)) {}
  JsonValue(std::string_view value) : content_(std::string(value)) {}
  JsonValue(std::string value) : content_(std::move(value)) {}
  JsonValue(JsonArray value) : content_(std::move(value)) {}
  JsonValue(JsonObject value) : content_(std::move(value)) {}

  const Content& content() const { return content_; }

 private:
  Content content_;
};

/// Indented by two spaces, with a line end, in ASCII: other characters are escaped, so that none acts on a
/// terminal. Text that is not UTF-8 (a file name) has its bad bytes replaced.
std::string to_json(const JsonObject& object);

}  // namespace aspic::cli

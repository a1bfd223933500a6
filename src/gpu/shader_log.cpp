// Compile logs, brought back to our files and lines.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <regex>

#include "base/lines.h"
#include "gpu/shader_source.h"

namespace aspic::gl {
namespace {

/// One message of a driver's log.
struct Message {
  int line = 0;
  int column = 0;  // 0: unknown
  std::string text;
};

/// Mesa "0:12(5): error: …", NVIDIA "0(12) : error C1008: …", AMD and Intel "ERROR: 0:12: …".
std::optional<Message> parse(std::string_view line) {
  // Counts are bounded: the library's matcher descends once for each character.
  static const std::regex shape(
      R"((ERROR: |WARNING: )?\d{1,9}(?::(\d{1,9})(?:\((\d{1,9})\))?|\((\d{1,9})\))[ \t]{0,9}:[ \t]{0,9})");
  std::cmatch found;
  const char* const end = line.data() + line.size();
  if (!std::regex_search(line.data(), end, found, shape, std::regex_constants::match_continuous))
    return std::nullopt;
  const std::string_view prefix = !found[1].matched ? "" : found[1] == "ERROR: " ? "error: " : "warning: ";
  return Message{std::stoi(found[2].matched ? found[2] : found[4]),
                 found[3].matched ? std::stoi(found[3]) : 0,
                 fmt::format("{}{}", prefix, found.suffix().str())};
}

}  // namespace

FlatShader::Origin FlatShader::origin(int line) const {
  if (line < 1 || static_cast<std::size_t>(line) > lines_.size()) return {"defines", 0};
  const Mapped& mapped = lines_[static_cast<std::size_t>(line) - 1];
  if (mapped.file < 0) return {"defines", mapped.line};
  return {files_[static_cast<std::size_t>(mapped.file)], mapped.line};
}

std::string FlatShader::rewrite_log(std::string_view log) const {
  std::string result;
  while (!log.empty()) {
    std::string_view line = take_line(log);
    if (line.ends_with('\0')) line.remove_suffix(1);
    if (line.empty()) continue;
    const auto message = parse(line);
    const Origin from = message ? origin(message->line) : Origin{};
    if (!message || from.line == 0) {
      result += fmt::format("{}\n", line);
      continue;
    }
    const std::string_view source = line_of(text_, static_cast<std::size_t>(message->line));
    result += fmt::format("{}:{}: {}\n  {}\n", from.file, from.line, message->text, source);
    if (message->column < 1 || static_cast<std::size_t>(message->column) > source.size() + 1) continue;
    std::string indent(source.substr(0, static_cast<std::size_t>(message->column) - 1));
    std::ranges::replace_if(
        indent, [](char c) { return c != '\t'; }, ' ');
    result += fmt::format("  {}^\n", indent);
  }
  return result;
}

}  // namespace aspic::gl

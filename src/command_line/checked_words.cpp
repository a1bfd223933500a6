#include "command_line/checked_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "base/printable.h"

namespace aspic {

std::string check_whole(std::string& text, const WholeRange& range) {
  const std::string shown = excerpt(text, 40),
                    wanted = range.most < 10'000'000 ? fmt::format("from {} to {}", range.least, range.most)
                                                     : fmt::format("of {} or more", range.least);
  const auto digits = [](std::string_view t) {
    return !t.empty() && std::ranges::all_of(t, [](char c) { return c >= '0' && c <= '9'; });
  };
  if (text.starts_with('-') && digits(std::string_view(text).substr(1)))
    return fmt::format("{} is negative; give a whole number {}", shown, wanted);
  if (!digits(text)) return fmt::format("\"{}\" is not a whole number", shown);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || value > range.most)
    return fmt::format("{} is too large; the largest is {}", shown, range.most);
  if (value < range.least) return fmt::format("{} is too small; give a whole number {}", shown, wanted);
  text = fmt::format("{}", value);
  return "";
}

std::string check_name(const std::string& text) {
  return text.empty() ? "the name is empty" : "";
}

std::string check_number(const std::string& text) {
  const std::string shown = excerpt(text, 40);
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  double value = 0.0;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range)
    return fmt::format("{} is out of range: the largest number is 1.8e308", shown);
  if (error != std::errc() || end != text.data() + text.size())
    return fmt::format("\"{}\" is not a number", shown);
  return "";
}

}  // namespace aspic

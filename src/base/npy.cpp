#include "base/npy.h"

#include <bit>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

namespace aspic {
namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t most_elements = std::size_t{1} << 31, most_axes = 8, longest_header = 1 << 16;

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t b = bytes.size(); b-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[b]);
  return value;
}

Error refusal(std::string_view why) {
  return fail(ErrorCode::scene_rejected, "this .npy file cannot be read: {}", why);
}

/// What follows a key of the header's dictionary, without spaces.
std::optional<std::string_view> entry(std::string_view header, std::string_view key) {
  for (const char quote : {'\'', '"'}) {
    const std::string quoted = quote + std::string(key) + quote;
    std::size_t at = header.find(quoted);
    if (at == std::string_view::npos) continue;
    at = header.find_first_not_of(' ', at + quoted.size());
    if (at == std::string_view::npos || header[at] != ':') return std::nullopt;
    at = header.find_first_not_of(' ', at + 1);
    return at == std::string_view::npos ? std::nullopt : std::optional(header.substr(at));
  }
  return std::nullopt;
}

/// The numbers of a tuple: "(2, 3)", "(2,)", "()".
std::optional<std::vector<std::size_t>> tuple_of(std::string_view text) {
  if (!text.starts_with('(')) return std::nullopt;
  text.remove_prefix(1);
  std::vector<std::size_t> numbers;
  for (;;) {
    while (text.starts_with(' ') || text.starts_with(',')) text.remove_prefix(1);
    if (text.starts_with(')')) return numbers;
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || numbers.size() == most_axes) return std::nullopt;
    numbers.push_back(number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
}

}  // namespace

Result<NpyArray> NpyArray::read(std::string content) {
  const std::string_view all = content;
  if (!all.starts_with(magic) || all.size() < 10)
    return refusal("its first bytes are not those of a .npy file");
  const auto version = static_cast<unsigned char>(all[6]);
  if (version < 1 || version > 3) return refusal("its version is unknown");
  const std::size_t width = version == 1 ? 2 : 4;
  if (all.size() < 8 + width) return refusal("it is truncated");
  const std::size_t length = little_endian(all.substr(8, width));
  if (length > longest_header || all.size() < 8 + width + length) return refusal("it is truncated");
  const std::string_view header = all.substr(8 + width, length);
  NpyArray array;
  array.data_ = 8 + width + length;

  const auto type = entry(header, "descr"), order = entry(header, "fortran_order"),
             shape = entry(header, "shape");
  if (!type || !order || !shape) return refusal("its header lacks a key");
  // 'descr' of numbers: byte order, kind, bytes, in quotation marks.
  if (type->size() < 5 || (type->front() != '\'' && type->front() != '"') || (*type)[4] != type->front())
    return refusal("its elements are not numbers");
  array.big_endian_ = (*type)[1] == '>';
  array.kind_ = (*type)[2];
  array.item_ = static_cast<std::size_t>((*type)[3] - '0');
  const bool order_known = std::string_view("<>|=").find((*type)[1]) != std::string_view::npos;
  const bool whole = (array.kind_ == 'u' || array.kind_ == 'i') &&
                     (array.item_ == 1 || array.item_ == 2 || array.item_ == 4 || array.item_ == 8);
  const bool truth = array.kind_ == 'b' && array.item_ == 1;
  const bool real = array.kind_ == 'f' && (array.item_ == 4 || array.item_ == 8);
  if (!order_known || !(whole || truth || real))
    return refusal("its elements are neither integers nor floats of 4 or 8 bytes");
  array.fortran_ = order->starts_with("True");
  if (!array.fortran_ && !order->starts_with("False")) return refusal("its order is unknown");
  const auto numbers = tuple_of(*shape);
  if (!numbers) return refusal("its shape is unknown");
  array.shape_ = *numbers;
  array.size_ = 1;
  for (const std::size_t along : array.shape_) {
    if (along > most_elements || array.size_ * along > most_elements)
      return refusal("it has too many elements");
    array.size_ *= along;
  }
  if (all.size() - array.data_ != array.size_ * array.item_)
    return refusal("its size does not match its shape");
  array.content_ = std::move(content);
  return array;
}

std::size_t NpyArray::stored(std::size_t i) const {
  if (!fortran_) return i;
  std::size_t place = 0, stride = size_;
  // From the last axis on, which runs slowest in the file.
  for (std::size_t axis = shape_.size(); axis-- > 0;) {
    stride /= shape_[axis];
    place += i % shape_[axis] * stride;
    i /= shape_[axis];
  }
  return place;
}

std::uint64_t NpyArray::bits(std::size_t i) const {
  const std::size_t first = data_ + stored(i) * item_;
  std::uint64_t value = 0;
  for (std::size_t b = 0; b < item_; ++b) {
    const std::size_t at = big_endian_ ? first + b : first + item_ - 1 - b;
    value = value << 8 | static_cast<unsigned char>(content_[at]);
  }
  return value;
}

std::int64_t NpyArray::whole(std::size_t i) const {
  const std::uint64_t value = bits(i);
  if (kind_ != 'i') {
    constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
    return static_cast<std::int64_t>(value < most ? value : most);
  }
  const unsigned unused = 64 - 8 * static_cast<unsigned>(item_);
  return static_cast<std::int64_t>(value << unused) >> unused;
}

double NpyArray::number(std::size_t i) const {
  if (whole_numbers()) return static_cast<double>(whole(i));
  const std::uint64_t value = bits(i);
  return item_ == 8 ? std::bit_cast<double>(value)
                    : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(value)));
}

}  // namespace aspic

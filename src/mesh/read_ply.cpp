// PLY (Turk, Stanford, 1994): a header in text that lists elements and their properties, then their values.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "base/lines.h"
#include "mesh/mesh_text.h"

namespace aspic {
namespace {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct ScalarName {
  std::string_view old_name, name;
  std::size_t bytes;
};
constexpr std::array<ScalarName, 8> scalar_names = {{{"char", "int8", 1},
                                                     {"uchar", "uint8", 1},
                                                     {"short", "int16", 2},
                                                     {"ushort", "uint16", 2},
                                                     {"int", "int32", 4},
                                                     {"uint", "uint32", 4},
                                                     {"float", "float32", 4},
                                                     {"double", "float64", 8}}};

std::size_t bytes_of(Scalar type) {
  return scalar_names[static_cast<std::size_t>(type)].bytes;
}
bool is_whole(Scalar type) {
  return type < Scalar::float32;
}
std::optional<Scalar> scalar_of(std::string_view word) {
  for (std::size_t i = 0; i < scalar_names.size(); ++i)
    if (word == scalar_names[i].old_name || word == scalar_names[i].name) return static_cast<Scalar>(i);
  return std::nullopt;
}

struct Property {
  std::string_view name;
  Scalar type = Scalar::float32;
  std::optional<Scalar> count = {};  ///< of a list: the type of its length
};

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { ascii, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::string_view body;
  std::size_t lines = 0;  ///< of the header
};

/// Elements and properties that a header may list: a file that lists more is no mesh.
constexpr std::size_t most_elements = 64, most_properties = 256;

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& file_name) : rest_(bytes), file_name_(file_name) {
    skip_byte_order_mark(rest_);
    const std::size_t end = rest_.find_first_of("\r\n");
    if (end != std::string_view::npos && !rest_.substr(end).starts_with("\r\n")) line_end_ = rest_[end];
  }

  Result<Header> read() {
    ++header_.lines;
    if (trimmed(next_line()) != "ply")
      return error("the first line is not 'ply': the file is not a PLY file, or is damaged");
    bool formatted = false;
    while (!rest_.empty()) {
      ++header_.lines;
      MeshWords words(next_line());
      const std::string_view key = words.next();
      if (key == "end_header") {
        if (!formatted)
          return error("the header names no format; it needs a line such as 'format ascii 1.0'");
        header_.body = rest_;
        return std::move(header_);
      }
      if (key == "format") {
        ASPIC_CHECK(take_format(words.next()));
        formatted = true;
      } else if (key == "element") {
        ASPIC_CHECK(take_element(words));
      } else if (key == "property") {
        ASPIC_CHECK(take_property(words));
      } else if (!key.empty() && key != "comment" && key != "obj_info") {
        return error(
            fmt::format("{} is not a word of a PLY header (format, element, property, comment, end_header); "
                        "export the file again",
                        quoted_word(key)));
      }
    }
    return error("the header has no end, 'end_header'. The file is truncated: copy or export it again");
  }

 private:
  /// A binary body may begin with a byte that is another line end.
  std::string_view next_line() {
    const std::size_t end = std::min(rest_.find(line_end_), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return line;
  }

  Status take_format(std::string_view word) {
    if (word == "ascii")
      header_.encoding = Encoding::ascii;
    else if (word == "binary_little_endian")
      header_.encoding = Encoding::little_endian;
    else if (word == "binary_big_endian")
      header_.encoding = Encoding::big_endian;
    else
      return error(fmt::format("{} is not a format of PLY: ascii, binary_little_endian, binary_big_endian",
                               quoted_word(word)));
    return {};
  }

  Status take_element(MeshWords& words) {
    Element element;
    element.name = words.next();
    const std::string_view count = words.next();
    const auto number = mesh_integer(count);
    if (!number || *number < 0)
      return error(
          fmt::format("{} is not a number of elements; a line is 'element vertex 8'", quoted_word(count)));
    if (header_.elements.size() == most_elements)
      return error(fmt::format("there are more than {} elements; a mesh has vertex and face", most_elements));
    element.count = static_cast<std::uint64_t>(*number);
    header_.elements.push_back(std::move(element));
    return {};
  }

  Status take_property(MeshWords& words) {
    if (header_.elements.empty()) return error("a property comes after the line of its element");
    Property property;
    std::string_view type = words.next();
    if (type == "list") {
      const std::string_view count = words.next();
      property.count = scalar_of(count);
      if (!property.count || !is_whole(*property.count))
        return error(fmt::format("{} is not a type of a list's length; use an integer type such as uchar",
                                 quoted_word(count)));
      type = words.next();
    }
    const auto scalar = scalar_of(type);
    if (!scalar)
      return error(fmt::format(
          "{} is not a type of PLY; those are char, uchar, short, ushort, int, uint, float, double",
          quoted_word(type)));
    property.type = *scalar;
    property.name = words.next();
    if (property.name.empty()) return error("this property has no name");
    auto& properties = header_.elements.back().properties;
    if (properties.size() == most_properties)
      return error(fmt::format("there are more than {} properties of one element", most_properties));
    properties.push_back(property);
    return {};
  }

  Error error(const std::string& what) const { return mesh_error_in_line(file_name_, header_.lines, what); }

  std::string_view rest_;
  char line_end_ = '\n';  // the last character of one
  const std::string& file_name_;
  Header header_;
};

/// Values one after the other from the body of a text file.
class AsciiValues {
 public:
  static constexpr bool counts_lines = true;
  AsciiValues(const Header& header, std::string_view, const std::string& file_name)
      : words_(header.body, header.lines + 1), file_name_(file_name) {}

  Result<double> next(Scalar type) {
    const std::string_view word = words_.next();
    if (word.empty())
      return error(place(), "the file ends before its last element. It is truncated: export it again");
    const auto number = mesh_number(word);
    if (!number) return error(place(), fmt::format("{} is not a number", quoted_word(word)));
    if (is_whole(type) && *number != std::floor(*number))
      return error(place(), fmt::format("{} is not an integer", quoted_word(word)));
    return *number;
  }
  /// Whether so many values may be left: what a file promises is not believed.
  bool has(std::uint64_t, Scalar) const { return true; }
  std::size_t place() const { return words_.line(); }
  Error error(std::size_t line, const std::string& what) const {
    return mesh_error_in_line(file_name_, line, what);
  }

 private:
  MeshWords words_;
  const std::string& file_name_;
};

/// The same of a binary file.
class BinaryValues {
 public:
  static constexpr bool counts_lines = false;
  BinaryValues(const Header& header, std::string_view bytes, const std::string& file_name)
      : bytes_(bytes),
        at_(bytes.size() - header.body.size()),
        swapped_((header.encoding == Encoding::big_endian) != (std::endian::native == std::endian::big)),
        file_name_(file_name) {}

  Result<double> next(Scalar type) {
    if (!has(1, type))
      return error(at_, "the file ends before its last element. It is truncated: export it again");
    switch (type) {
      case Scalar::int8:
        return take<std::int8_t>();
      case Scalar::uint8:
        return take<std::uint8_t>();
      case Scalar::int16:
        return take<std::int16_t>();
      case Scalar::uint16:
        return take<std::uint16_t>();
      case Scalar::int32:
        return take<std::int32_t>();
      case Scalar::uint32:
        return take<std::uint32_t>();
      case Scalar::float32:
        return take<float>();
      case Scalar::float64:
        break;
    }
    return take<double>();
  }
  bool has(std::uint64_t values, Scalar type) const {
    return values <= (bytes_.size() - at_) / bytes_of(type);
  }
  std::size_t place() const { return at_; }
  Error error(std::size_t byte, const std::string& what) const {
    return mesh_error_at_byte(file_name_, byte, what);
  }

 private:
  template <class T>
  double take() {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    if (swapped_) std::ranges::reverse(raw);
    at_ += sizeof(T);
    return static_cast<double>(std::bit_cast<T>(raw));
  }

  std::string_view bytes_;
  std::size_t at_;
  bool swapped_;
  const std::string& file_name_;
};

template <class Values>
class BodyReader {
 public:
  BodyReader(const Header& header, std::string_view bytes, const std::string& file_name)
      : header_(header), values_(header, bytes, file_name) {}

  Result<MeshFile> read() {
    for (const Element& element : header_.elements) {
      if (element.properties.empty()) continue;  // it has no bytes, whatever its number
      const bool vertices = element.name == "vertex", faces = element.name == "face";
      if (element.name == "tristrips")
        return error("the triangles are strips, which Aspic does not read; export faces");
      if (vertices && !is_vertex(element))
        return error("a vertex has the properties x, y and z, each one number; export the file again");
      for (std::uint64_t i = 0; i < element.count; ++i) {
        const std::size_t place = values_.place();
        Vec3 position;
        ASPIC_CHECK(take(element, position));
        if (vertices) mesh_.add_vertex(position);
        if (faces && !mesh_.add_polygon(corners_, Values::counts_lines ? values_.place() : place))
          return error(too_many_triangles());
      }
    }
    return std::move(mesh_).finish(values_.place(), [&](std::size_t place, const std::string& what) {
      return values_.error(place, what);
    });
  }

 private:
  static bool is_vertex(const Element& element) {
    return std::ranges::all_of(std::array{"x", "y", "z"}, [&](std::string_view name) {
      return std::ranges::any_of(element.properties,
                                 [&](const Property& p) { return p.name == name && !p.count; });
    });
  }

  /// One element: what of it is a position, and the corners of a face.
  Status take(const Element& element, Vec3& position) {
    corners_.clear();
    for (const Property& property : element.properties) {
      if (property.count) {
        ASPIC_CHECK(take_list(element, property));
        continue;
      }
      ASPIC_TRY(const double value, values_.next(property.type));
      if (property.name == "x") position.x = value;
      if (property.name == "y") position.y = value;
      if (property.name == "z") position.z = value;
    }
    return {};
  }

  Status take_list(const Element& element, const Property& property) {
    const std::size_t place = values_.place();
    ASPIC_TRY(const double length, values_.next(*property.count));
    if (!(length >= 0.0 && length < 1e9) || !values_.has(static_cast<std::uint64_t>(length), property.type))
      return values_.error(
          place,
          fmt::format("a list of {} numbers does not fit into the file; it is damaged: export it again",
                      length));
    const bool corners =
        element.name == "face" && (property.name == "vertex_indices" || property.name == "vertex_index");
    for (auto left = static_cast<std::uint64_t>(length); left > 0; --left) {
      ASPIC_TRY(const double value, values_.next(property.type));
      if (!corners) continue;
      if (!(value >= 0.0 && value < 4294967295.0 && value == std::floor(value)))
        return error(fmt::format("{} names no vertex: they are counted from 0", value));
      corners_.push_back(static_cast<std::uint32_t>(value));
    }
    return {};
  }

  Error error(const std::string& what) const { return values_.error(values_.place(), what); }

  const Header& header_;
  Values values_;
  MeshBuilder mesh_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Result<MeshFile> parse_ply(std::string_view bytes, const std::string& file_name) {
  ASPIC_TRY(const Header header, HeaderReader(bytes, file_name).read());
  if (header.encoding == Encoding::ascii) return BodyReader<AsciiValues>(header, bytes, file_name).read();
  return BodyReader<BinaryValues>(header, bytes, file_name).read();
}

}  // namespace aspic

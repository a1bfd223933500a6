#include "model/skin_text.h"

#include <cmath>

namespace aspic {
namespace {

constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";
constexpr double steps = skin_steps;

/// Five bits a digit, and one that says that more follow.
void append(std::string& text, std::int64_t number) {
  auto left = (static_cast<std::uint64_t>(number < 0 ? -number : number) << 1) | (number < 0 ? 1u : 0u);
  do {
    const std::uint64_t low = left & 31u;
    left >>= 5;
    text += digits[low | (left != 0 ? 32u : 0u)];
  } while (left != 0);
}

int digit_of(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '-' ? 62 : c == '_' ? 63 : -1;
}

class Numbers {
 public:
  explicit Numbers(std::string_view text) : rest_(text) {}

  /// Nothing at the end, or where there is no number.
  std::optional<std::int64_t> next() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 35; shift += 5) {
      skip_blanks();
      const int digit = rest_.empty() ? -1 : digit_of(rest_.front());
      if (digit < 0) return std::nullopt;
      rest_.remove_prefix(1);
      value |= static_cast<std::uint64_t>(digit & 31) << shift;
      if ((digit & 32) != 0) continue;
      const auto size = static_cast<std::int64_t>(value >> 1);
      if (size > 0x7fffffff) return std::nullopt;
      return (value & 1u) != 0 ? -size : size;
    }
    return std::nullopt;
  }
  /// Whether so many numbers may follow.
  bool has(std::int64_t numbers) const {
    return numbers >= 0 && numbers <= static_cast<std::int64_t>(rest_.size());
  }
  bool at_end() {
    skip_blanks();
    return rest_.empty();
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\n' || rest_.front() == '\r'))
      rest_.remove_prefix(1);
  }
  std::string_view rest_;
};

}  // namespace

std::string to_skin_text(const TriangleMesh& mesh) {
  std::string text;
  append(text, static_cast<std::int64_t>(mesh.vertices.size()));
  append(text, static_cast<std::int64_t>(mesh.triangles.size()));
  std::int64_t before[3] = {};
  for (const Vec3& v : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t at = std::llround(v[axis] * steps);
      append(text, at - before[axis]);
      before[axis] = at;
    }
  }
  std::int64_t corner = 0;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      append(text, std::int64_t{v} - corner);
      corner = v;
    }
  }
  return text;
}

std::optional<TriangleMesh> mesh_of_skin_text(std::string_view text) {
  Numbers numbers(text);
  const auto vertices = numbers.next(), triangles = numbers.next();
  if (!vertices || !triangles || !numbers.has(*vertices) || !numbers.has(*triangles)) return std::nullopt;
  TriangleMesh mesh;
  std::int64_t at[3] = {};
  for (std::int64_t v = 0; v < *vertices; ++v) {
    Vec3 position;
    for (int axis = 0; axis < 3; ++axis) {
      const auto step = numbers.next();
      if (!step) return std::nullopt;
      at[axis] += *step;
      position[axis] = static_cast<double>(at[axis]) / steps;
    }
    mesh.vertices.push_back(position);
  }
  std::int64_t corner = 0;
  for (std::int64_t t = 0; t < *triangles; ++t) {
    Triangle& made = mesh.triangles.emplace_back();
    for (std::uint32_t& v : made) {
      const auto step = numbers.next();
      if (!step) return std::nullopt;
      corner += *step;
      if (corner < 0 || corner >= *vertices) return std::nullopt;
      v = static_cast<std::uint32_t>(corner);
    }
  }
  return numbers.at_end() ? std::optional(std::move(mesh)) : std::nullopt;
}

}  // namespace aspic

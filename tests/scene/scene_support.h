#pragma once
// What the scene tests share: files around a single key, and comparison of scenes value by value.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "aspic/scene.h"
#include "model/terrain.h"
#include "scene/parameters.h"

namespace aspic::test {

/// Enough for every legal size, so that ranges alone decide.
inline const LoadOptions unlimited = {.memory_bytes = std::uint64_t{1} << 60};

/// The first shape that has a geometry key.
inline std::string_view shape_with(const Parameter& p) {
  const auto has = [&](const TerrainShapeRow& row) { return belongs_to_shape(p, row.value); };
  return std::ranges::find_if(terrain_shapes, has)->name;
}

/// A corner of a kind of body: the last side that each axis has.
inline std::string corner_of(const PinNames& pins) {
  std::string corner;
  for (std::size_t axis = 0; axis < pins.sides.size() / 2; ++axis) {
    std::string_view name;
    for (const Side& side : pins.sides)
      if (side.axis == axis) name = side.name;
    corner += fmt::format("{}{}", corner.empty() ? "" : "-", name);
  }
  return corner;
}

/// A scene file that gives one key a value, and where it does so (from 1).
struct KeyFile {
  std::string text;
  std::size_t line = 0, key_column = 0, value_column = 0;
};

/// The smallest legal file around `key = value`; `misspelt` replaces the key's last part.
inline KeyFile file_with(const Parameter& p, const std::string& value, const std::string& misspelt = "") {
  KeyFile file;
  const auto add = [&](const std::string& line) { file.text += line + "\n"; };
  const auto count_lines = [&] {
    return static_cast<std::size_t>(std::count(file.text.begin(), file.text.end(), '\n'));
  };
  const std::size_t dot = p.path.find('.');
  const std::string section(dot == std::string_view::npos ? std::string_view{} : p.path.substr(0, dot));
  std::string key(dot == std::string_view::npos ? p.path : p.path.substr(dot + 1));
  const std::size_t last_dot = key.rfind('.');
  const std::size_t last = last_dot == std::string::npos ? 0 : last_dot + 1;
  if (!misspelt.empty()) key.replace(last, std::string::npos, misspelt);
  const auto add_key = [&] {
    file.line = count_lines() + 1;
    file.key_column = last + 1;
    file.value_column = key.size() + 4;
    add(key + " = " + value);
  };
  if (p.path != "schema") add("schema = 1");
  if (section.empty()) add_key();
  if (section != "cube[]") add("[[cube]]");
  if (!section.empty()) {
    const bool list = section.ends_with("[]");
    add(list ? fmt::format("[[{}]]", section.substr(0, section.size() - 2)) : fmt::format("[{}]", section));
    if (p.belonging == Belonging::geometry) add(fmt::format("shape = \"{}\"", shape_with(p)));
    if (p.belonging == Belonging::material) add("material = {}");
    if (p.belonging == Belonging::wave) add("phase.along = \"x\"");
    add_key();
  }
  return file;
}

/// Blocks of a message: one for each problem.
inline std::vector<std::string> problems_in(const std::string& message) {
  std::vector<std::string> blocks;
  for (std::size_t start = 0; start <= message.size();) {
    const std::size_t end = std::min(message.find("\n\n", start), message.size());
    blocks.push_back(message.substr(start, end - start));
    start = end + 2;
  }
  return blocks;
}

/// Expects that a problem's block names this place, shows the line and has its caret under the column.
inline void expect_at(const std::string& block, const KeyFile& file, std::size_t column) {
  const std::string place = fmt::format("scene.toml:{}:{}: ", file.line, column);
  EXPECT_EQ(block.substr(0, place.size()), place) << block;
  std::vector<std::string> lines;
  for (std::size_t start = 0; start <= block.size();) {
    const std::size_t end = std::min(block.find('\n', start), block.size());
    lines.push_back(block.substr(start, end - start));
    start = end + 1;
  }
  ASSERT_EQ(lines.size(), 3u) << block;
  std::size_t start = 0;
  for (std::size_t l = 1; l < file.line; ++l) start = file.text.find('\n', start) + 1;
  const std::string shown = file.text.substr(start, file.text.find('\n', start) - start);
  const std::size_t gutter = lines[1].find("| ") + 2;
  EXPECT_EQ(lines[1].substr(gutter), shown);
  EXPECT_EQ(lines[2].find('^'), gutter + column - 1) << block;
}

/// Equality bit for bit: −0 and +0 differ.
inline bool same_bits(const Value& a, const Value& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  if (a.index() != b.index()) return false;
  if (const auto* x = std::get_if<double>(&a)) return bits(*x) == bits(std::get<double>(b));
  if (const auto* x = std::get_if<Vec3>(&a)) {
    const Vec3& y = std::get<Vec3>(b);
    return bits(x->x) == bits(y.x) && bits(x->y) == bits(y.y) && bits(x->z) == bits(y.z);
  }
  if (const auto* x = std::get_if<PinnedSettings>(&a)) {
    const auto& y = std::get<PinnedSettings>(b);
    return x->names == y.names && x->indices == y.indices;
  }
  if (const auto* x = std::get_if<std::vector<int>>(&a)) return *x == std::get<std::vector<int>>(b);
  if (const auto* x = std::get_if<std::vector<double>>(&a))
    return std::ranges::equal(*x, std::get<std::vector<double>>(b), {}, bits, bits);
  if (const auto* x = std::get_if<bool>(&a)) return *x == std::get<bool>(b);
  if (const auto* x = std::get_if<std::int64_t>(&a)) return *x == std::get<std::int64_t>(b);
  if (const auto* x = std::get_if<std::string>(&a)) return *x == std::get<std::string>(b);
  if (const auto* x = std::get_if<CellLayers>(&a)) return *x == std::get<CellLayers>(b);
  if (const auto* x = std::get_if<CellPalette>(&a)) return *x == std::get<CellPalette>(b);
  if (const auto* x = std::get_if<SignalTable>(&a)) return *x == std::get<SignalTable>(b);
  return std::get<std::vector<std::string>>(a) == std::get<std::vector<std::string>>(b);
}

/// Expects every value of two scenes to be the same, the key `except` aside.
inline void expect_same_scene(const Scene& a, const Scene& b, std::string_view except = "") {
  for (const Parameter& p : parameters()) {
    if (p.path == except) continue;
    ASSERT_EQ(index_count(p, a), index_count(p, b)) << p.path;
    for (std::size_t i = 0; i < index_count(p, a); ++i) {
      const auto x = p.get(a, i), y = p.get(b, i);
      ASSERT_EQ(x.has_value(), y.has_value()) << p.path << " of index " << i;
      if (x) {
        EXPECT_TRUE(same_bits(*x, *y)) << p.path << " of index " << i;
      }
    }
  }
}

/// parse_scene of a text that must be legal.
inline Scene parsed(const std::string& text, const std::vector<std::string>& overrides = {}) {
  auto scene = parse_scene(text, "scene.toml", overrides, unlimited);
  if (!scene) {
    ADD_FAILURE() << scene.error().message() << "\n" << text;
    return {};
  }
  return *std::move(scene);
}

/// The message parse_scene refuses a text with.
inline std::string rejection(const std::string& text, const std::vector<std::string>& overrides = {},
                             const LoadOptions& options = unlimited) {
  const auto scene = parse_scene(text, "scene.toml", overrides, options);
  if (scene) {
    ADD_FAILURE() << "accepted:\n" << text;
    return "";
  }
  EXPECT_EQ(scene.error().code, ErrorCode::scene_rejected);
  return scene.error().message();
}

}  // namespace aspic::test

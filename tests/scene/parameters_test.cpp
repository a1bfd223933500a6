// Every key of the table is driven through the parser: no key can be forgotten.
#include "scene/parameters.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scene/reader.h"
#include "scene/scene_support.h"
#include "scene/write.h"

namespace aspic {
namespace {

using test::expect_at;
using test::file_with;
using test::KeyFile;
using test::problems_in;
using testing::HasSubstr;

class EveryKey : public testing::TestWithParam<std::string_view> {
 protected:
  const Parameter& p = *find_parameter(GetParam());
};

std::vector<std::string_view> all_paths() {
  std::vector<std::string_view> paths;
  for (const Parameter& p : parameters()) paths.push_back(p.path);
  return paths;
}

INSTANTIATE_TEST_SUITE_P(Table, EveryKey, testing::ValuesIn(all_paths()), [](const auto& instance) {
  std::string name(instance.param);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
});

/// A value and how far behind the value's start the culprit stands.
struct Wrong {
  std::string value;
  std::size_t offset = 0;
};

std::vector<Wrong> wrong_types(const Parameter& p) {
  const std::vector<Wrong> never = {{"1979-05-27"}, {"{ a = 1 }"}};
  std::vector<Wrong> wrong;
  switch (p.type) {
    case ParameterType::boolean:
      wrong = {{"\"true\""}, {"1"}, {"1.0"}, {"[true]"}};
      break;
    case ParameterType::integer:
      wrong = {{"\"1\""}, {"8.0"}, {"true"}, {"[1]"}};
      break;
    case ParameterType::number:
      wrong = {{"\"1.0\""}, {"true"}, {"[1.0]"}};
      break;
    case ParameterType::text:
    case ParameterType::word:
      wrong = {{"1"}, {"1.5"}, {"true"}, {"[\"a\"]"}};
      break;
    case ParameterType::words:
      wrong = {{"\"solid\""},
               {"1"},
               {"[1]", 1},
               {fmt::format("[\"{}\", true]", p.words[0]), p.words[0].size() + 5}};
      break;
    case ParameterType::vector:
      wrong = {{"\"x\""},          {"1.0"}, {"[1.0, 2.0]"}, {"[]"}, {"[1, 2, 3, 4]"}, {"[0, \"a\", 1]", 4},
               {"[0, 0, true]", 7}};
      break;
    case ParameterType::counts:
    case ParameterType::numbers: {
      const std::string right = p.components == 2 ? "2" : "2, 2";
      wrong = {{"\"x\""},
               {"2"},
               {"[2]"},
               {"[]"},
               {fmt::format("[{}, 2, 2]", right)},
               {fmt::format("[{}, \"a\"]", right), right.size() + 3},
               {fmt::format("[{}, true]", right), right.size() + 3}};
      if (p.type == ParameterType::counts)
        wrong.push_back({fmt::format("[{}, 2.0]", right), right.size() + 3});
      break;
    }
    case ParameterType::pinned:
      wrong = {{"\"top\""}, {"1"}, {"[1.0]", 1}, {"[\"top\", true]", 8}};
      break;
    case ParameterType::layers:
      wrong = {{"\"11\""}, {"1"}, {"[\"11\"]", 1}, {"[[\"11\"], [1]]", 9}};
      break;
    case ParameterType::palette:
      return {{"\"muscle\""}, {"1"}, {"[\"muscle\"]"}, {"{ a = 1 }", 6}, {"1979-05-27"}};
    case ParameterType::names:
      wrong = {{"1"}, {"true"}, {"[1]", 1}, {"[\"a\", true]", 6}};
      break;
    case ParameterType::points:
      wrong = {{"1"}, {"[1]", 1}, {"[[1]]", 1}, {"[[0, 1], [1, \"a\"]]", 9}};
      break;
  }
  if (p.path == "actuator[].select.voxels") wrong.erase(wrong.begin());  // the name of a file
  wrong.insert(wrong.end(), never.begin(), never.end());
  return wrong;
}

TEST_P(EveryKey, RefusesOtherTypesInTheirPlace) {
  for (const Wrong& wrong : wrong_types(p)) {
    const KeyFile file = file_with(p, wrong.value);
    const std::string message = test::rejection(file.text);
    ASSERT_EQ(problems_in(message).size(), 1u) << message;
    expect_at(message, file, file.value_column + wrong.offset);
    EXPECT_THAT(message, HasSubstr(fmt::format("'{}' must be {}", key_text(p), allowed_text(p))));
  }
}

std::vector<Wrong> out_of_range(const Parameter& p) {
  std::vector<Wrong> wrong;
  const Range& r = p.range;
  switch (p.type) {
    case ParameterType::boolean:
    case ParameterType::text:
      break;
    case ParameterType::layers:
      wrong = {{"[]"},
               {"[[\"11\"], [\"11\", \"1.\"]]", 9},
               {"[[\"11\"], [\"1\"]]", 9},
               {"[[\"1\\t\"]]", 1},
               {"[[\"..\"]]"},
               {"[[\"1.1\"]]"}};
      break;
    case ParameterType::palette:
      wrong = {{"{ 10 = \"muscle\" }"}, {"{ a = \"no-such-material\" }"}};
      break;
    case ParameterType::integer:
      wrong = {{std::to_string(static_cast<std::int64_t>(r.min) - 1)},
               {std::to_string(static_cast<std::int64_t>(r.max) + 1)},
               {"9223372036854775807"},
               {"-9223372036854775808"}};
      break;
    case ParameterType::number:
    case ParameterType::numbers:
    case ParameterType::vector: {
      std::vector<std::string> figures = {"nan", "inf", "-inf", "-nan", "1e300", "-1e300"};
      figures.push_back(toml_value(Value(std::nextafter(r.max, 1e300))));
      figures.push_back(toml_value(Value(std::nextafter(r.min, -1e300))));
      if (r.min_excluded) {
        figures.push_back(toml_value(Value(r.min)));
        figures.emplace_back("1e-60");  // zero in single precision
      }
      for (const std::string& x : figures) {
        if (p.type == ParameterType::number) {
          wrong.push_back({x});
        } else if (p.components == 2) {
          wrong.push_back({fmt::format("[{}, 1]", x), 1});
          wrong.push_back({fmt::format("[1, {}]", x), 4});
        } else {
          wrong.push_back({fmt::format("[{}, 1, 1]", x), 1});
          wrong.push_back({fmt::format("[1, {}, 1]", x), 4});
          wrong.push_back({fmt::format("[1, 1, {}]", x), 7});
        }
      }
      if (p.direction) wrong.insert(wrong.end(), {{"[0, 0, 0]"}, {"[0.0, -0.0, 0.0]"}, {"[1e-200, 0, 0]"}});
      break;
    }
    case ParameterType::word:
      wrong = {{"\"no-such-word\""}, {"\"\""}};
      break;
    case ParameterType::words:
      wrong = {{fmt::format("[\"{}\", \"no-such-word\"]", p.words[0]), p.words[0].size() + 5},
               {fmt::format("[\"{0}\", \"{1}\", \"{0}\"]", p.words[0], p.words[1]),
                p.words[0].size() + p.words[1].size() + 9}};
      break;
    case ParameterType::counts:
      wrong = {{"[1, 2, 2]", 1},
               {fmt::format("[2, {}, 2]", p.range.max + 1), 4},
               {"[2, 2, -9223372036854775808]", 7}};
      if (p.components == 2)
        wrong = {
            {"[1, 2]", 1}, {fmt::format("[2, {}]", p.range.max + 1), 4}, {"[2, -9223372036854775808]", 4}};
      break;
    case ParameterType::pinned:
      wrong = {{"[\"no-such-word\"]", 1}, {"[3, \"top-top-top\"]", 4}, {"[\"top\", -1]", 8}, {"[1000]", 1},
               {"[0, 4294967296]", 4},    {"[\"left-right\"]", 1}};
      // A corner lacks no side.
      if (p.pins->sides.size() == 6) wrong.push_back({"[\"left-top\"]", 1});
      break;
    case ParameterType::names:
      wrong = {{"\"no-such-name\""}};
      break;
    case ParameterType::points:
      wrong = {{"[[0, 0], [1, 1e300]]", 9}, {"[[0, 0], [inf, 1]]", 9}, {"[[0, nan], [1, 1]]", 1}};
      break;
  }
  if (p.path == "actuator[].select.voxels") wrong.clear();  // ActuatorScene has them
  return wrong;
}

TEST_P(EveryKey, RefusesValuesOutOfRangeInTheirPlace) {
  for (const Wrong& wrong : out_of_range(p)) {
    const KeyFile file = file_with(p, wrong.value);
    const std::string message = test::rejection(file.text);
    ASSERT_EQ(problems_in(message).size(), 1u) << message;
    expect_at(message, file, file.value_column + wrong.offset);
    const bool names_key = message.find(fmt::format("'{}'", key_text(p))) != std::string::npos;
    EXPECT_TRUE(names_key || p.path == "schema") << message;
  }
}

TEST_P(EveryKey, AcceptsTheEndsOfItsRange) {
  if (reader::is_cell_source(p.path)) return;  // MeshScene.TakesTheEndsOfItsRanges
  if (reader::is_actuator_source(p.path)) return;
  if (p.type != ParameterType::integer && p.type != ParameterType::number) {
    for (const std::string_view word : p.words) {
      const std::string value =
          p.type == ParameterType::word ? fmt::format("\"{}\"", word) : fmt::format("[\"{}\"]", word);
      test::parsed(file_with(p, value).text);
    }
    return;
  }
  const bool whole = p.type == ParameterType::integer;
  for (const double end : {p.range.min, p.range.max}) {
    const double x = p.range.min_excluded && end == p.range.min ? 1e-30 : end;
    const Value value = whole ? Value(static_cast<std::int64_t>(x)) : Value(x);
    const Scene scene = test::parsed(file_with(p, toml_value(value)).text);
    EXPECT_TRUE(test::same_bits(*p.get(scene, 0), value));
  }
}

TEST_P(EveryKey, SuggestsItselfForAMisspeltName) {
  const std::string_view key = p.path.substr(p.path.find_last_of('.') + 1);
  std::string dropped(key), swapped(key), doubled(key);
  dropped.erase(1, 1);
  std::swap(swapped[0], swapped[1]);
  doubled.insert(2, 1, key[1]);
  for (const std::string& misspelt : {dropped, swapped, doubled}) {
    const KeyFile file = file_with(p, "1", misspelt);
    std::vector<std::string> problems = problems_in(test::rejection(file.text));
    if (p.path == "schema")
      std::erase_if(problems, [](const std::string& s) { return s.find("missing") != std::string::npos; });
    ASSERT_EQ(problems.size(), 1u);
    expect_at(problems[0], file, file.key_column);
    EXPECT_THAT(problems[0], HasSubstr(fmt::format("unknown key '{}'", misspelt)));
    EXPECT_THAT(problems[0], HasSubstr(fmt::format("did you mean '{}'?", key)));
  }
}

TEST_P(EveryKey, SaysWhatItIs) {
  EXPECT_TRUE(p.meaning.ends_with('.'));
  EXPECT_FALSE(allowed_text(p).empty());
  EXPECT_FALSE(default_text(p).empty());
  EXPECT_EQ(path_kind(p.path), PathKind::parameter);
}

TEST(Parameters, HaveDistinctPaths) {
  const std::vector<std::string_view> paths = all_paths();
  EXPECT_EQ(std::set<std::string_view>(paths.begin(), paths.end()).size(), paths.size());
}

TEST(Parameters, KnowTablesAndLists) {
  EXPECT_EQ(path_kind("simulation"), PathKind::table);
  EXPECT_EQ(path_kind("simulation.implicit"), PathKind::table);
  EXPECT_EQ(path_kind("cube"), PathKind::list);
  EXPECT_EQ(path_kind("cube[]"), PathKind::table);
  EXPECT_EQ(path_kind("cube[].shear"), PathKind::table);
  EXPECT_EQ(path_kind("cub"), PathKind::unknown);
  EXPECT_EQ(path_kind("cube[].she"), PathKind::unknown);
}

}  // namespace
}  // namespace aspic

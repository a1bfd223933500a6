#pragma once
// The built-in scenes, for tests that go through all of them.
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "cli/process.h"

namespace aspic::test {

/// Names, as the program lists them.
inline std::set<std::string> builtin_scenes() {
  std::set<std::string> names;
  const auto listed = nlohmann::json::parse(aspic({"scene", "list", "--json"}).out);
  for (const auto& scene : listed["scenes"]) names.insert(scene["name"]);
  return names;
}

}  // namespace aspic::test

#pragma once
#include <cstdlib>
#include <string>

namespace aspic::test {

/// A variable of the environment; empty if there is none.
inline std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

}  // namespace aspic::test

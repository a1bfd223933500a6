#pragma once
// Finds declarations of a header without a Doxygen comment.
#include <string>
#include <string_view>
#include <vector>

namespace aspic::testing {

/// A declaration that nothing is said of.
struct Uncommented {
  int line = 0;  ///< where it begins, from 1
  std::string name;
};

/// What a header declares without `///` in the lines directly above or `///<` behind: types, functions,
/// constants and aliases, and the public and protected members of classes. Functions of one name that follow
/// each other share a comment. Values of an enumeration need none, unless others of the same one have one.
/// Constructors, destructors, operators, friends, what is deleted or defaulted, and types that are only
/// announced need none either.
std::vector<Uncommented> uncommented(std::string_view header);

}  // namespace aspic::testing

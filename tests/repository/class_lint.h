#pragma once
// Counts the public methods of classes, by the text of their headers.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace aspic::testing {

/// A class with its public methods: several of one name and the same parameters, such as one for const
/// objects, count once. Constructors, the destructor, operators and what is inherited do not count.
struct ClassSize {
  std::string name;
  std::size_t methods = 0;
};

/// The classes and structs that a header defines, inner ones too, in their order.
std::vector<ClassSize> class_sizes(std::string_view header);

}  // namespace aspic::testing

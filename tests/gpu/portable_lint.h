#pragma once
// Reads GLSL for what Mesa and glslang accept and another driver refuses or takes in another sense.
#include <string>
#include <string_view>
#include <vector>

namespace aspic::testing {

/// One offense against GLSL 4.30 as the strictest compilers read it. Rules:
/// - block-argument: a member of a buffer block as an argument of a function of ours. Section 4.10 forbids it
///   where the parameter lacks the block's memory qualifiers; NVIDIA: C1317. Built-in functions and
///   constructors take members. A swizzle is no member.
/// - block-layout: a block without std430 or std140, whose layout the driver chooses then (AMD)
/// - unsized-array: an array without a size that is not the last member of a buffer block
/// - shared-initializer: shared memory with an initial value (4.3.8)
/// - uninitialized: a local, of no array, whose first use reads it; NVIDIA: C7050
/// - missing-return: a function with a value that does not end with a return; NVIDIA: C1110
/// - undefined-function: a prototype without a body, which only the linker notices
/// - complex-target: an assignment to a part of a swizzle; NVIDIA: C5025
/// - reserved-name: a name with two underscores in a row (3.7)
/// - undefined-macro: #if with a name that is no macro: an error in 3.3, zero for Mesa; NVIDIA: C0105
/// - unbalanced: braces that do not match, which blind this lint
/// - directive: #extension, #pragma or #line, in which drivers differ
struct PortabilityOffense {
  int line = 0;  ///< from 1
  std::string rule;
  std::string text;  ///< the name or argument in question
  friend bool operator==(const PortabilityOffense&, const PortabilityOffense&) = default;
};

/// Which lines count as the shader's.
enum class Branches {
  taken,  ///< those that the defines in the text select
  every   ///< those of all branches of each #if: what any set of defines selects
};

/// The offenses of a complete shader, in the order of the lines. With every branch, undefined-macro and
/// undefined-function are left out: they depend on the defines.
std::vector<PortabilityOffense> lint_portability(std::string_view text, Branches branches);

}  // namespace aspic::testing

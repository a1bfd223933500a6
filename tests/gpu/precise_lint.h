#pragma once
// Reads GLSL for what would change bits between devices. Equality on a software rasterizer proves nothing
// about `precise`, so the text itself is checked.
#include <compare>
#include <string>
#include <string_view>
#include <vector>

namespace aspic::testing {

/// One offense. Rules:
/// - missing-precise: a float local that is not `precise`
/// - inexact-store: arithmetic assigned to a float that is not `precise` (a buffer, shared memory, a
/// parameter)
/// - inexact-return: arithmetic in the return of a float function: Mesa takes no `precise` on function types
/// - inexact-argument: float arithmetic within the argument of a call, where `precise` need not reach
/// - forbidden: a built-in function whose rounding differs between devices
/// - fma: fma() outside compute/device_arithmetic.glsl
/// - adds-zero: a literal zero added or subtracted: compilers fold it, although −0 + 0 is +0
struct Offense {
  int line = 0;  ///< from 1
  std::string rule;
  std::string text;  ///< the name or token in question
  auto operator<=>(const Offense&) const = default;
};

/// Whether the first line opts out: `// not-exact: reason`, with a reason.
bool opted_out(std::string_view text);

/// The offenses of one shader file, in the order of the lines. `path` is relative to shaders/.
std::vector<Offense> lint(std::string_view path, std::string_view text);

}  // namespace aspic::testing

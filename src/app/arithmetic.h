#pragma once
// Numbers as one writes them down: 2*9.8, 1/60, 1e-3*(4 + 1).
#include <string_view>

#include "base/result.h"

namespace aspic::app {

/// The value of decimal numbers joined by + − * / and parentheses, with the usual precedence; blanks between
/// them mean nothing. Error (usage): what is wrong, with the text and a caret below the place in lines of
/// their own; also where the value is not finite, and for more than 100 parentheses or signs within one
/// another.
Result<double> evaluate(std::string_view text);

}  // namespace aspic::app

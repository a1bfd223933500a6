#include "app/arithmetic.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include "base/printable.h"

namespace aspic::app {
namespace {

/// A recursive-descent parser of one line.
class Line {
 public:
  explicit Line(std::string_view text) : text_(text) {}

  Result<double> value() {
    ASPIC_TRY(const double all, sum());
    if (next() == ')') return wrong("this parenthesis has no opening one");
    if (next() != 0) return wrong("an operator + - * or / is missing between two numbers");
    at_ = 0;
    if (!std::isfinite(all)) return wrong("the result is not a finite number");
    return all;
  }

 private:
  static constexpr int deepest = 100;

  /// The next character that is no blank; 0 at the end.
  char next() {
    at_ = std::min(text_.find_first_not_of(" \t", at_), text_.size());
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  Error wrong(std::string_view what) const {
    return {ErrorCode::usage, fmt::format("The number is unchanged: {}.\n{}\n{}^", what, printable(text_),
                                          std::string(at_, ' '))};
  }

  Result<double> sum() {
    ASPIC_TRY(double left, product());
    for (char sign = next(); sign == '+' || sign == '-'; sign = next()) {
      ++at_;
      ASPIC_TRY(const double right, product());
      left = sign == '+' ? left + right : left - right;
    }
    return left;
  }

  Result<double> product() {
    ASPIC_TRY(double left, factor());
    for (char sign = next(); sign == '*' || sign == '/'; sign = next()) {
      ++at_;
      const std::size_t divisor = at_;
      ASPIC_TRY(const double right, factor());
      if (sign == '/' && right == 0.0) {
        at_ = divisor;
        next();
        return wrong("division by 0");
      }
      left = sign == '*' ? left * right : left / right;
    }
    return left;
  }

  Result<double> factor() {
    const char first = next();
    if (++depth_ > deepest) return wrong("parentheses or signs are nested too deeply");
    double value = 0.0;
    if (first == '+' || first == '-') {
      ++at_;
      ASPIC_TRY(value, factor());
      value = first == '-' ? -value : value;
    } else if (first == '(') {
      ++at_;
      ASPIC_TRY(value, sum());
      if (next() != ')') return wrong("a closing parenthesis is missing here");
      ++at_;
    } else {
      ASPIC_TRY(value, number());
    }
    --depth_;
    return value;
  }

  Result<double> number() {
    if (at_ == text_.size()) return wrong("a number is missing here");
    double value = 0.0;
    const bool digit = text_[at_] == '.' || (text_[at_] >= '0' && text_[at_] <= '9');  // no "inf", no "nan"
    const auto read = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (!digit || read.ec == std::errc::invalid_argument) return wrong("expected a number here");
    if (read.ec != std::errc()) return wrong("this number is out of range");
    at_ = static_cast<std::size_t>(read.ptr - text_.data());
    if (at_ < text_.size() && text_[at_] == ',') return wrong("decimals need a point, as in 1.5");
    return value;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Result<double> evaluate(std::string_view text) {
  return Line(text).value();
}

}  // namespace aspic::app

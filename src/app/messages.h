#pragma once
// What the window says to the user.
#include <optional>
#include <string>

#include "base/printable.h"
#include "base/result.h"

namespace aspic::app {

/// A message on top of the picture until it is dismissed or replaced.
struct Notice {
  std::string text;
  bool is_error = false;
  double left = 0.0;  ///< until it disappears, if it is no error [s]
};

/// The one message that is shown. One that is not an error disappears after a while.
class Messages {
 public:
  void info(const std::string& text, double seconds = 5.0) {
    notice_ = Notice{printable(text), false, seconds};
  }
  void error(const std::string& text) { notice_ = Notice{printable(text), true}; }
  /// Shows the error of a status or result, if it has one; true without.
  template <class Outcome>
  bool check(const Outcome& status) {
    if (!status) error(status.error().message);
    return status.ok();
  }
  void dismiss() { notice_.reset(); }
  void dismiss_error() {
    if (notice_ && notice_->is_error) notice_.reset();
  }
  /// Once for each picture, `dt` after the last [s].
  void update(double dt) {
    if (notice_ && !notice_->is_error && (notice_->left -= dt) < 0.0) notice_.reset();
  }
  const std::optional<Notice>& notice() const { return notice_; }

 private:
  std::optional<Notice> notice_;
};

}  // namespace aspic::app

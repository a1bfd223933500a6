#pragma once
// What the window says to the user.
#include <optional>
#include <string>

#include "base/printable.h"
#include "base/result.h"

namespace aspic::app {

/// What ends a message by itself.
enum class Until { dismissed, time, divergence_is_over };

/// A message on top of the picture until it is dismissed or replaced.
struct Notice {
  std::string text;
  bool is_error = false;
  Until until = Until::dismissed;
  double left = 0.0;      ///< until it disappears, if time ends it [s]
  bool greeting = false;  ///< shown at the bottom of the picture until the motion starts
};

/// The one message that is shown. An error that leaves nothing to decide disappears as other messages do.
class Messages {
 public:
  void info(const std::string& text, double seconds = 5.0) {
    notice_ = Notice{printable(text), false, Until::time, seconds};
  }
  void greet(const std::string& text, double seconds) {
    notice_ = Notice{printable(text), false, Until::time, seconds, true};
  }
  /// The motion starts.
  void greeting_is_over() {
    if (notice_ && notice_->greeting) notice_.reset();
  }
  void error(const std::string& text, Until until = Until::dismissed) {
    notice_ = Notice{printable(text), true, until};
  }
  void error(const Error& why) { error(worded(why, FrontEnd::window)); }
  /// What was asked for cannot be done, and nothing has changed.
  void refuse(const Error& why) { refuse(worded(why, FrontEnd::window)); }
  void refuse(const std::string& text) { notice_ = Notice{printable(text), true, Until::time, 8.0}; }
  /// Shows the error of a status or result, if it has one; true without.
  template <class Outcome>
  bool check(const Outcome& status) {
    if (!status) error(status.error());
    return status.ok();
  }
  void dismiss() { notice_.reset(); }
  void dismiss_error() {
    if (notice_ && notice_->is_error) notice_.reset();
  }
  /// What was refused may be possible now.
  void dismiss_refusal() {
    if (notice_ && notice_->is_error && notice_->until == Until::time) notice_.reset();
  }
  /// The simulation has left its divergence: what was said of it no longer holds.
  void divergence_is_over() {
    if (notice_ && notice_->until == Until::divergence_is_over) notice_.reset();
  }
  /// Once for each picture, `dt` after the last [s].
  void update(double dt) {
    if (fades() && (notice_->left -= dt) < 0.0) notice_.reset();
  }
  const std::optional<Notice>& notice() const { return notice_; }
  /// Whether time will end the message that is shown.
  bool fades() const { return notice_ && notice_->until == Until::time; }

 private:
  std::optional<Notice> notice_;
};

}  // namespace aspic::app

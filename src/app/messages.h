#pragma once
// Messages of the window.
#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/printable.h"
#include "base/result.h"

namespace aspic::app {

/// Event that ends a message.
enum class Until { dismissed, time, divergence_is_over };

/// A message on top of the image.
struct Notice {
  std::string text;
  bool is_error = false;
  Until until = Until::dismissed;
  double left = 0.0;      ///< until it disappears, if time ends it [s]
  bool greeting = false;  ///< shown at the bottom of the image until the motion starts
  double age = 0.0;       ///< [s]
};

/// The messages that are shown, the newest last. Information replaces older information, never an error. An
/// error that leaves nothing to decide disappears with time, as information does.
class Messages {
 public:
  static constexpr std::size_t most =
      3;  ///< at once; the oldest information makes room, then the oldest error
  static constexpr double fresh_seconds = 1.0;  ///< for which information stays beside newer information

  void info(const std::string& text, double seconds = 5.0) {
    add({printable(text), false, Until::time, seconds});
  }
  void greet(const std::string& text, double seconds) {
    add({printable(text), false, Until::time, seconds, true});
  }
  /// The motion starts.
  void greeting_is_over() { std::erase_if(notices_, &is_greeting); }
  void error(const std::string& text, Until until = Until::dismissed) { add({printable(text), true, until}); }
  void error(const Error& why) { error(worded(why, FrontEnd::window)); }
  /// Says that a request cannot be met; nothing has changed.
  void refuse(const Error& why) { refuse(worded(why, FrontEnd::window)); }
  void refuse(const std::string& text) { add({printable(text), true, Until::time, 8.0}); }
  /// Shows the error of a status or result, if it has one; true without.
  template <class Outcome>
  bool check(const Outcome& status) {
    if (!status) error(status.error());
    return status.ok();
  }
  void dismiss() { notices_.clear(); }
  void dismiss(std::string_view text) {
    std::erase_if(notices_, [&](const Notice& n) { return n.text == text; });
  }
  void dismiss_error() { std::erase_if(notices_, &is_error); }
  /// Ends refusals: the request may be possible now.
  void dismiss_refusal() {
    std::erase_if(notices_, [](const Notice& n) { return n.is_error && n.until == Until::time; });
  }
  /// The simulation has left its divergence: what was said of it no longer holds.
  void divergence_is_over() {
    std::erase_if(notices_, [](const Notice& n) { return n.until == Until::divergence_is_over; });
  }
  /// Once for each image, `dt` after the last [s].
  void update(double dt) {
    for (Notice& n : notices_) {
      n.age += dt;
      n.left -= n.until == Until::time ? dt : 0.0;
    }
    std::erase_if(notices_, [](const Notice& n) { return n.left < 0.0; });
  }
  const std::vector<Notice>& notices() const { return notices_; }
  /// The newest one.
  std::optional<Notice> notice() const {
    return notices_.empty() ? std::nullopt : std::optional(notices_.back());
  }
  bool any_error() const { return std::ranges::any_of(notices_, &is_error); }
  /// Whether time will end one of them.
  bool fades() const {
    return std::ranges::any_of(notices_, [](const Notice& n) { return n.until == Until::time; });
  }

 private:
  static bool is_error(const Notice& n) { return n.is_error; }
  static bool is_greeting(const Notice& n) { return n.greeting; }

  void add(Notice notice) {
    std::erase_if(notices_, [&](const Notice& n) {
      return n.text == notice.text || (!n.is_error && (n.greeting || n.age > fresh_seconds));
    });
    if (notices_.size() == most) {
      const auto information = std::ranges::find(notices_, false, &Notice::is_error);
      notices_.erase(information == notices_.end() ? notices_.begin() : information);
    }
    notices_.push_back(std::move(notice));
  }

  std::vector<Notice> notices_;
};

}  // namespace aspic::app

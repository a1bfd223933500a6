#include "io/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "base/printable.h"
#include "io/atomic_file.h"

namespace aspic {

namespace {

/// What stderr does not take is lost: it changes no exit code, so nothing is thrown as fmt::print would.
void print_aside(const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace

Status print_data(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    if (errno == EPIPE) return Error{closed_pipe, ""};
    return file_error("write", "standard output", errno);
  }
  return {};
}

Status print_text(std::string_view text) {
  return print_data(printable(text));
}

void print_message(std::string_view text) {
  print_aside(fmt::format("aspic: {}\n", printable(text)));
}

void print_warning(std::string_view text) {
  print_aside(fmt::format("aspic: warning: {}\n", printable(text)));
}

ProgressBar::ProgressBar(std::uint64_t total, std::string_view unit)
    : visible_(::isatty(STDERR_FILENO) == 1 && total > 0), total_(total), unit_(unit) {}

ProgressBar::~ProgressBar() {
  if (drawn_) print_aside("\r\x1b[K");
}

void ProgressBar::update(std::uint64_t done) {
  const auto now = Clock::now();
  if (!visible_ || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  const double share = static_cast<double>(done) / static_cast<double>(total_);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  constexpr int width = 32;
  std::string bar(static_cast<std::size_t>(share * width), '#');
  bar.resize(width, '.');
  std::string left = share > 0.0 ? fmt::format(", {:.0f} s left", elapsed / share - elapsed) : "";
  print_aside(
      fmt::format("\r[{}] {:3.0f} %  {} {} of {}{}\x1b[K", bar, 100.0 * share, unit_, done, total_, left));
  std::fflush(stderr);
}

ProgressLines::ProgressLines(std::uint64_t total, std::string_view unit)
    : silent_(::isatty(STDERR_FILENO) == 1 || total == 0), total_(total), unit_(unit) {}

void ProgressLines::begin(std::string_view name) const {
  if (!silent_) print_message(fmt::format("{} …", name));
}

void ProgressLines::update(std::uint64_t done) {
  const std::uint64_t tenth = silent_ ? 0 : 10 * done / total_;
  if (tenth == tenth_ || silent_) return;
  tenth_ = tenth;
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double left = elapsed / static_cast<double>(done) * static_cast<double>(total_ - done);
  print_message(fmt::format("{} of {} {}{}", done, total_, unit_,
                            done < total_ ? fmt::format(", about {:.0f} s left", left) : ""));
}

}  // namespace aspic

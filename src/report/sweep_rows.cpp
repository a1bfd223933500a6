#include "report/sweep_rows.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <utility>

#include "base/files.h"
#include "base/printable.h"
#include "report/csv.h"

namespace aspic::report {
namespace {

constexpr std::string_view mark = "# aspic sweep: ";

std::string optional_number(const std::optional<double>& value) {
  return value ? csv_number(*value) : "";
}

/// All of it or an error, in which case nothing has been appended.
Status append(int descriptor, const std::string& path, std::string_view text) {
  const off_t before = ::lseek(descriptor, 0, SEEK_END);
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int reason = errno;
      (void)!::ftruncate(descriptor, before);
      return file_error("write", path, reason);
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

}  // namespace

std::string sweep_header(const Grid& grid) {
  std::vector<std::string> fields = {"run"};
  for (const Axis& axis : grid.axes) fields.push_back(axis.key);
  for (const char* name : {"outcome", "reason", "steps", "time", "height", "lowest", "kinetic", "elastic",
                           "gravitational", "total", "max_speed", "contact_time", "squash", "squash_time",
                           "rest_time", "slide", "hash", "seconds"})
    fields.emplace_back(name);
  return csv_row(fields);
}

std::string sweep_row(const Grid& grid, std::size_t index, const TrialResult& result) {
  std::vector<std::string> fields = {fmt::format("{}", index)};
  for (std::string& value : grid.values(index)) fields.push_back(std::move(value));
  fields.emplace_back(name_of(result.outcome));
  fields.push_back(printable_line(result.reason));
  if (const auto& s = result.summary) {
    fields.push_back(fmt::format("{}", result.steps));
    const Measures& m = s->end.measures;
    for (const double value : {s->end.time, s->end.height, s->end.lowest, m.kinetic, m.elastic,
                               m.gravitational, m.total(), m.max_speed})
      fields.push_back(csv_number(value));
    fields.push_back(optional_number(s->contact_time));
    fields.push_back(csv_number(s->squash));
    fields.push_back(csv_number(s->squash_time));
    fields.push_back(optional_number(s->rest_time));
    fields.push_back(csv_number(s->end.slide));
    fields.push_back(result.hash);
    fields.push_back(fmt::format("{:.3g}", result.seconds));
  } else {
    fields.insert(fields.end(), 16, "");
  }
  return csv_row(fields);
}

std::string journal_path(const std::string& path) {
  return path + ".partial";
}

Result<SweepJournal> SweepJournal::open(const std::string& path, const std::string& owner) {
  SweepJournal journal;
  journal.path_ = journal_path(path);
  journal.descriptor_ = ::open(journal.path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (journal.descriptor_ < 0) return file_error("write", journal.path_, errno);
  if (::flock(journal.descriptor_, LOCK_EX | LOCK_NB) != 0)
    return fail(ErrorCode::io, "another aspic sweep is writing {}; give this one another --out.",
                journal.path_);
  ASPIC_CHECK(journal.read(owner));
  return journal;
}

Status SweepJournal::read(const std::string& owner) {
  ASPIC_TRY(std::string text, read_file(path_));
  const std::string first = fmt::format("{}{}\n", mark, printable_line(owner));
  const std::size_t end = text.rfind('\n');
  const std::size_t whole = end == std::string::npos ? 0 : end + 1;
  if (whole < text.size() && ::ftruncate(descriptor_, static_cast<off_t>(whole)) != 0)
    return file_error("write", path_, errno);
  text.resize(whole);
  if (text.empty()) return append(descriptor_, path_, first);
  if (!text.starts_with(first)) {
    const std::string there = text.substr(0, text.find('\n'));
    return fail(ErrorCode::usage,
                "{} holds rows of another sweep:\n  there: {}\n  here:  {}\nComplete that sweep with its own "
                "command, choose another --out, or begin anew with --force.",
                path_, printable_line(there.starts_with(mark) ? there.substr(mark.size()) : there),
                printable_line(owner));
  }
  std::size_t line = 2;
  for (std::size_t at = first.size(); at < text.size(); ++line) {
    const std::size_t next = text.find('\n', at) + 1;
    std::size_t index = 0;
    const auto [stop, error] = std::from_chars(text.data() + at, text.data() + next, index);
    if (error != std::errc() || *stop != ',')
      return fail(ErrorCode::io, "{}:{}: this is no row of a sweep; begin anew with --force.", path_, line);
    rows_[index] = text.substr(at, next - at);
    at = next;
  }
  return {};
}

SweepJournal::SweepJournal(SweepJournal&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      rows_(std::move(other.rows_)) {}

SweepJournal::~SweepJournal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status SweepJournal::add(std::size_t index, const std::string& row) {
  ASPIC_CHECK(append(descriptor_, path_, row));
  rows_[index] = row;
  return {};
}

void SweepJournal::remove() {
  ::unlink(path_.c_str());
}

}  // namespace aspic::report

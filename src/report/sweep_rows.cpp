#include "report/sweep_rows.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <optional>
#include <utility>

#include "base/files.h"
#include "base/printable.h"
#include "report/csv.h"
#include "variants/run_folder.h"
#include "variants/sweep_figures.h"

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
  for (const char* name : {"outcome", "reason", "steps"}) fields.emplace_back(name);
  for (const RunFigure& figure : figures_of({})) fields.emplace_back(figure.name);
  for (const char* name : {"hash", "seconds"}) fields.emplace_back(name);
  return csv_row(fields);
}

RunRow row_of(const TrialResult& result) {
  RunRow row = {result.outcome, result.reason, result.steps, {}, result.hash, result.solver, result.seconds};
  if (result.summary) row.figures = figures_of(*result.summary);
  return row;
}

std::string sweep_row(const Grid& grid, std::size_t index, const RunRow& row) {
  std::vector<std::string> fields = {fmt::format("{}", index)};
  for (std::string& value : grid.values(index)) fields.push_back(std::move(value));
  fields.emplace_back(name_of(row.outcome));
  fields.push_back(printable_line(row.reason));
  const bool began = !row.figures.empty();
  fields.push_back(began ? fmt::format("{}", row.steps) : "");
  for (const RunFigure& figure : began ? row.figures : figures_of({}))
    fields.push_back(began ? optional_number(figure.value) : "");
  fields.push_back(row.hash);
  fields.push_back(began ? fmt::format("{:.3g}", row.seconds) : "");
  return csv_row(fields);
}

namespace {

template <class T>
bool is_number_or_empty(std::string_view text) {
  T number = {};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  return text.empty() || (error == std::errc() && stop == end);
}

/// The run of a row as sweep_row() writes it; nothing if it is none.
std::optional<std::size_t> run_of_row(const Grid& grid, const std::string& row) {
  std::size_t index = grid.size();
  (void)std::from_chars(row.data(), row.data() + row.size(), index);
  if (index >= grid.size()) return std::nullopt;
  std::vector<std::string> first = {fmt::format("{}", index)};
  for (std::string& value : grid.values(index)) first.push_back(std::move(value));
  std::string start = csv_row(first);
  start.back() = ',';
  const std::vector<std::string> fields = csv_fields(row);
  const std::size_t outcome = first.size(), steps = outcome + 2, hash = steps + 1 + figures_of({}).size();
  if (!row.starts_with(start) || fields.size() != hash + 2 || csv_row(fields) != row ||
      !outcome_named(fields[outcome]) || !is_number_or_empty<std::uint64_t>(fields[steps]))
    return std::nullopt;
  for (std::size_t i = steps + 1; i < fields.size(); ++i)
    if (i != hash && !is_number_or_empty<double>(fields[i])) return std::nullopt;
  return index;
}

}  // namespace

std::string journal_path(const std::string& path) {
  return path + ".partial";
}

Result<SweepJournal> SweepJournal::open(const std::string& path, const std::string& owner, const Grid& grid) {
  SweepJournal journal;
  journal.path_ = journal_path(path);
  journal.descriptor_ =
      ::open(journal.path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOCTTY, 0666);
  if (journal.descriptor_ < 0) return file_error("write", journal.path_, errno);
  if (::flock(journal.descriptor_, LOCK_EX | LOCK_NB) != 0)
    return fail(ErrorCode::io, "another aspic sweep is writing {}; give this one another --out.",
                journal.path_);
  ASPIC_CHECK(journal.read(owner, grid));
  return journal;
}

namespace {

/// Any row is far shorter: what is longer is no journal, and may have no end.
constexpr std::size_t longest_line = std::size_t{1} << 20;

/// The lines of a file from its beginning.
class Lines {
 public:
  Lines(int descriptor, const std::string& path) : descriptor_(descriptor), path_(path) {}

  /// The next line with its line end; without one where the file ends or the line is too long. Error (io).
  Result<std::string> next() {
    std::string line;
    while (line.size() <= longest_line) {
      const std::size_t end = held_.find('\n', at_);
      const std::size_t stop = end == std::string::npos ? held_.size() : end + 1;
      line.append(held_, at_, stop - at_);
      at_ = stop;
      if (end != std::string::npos) break;
      ASPIC_TRY(const bool more, refill());
      if (!more) break;
    }
    return line;
  }

 private:
  Result<bool> refill() {
    at_ = 0;
    held_.resize(std::size_t{1} << 16);
    ssize_t got = -1;
    while ((got = ::pread(descriptor_, held_.data(), held_.size(), read_)) < 0 && errno == EINTR) {
    }
    const int reason = errno;
    held_.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
    if (got < 0) return file_error("read", path_, reason);
    read_ += got;
    return got > 0;
  }

  int descriptor_;
  const std::string& path_;
  off_t read_ = 0;
  std::string held_;
  std::size_t at_ = 0;
};

}  // namespace

Status SweepJournal::read(const std::string& owner, const Grid& grid) {
  struct stat present = {};
  if (::fstat(descriptor_, &present) != 0) return file_error("read", path_, errno);
  if (!S_ISREG(present.st_mode))
    return fail(ErrorCode::io, "{} stores finished rows, but is a device or a pipe; give another --out.",
                printable_line(path_));
  const std::string first = fmt::format("{}{}\n", mark, printable_line(owner));
  Lines lines(descriptor_, path_);
  off_t complete = 0;  // bytes of complete lines
  for (std::size_t number = 1;; ++number) {
    ASPIC_TRY(auto line, lines.next());
    const bool ended = line.ends_with('\n');
    if (!ended && line.size() <= longest_line) break;
    const auto index = ended && number > 1 ? run_of_row(grid, line) : std::nullopt;
    if (!index && !(ended && number == 1))
      return fail(ErrorCode::io, "{}:{}: not a row of this sweep; start over with --force.",
                  printable_line(path_), number);
    if (number == 1 && line != first) {
      line.pop_back();
      return fail(
          ErrorCode::usage,
          "{} holds rows of another sweep:\n  there: {}\n  here:  {}\nComplete that sweep with its own "
          "command, choose another --out, or start over with --force.",
          path_, printable_line(line.starts_with(mark) ? line.substr(mark.size()) : line),
          printable_line(owner));
    }
    complete += static_cast<off_t>(line.size());
    if (index) rows_[*index] = std::move(line);
  }
  if (complete < present.st_size && ::ftruncate(descriptor_, complete) != 0)
    return file_error("write", path_, errno);
  return complete == 0 ? append(descriptor_, path_, first) : Status();
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

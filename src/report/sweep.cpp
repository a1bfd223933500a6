#include "report/sweep.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>

#include "base/printable.h"
#include "cpu_parallel/workers.h"
#include "io/atomic_file.h"
#include "io/child_process.h"
#include "io/console.h"
#include "report/csv.h"
#include "report/sweep_rows.h"
#include "run/window_host.h"
#include "variants/run_folder.h"

namespace aspic::report {
namespace {

/// What a worker is told first: the grid, the backend that `auto` is, and threads for the cpu backend.
struct Greeting {
  std::string identity, backend;
  unsigned threads = 0;
};
constexpr std::string_view ready = "ready";

/// A folder of runs of one scene.
struct Kept {
  RunFolder folder;
  std::string scene;

  std::optional<RunRow> read(const SweepRun& run) const {
    const auto file = folder.read(run.key);
    return file ? row_in(*file) : std::nullopt;
  }
  Status write(const SweepRun& run, const RunRow& row) const {
    return folder.write(run.key, "json", run_file(run, row, scene));
  }
};

Result<Kept> open_folder(const std::string& path, const Scene& scene) {
  Kept kept = {RunFolder(path), scene_key(scene)};
  ASPIC_CHECK(kept.folder.make(scene));
  return kept;
}

/// A process that does one run after another, restarted when a run takes it down.
class Worker {
 public:
  /// `folder`: null, or where a run that takes the process down is kept.
  Worker(const std::vector<std::string>& command, const Greeting& greeting, const Kept* folder)
      : command_(command), greeting_(greeting), folder_(folder) {}

  /// The row of a run; nothing once the worker was told to end. Error (io): no process.
  Result<std::optional<std::string>> row(const Grid& grid, std::size_t index) {
    if (!child_) ASPIC_CHECK(start());
    if (!child_) return std::optional<std::string>();
    const std::string request = fmt::format("{}\n", index);
    (void)child_->write(std::as_bytes(std::span(request)));
    if (auto answer = child_->line()) return std::optional(*answer + "\n");
    const std::lock_guard lock(mutex_);
    if (ended_) return std::optional<std::string>();
    const ChildProcess::End end = child_->finish();
    child_.reset();
    RunRow lost;
    lost.outcome = Outcome::failed;
    lost.reason = end.signal != 0 ? fmt::format("signal {} ended the process", end.signal)
                                  : fmt::format("the process ended with exit code {}", end.exit_code);
    if (folder_) {
      const SweepRun run = grid_run(grid, index);
      // It may have been kept before its process ended.
      if (const auto kept = folder_->read(run)) return std::optional(sweep_row(grid, index, *kept));
      // Where that fails it is as if it had not been run, which is what the next sweep takes it for anyway.
      (void)folder_->write(run, lost);
    }
    return std::optional(sweep_row(grid, index, lost));
  }

  /// From another thread: the run at hand is given up, and no more are done.
  void end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    if (child_) child_->kill();
  }

 private:
  Status start() {
    ASPIC_TRY(auto child, ChildProcess::start(command_, ChildProcess::Output::answers));
    {
      const std::lock_guard lock(mutex_);
      if (ended_) return {};
      child_.emplace(std::move(child));
    }
    const std::string greeting =
        fmt::format("{} {} {}\n", greeting_.identity, greeting_.backend, greeting_.threads);
    (void)child_->write(std::as_bytes(std::span(greeting)));
    if (child_->line() == ready) return {};
    const std::lock_guard lock(mutex_);
    (void)child_->finish();
    const std::string said = child_->last_lines(3);
    child_.reset();
    if (ended_) return {};
    return fail(ErrorCode::io, "cannot start a process for the runs: {}",
                said.empty() ? "it ended at once." : said);
  }

  const std::vector<std::string>& command_;
  const Greeting& greeting_;
  const Kept* folder_;
  std::mutex mutex_;  // of all below; child_ itself changes on the worker's own thread alone
  bool ended_ = false;
  std::optional<ChildProcess> child_;
};

/// Workers, each on its own thread, and the rows that they deliver.
class Crew {
 public:
  Crew(const SweepPlan& plan, const Greeting& greeting, unsigned jobs, std::deque<std::size_t> runs,
       const Kept* folder)
      : plan_(plan), runs_(std::move(runs)) {
    for (unsigned j = 0; j < jobs; ++j)
      workers_.push_back(std::make_unique<Worker>(plan.command, greeting, folder));
    for (const auto& worker : workers_) threads_.emplace_back([this, w = worker.get()] { work(*w); });
  }
  ~Crew() {
    for (const auto& worker : workers_) worker->end();
    for (std::thread& thread : threads_) thread.join();
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  struct Row {
    std::size_t index = 0;
    std::string text;
  };
  /// The next row; nothing if none comes within a tenth of a second. Error: of a worker.
  Result<std::optional<Row>> next() {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::milliseconds(100), [&] { return !rows_.empty() || error_; });
    if (error_) return *error_;
    if (rows_.empty()) return std::optional<Row>();
    Row row = std::move(rows_.front());
    rows_.pop_front();
    return std::optional(std::move(row));
  }

 private:
  void work(Worker& worker) {
    for (;;) {
      std::size_t index = 0;
      {
        const std::lock_guard lock(mutex_);
        if (runs_.empty() || error_) return;
        index = runs_.front();
        runs_.pop_front();
      }
      auto row = worker.row(plan_.grid, index);
      const std::lock_guard lock(mutex_);
      if (!row) error_ = row.error();
      if (row && !*row) return;
      if (row) rows_.push_back({index, std::move(**row)});
      changed_.notify_one();
    }
  }

  const SweepPlan& plan_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::size_t> runs_;  // guarded, as all below
  std::deque<Row> rows_;
  std::optional<Error> error_;
};

/// Whether any run may take a device, which runs in several processes would only contend for.
bool takes_device(const Grid& grid, const BackendRow& usual) {
  bool takes = usual.needs_context;
  for (const Axis& axis : grid.axes) {
    if (axis.key != "backend") continue;
    for (const std::string& value : axis.values) {
      const auto choice = parse_backend(value, grid.backend);
      takes = takes || (choice && choice->row && choice->row->needs_context);
    }
  }
  return takes;
}

SweepCounts count_rows(const std::map<std::size_t, std::string>& rows, const Grid& grid) {
  SweepCounts counts;
  for (const auto& [index, row] : rows) {
    const std::vector<std::string> fields = csv_fields(row);
    const std::size_t at = 1 + grid.axes.size();  // after the run's number and its values
    if (fields.size() < at + 2) continue;
    const std::string& outcome = fields[at];
    if (outcome == name_of(Outcome::ok)) ++counts.ok;
    if (outcome == name_of(Outcome::diverged)) ++counts.diverged;
    if (outcome == name_of(Outcome::rejected)) ++counts.rejected;
    if (outcome == name_of(Outcome::failed)) ++counts.failed;
    const bool refused = outcome == name_of(Outcome::rejected) || outcome == name_of(Outcome::failed);
    if (!refused || !counts.first_reason.empty()) continue;
    std::vector<std::string> values;
    for (std::size_t a = 0; a < grid.axes.size(); ++a)
      values.push_back(fmt::format("{}={}", grid.axes[a].key, fields[1 + a]));
    counts.first_reason =
        fmt::format("run {} ({}) was {}: {}", index, fmt::join(values, ", "),
                    outcome == name_of(Outcome::rejected) ? "rejected" : "lost", fields[at + 1]);
  }
  return counts;
}

/// Rows of finished runs, and where they are kept: the journal, or the folder in which workers keep them.
class KeptRows {
 public:
  static Result<KeptRows> open(const SweepPlan& plan) {
    KeptRows kept;
    if (plan.runs.empty()) {
      if (plan.force) ::unlink(journal_path(plan.out).c_str());
      const std::string owner = fmt::format("{}, part {}/{}, grid {}", plan.description, plan.part.i,
                                            plan.part.n, plan.grid.identity());
      ASPIC_TRY(auto journal, SweepJournal::open(plan.out, owner, plan.grid));
      kept.rows_ = journal.rows();
      kept.journal_.emplace(std::move(journal));
      return kept;
    }
    ASPIC_TRY(kept.folder_, open_folder(plan.runs, plan.grid.scene));
    for (std::size_t i = plan.first(); i < plan.end(); ++i) {
      const SweepRun run = grid_run(plan.grid, i);
      std::error_code ignored;
      if (const std::string file = kept.folder_->folder.file(run.key, "json");
          std::filesystem::is_directory(file, ignored))
        return fail(ErrorCode::io,
                    "{} is a directory in the place of a run; move it, or give another --runs.",
                    printable_line(file));
      const auto row = kept.folder_->read(run);
      if (row && !plan.force) kept.rows_[i] = sweep_row(plan.grid, i, *row);
    }
    return kept;
  }

  const std::map<std::size_t, std::string>& rows() const { return rows_; }
  const Kept* folder() const { return folder_ ? &*folder_ : nullptr; }
  Status add(std::size_t index, const std::string& row) {
    if (journal_) ASPIC_CHECK(journal_->add(index, row));
    rows_[index] = row;
    return {};
  }
  /// The sweep is complete.
  void finish() {
    if (journal_) journal_->remove();
  }

 private:
  std::map<std::size_t, std::string> rows_;
  std::optional<SweepJournal> journal_;
  std::optional<Kept> folder_;
};

Result<AtomicFile> open_output(const SweepPlan& plan) {
  return AtomicFile::create(plan.out, plan.force ? Overwrite::allow : Overwrite::refuse);
}

}  // namespace

Result<SweepCounts> run_sweep(const SweepPlan& plan, const InterruptGuard& interrupt) {
  const Grid& grid = plan.grid;
  if (!plan.out.empty()) {
    // Proves that the output can be written; not kept, since a kill would leave its temporary file behind.
    ASPIC_TRY(const auto proof, open_output(plan));
  }
  ASPIC_TRY(auto kept, KeptRows::open(plan));

  std::deque<std::size_t> runs;
  for (std::size_t i = plan.first(); i < plan.end(); ++i) {
    if (!kept.rows().contains(i)) runs.push_back(i);
  }
  const std::size_t resumed = kept.rows().size(), wanted = runs.size();
  if (wanted > 0) {
    const BackendRow& usual = grid.backend.row ? *grid.backend.row : *choose_automatically(grid.backend).row;
    ASPIC_TRY(const unsigned processors, parallel::available_threads());
    unsigned jobs = plan.jobs > 0 ? plan.jobs : takes_device(grid, usual) ? 1 : processors;
    jobs = static_cast<unsigned>(std::min<std::size_t>(jobs, wanted));
    const Greeting greeting = {grid.identity(), std::string(usual.name), std::max(1u, processors / jobs)};
    ProgressBar bar(wanted, "run");
    ProgressLines lines(wanted, "runs");
    Crew crew(plan, greeting, jobs, std::move(runs), kept.folder());
    for (std::size_t done = 0; done < wanted;) {
      if (interrupt.interrupted())
        return fail(
            ErrorCode::interrupted, "interrupted after {} of {} runs; the same command continues from {}.",
            kept.rows().size(), resumed + wanted, plan.runs.empty() ? journal_path(plan.out) : plan.runs);
      ASPIC_TRY(const auto row, crew.next());
      if (row) {
        ASPIC_CHECK(kept.add(row->index, row->text));
        lines.update(++done);
      }
      bar.update(done);
    }
  }
  if (!plan.out.empty()) {
    ASPIC_TRY(auto file, open_output(plan));
    ASPIC_CHECK(file.write(sweep_header(grid)));
    for (const auto& [index, row] : kept.rows()) ASPIC_CHECK(file.write(row));
    ASPIC_CHECK(file.commit());
  }
  SweepCounts counts = count_rows(kept.rows(), grid);
  counts.resumed = resumed;
  kept.finish();
  return counts;
}

Status serve_sweep(const Grid& grid, const std::string& runs) {
  const InterruptGuard ended_at_once(InterruptGuard::At::first_signal);
  // A run whose parent is gone would compute a row that nobody reads.
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  std::string identity, backend;
  unsigned threads = 0;
  std::cin >> identity >> backend >> threads;
  if (!std::cin || identity != grid.identity())
    return fail(ErrorCode::usage, "the scene has changed since the sweep began; start over with --force.");
  std::optional<Kept> folder;
  if (!runs.empty()) {
    ASPIC_TRY(folder, open_folder(runs, grid.scene));
  }
  ASPIC_CHECK(print_data(fmt::format("{}\n", ready)));
  for (std::size_t index = 0; std::cin >> index;) {
    const SweepRun run = grid_run(grid, index);
    TrialResult result;
    if (run.error) {
      result = trial_error(*run.error);
    } else {
      BackendChoice choice = run.backend.row ? run.backend : choice_for(find_backend(backend), run.backend);
      if (choice.threads == 0 && choice.row->threaded) choice.threads = threads;
      auto model = build_model(run.scene.model);
      if (model) {
        ASPIC_TRY(result, run_trial(shared(std::move(*model)), {choice, {run.steps, {}}}));
      } else {
        result = trial_error(model.error());
      }
    }
    RunRow row = row_of(result);
    if (folder) {
      if (const auto written = folder->write(run, row); !written) {
        row.outcome = Outcome::failed;
        row.reason = written.error().what;
      }
    }
    ASPIC_CHECK(print_data(sweep_row(grid, index, row)));
  }
  return {};
}

}  // namespace aspic::report

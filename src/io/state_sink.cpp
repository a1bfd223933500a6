#include "io/state_sink.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "aspic/version.h"
#include "base/files.h"
#include "base/printable.h"
#include "io/checkpoint.h"
#include "io/export_npz.h"
#include "io/export_pc2.h"
#include "io/export_pvd.h"
#include "io/numbered_files.h"
#include "io/series_csv.h"
#include "io/state_csv.h"
#include "io/state_vtp.h"
#include "model/integrator.h"

namespace aspic {
namespace {

/// Writes one state to a file that is not committed yet. Error (diverged): a number is not finite.
using StateWriter = Status (*)(AtomicFile&, const Sample&);

/// Which states become files.
enum class Keep {
  last_or_all,  ///< the last one, or with an interval one file for each
  newest        ///< the last one, with an interval the newest so far, which replaces the one before
};

/// States, each alone in a file.
class StateFiles final : public StateSink {
 public:
  template <StateWriter Writer, Keep Kept = Keep::last_or_all>
  static Result<std::unique_ptr<StateSink>> open(const std::string& path, std::uint64_t every,
                                                 Overwrite overwrite, const RunFacts& facts) {
    const bool numbers = every > 0 && Kept == Keep::last_or_all;
    auto sink = std::make_unique<StateFiles>(numbers ? numbered(path, "*") : path, every);
    sink->overwrite_ = overwrite;
    sink->writer_ = Writer;
    sink->facts_ = facts;
    if (numbers) {
      sink->pattern_ = path;
    } else {
      ASPIC_TRY(sink->file_, AtomicFile::create(path, overwrite));
    }
    return std::unique_ptr<StateSink>(std::move(sink));
  }
  using StateSink::StateSink;

  Status take(const Sample& sample) override {
    // The newest state alone is of no use before the run has gone anywhere.
    const bool first = !std::exchange(begun_, true);
    if (first && !pattern_.empty() && overwrite_ == Overwrite::refuse)
      ASPIC_CHECK(refuse_later_files(pattern_, sample.state.step));
    return every() > 0 && !(first && pattern_.empty()) ? write(sample) : Status();
  }
  Status finish(const Sample& last) override { return write(last); }

 private:
  /// After an error the next state is tried again.
  Status write(const Sample& sample) {
    if (last_step_ == sample.state.step) return {};
    if (!pattern_.empty()) {
      ASPIC_TRY(file_, AtomicFile::create(numbered(pattern_, sample.state.step), overwrite_));
    } else if (!file_) {
      // What is there since the last one is our own.
      ASPIC_TRY(file_, AtomicFile::create(path(), last_step_ ? Overwrite::allow : overwrite_));
    }
    AtomicFile file = std::move(*file_);
    file_.reset();
    ASPIC_CHECK(writer_(file, {sample.model, sample.state, sample.solves, &facts_, nullptr, sample.inputs}));
    ASPIC_CHECK(file.commit());
    last_step_ = sample.state.step;
    return {};
  }
  std::string pattern_;  // of the names of many files; empty: there is one
  Overwrite overwrite_ = Overwrite::refuse;
  StateWriter writer_ = nullptr;
  RunFacts facts_;
  std::optional<AtomicFile> file_;
  std::optional<std::uint64_t> last_step_;  // written
  bool begun_ = false;
};

/// Energies and momentum, a row for each of many steps.
class Series final : public StateSink {
 public:
  static Result<std::unique_ptr<StateSink>> open(const std::string& path, std::uint64_t every,
                                                 Overwrite overwrite, const RunFacts& facts) {
    ASPIC_TRY(auto writer,
              SeriesWriter::create(path, overwrite, row_of(facts.integrator).traits.reports_solves));
    return std::unique_ptr<StateSink>(std::make_unique<Series>(path, every, std::move(writer)));
  }
  Series(const std::string& path, std::uint64_t every, SeriesWriter writer)
      : StateSink(path, every), writer_(std::move(writer)) {}

  Status take(const Sample& s) override { return writer_.add(s); }
  Status finish(const Sample& last) override {
    const Status added = take(last);
    return added ? writer_.finish() : added;
  }
  std::optional<double> actuator_work() const override { return writer_.work(); }

 private:
  SeriesWriter writer_;
};

Status write_csv(AtomicFile& file, const Sample& sample) {
  return write_state_csv(file, sample.state);
}

Status write_vtp(AtomicFile& file, const Sample& sample) {
  return write_state_vtp(file, sample);
}

Status write_whole_run(AtomicFile& file, const Sample& sample) {
  return write_checkpoint(file, {ASPIC_VERSION, sample.facts->scene_toml, sample.model.simulation.timestep,
                                 sample.state, sample.facts->inputs_toml});
}

constexpr std::string_view state_summary = "write the final state";
constexpr std::string_view state_every =
    "steps between states: FILE-00000040.csv and so on, from the first to the last";

constexpr std::string_view export_summary = "write the motion";
constexpr std::string_view export_every = "steps between samples of the export; default: about 0.02 s";

constexpr StateFormat formats[] = {
    {"state", ".csv", "CSV", state_summary, state_every, 0, false, false, StateFiles::open<write_csv>},
    {"state", ".vtp", "VTK PolyData", state_summary, state_every, 0, false, false,
     StateFiles::open<write_vtp>},
    {"series", ".csv", "CSV", "write energies and momentum over time",
     "steps between rows of the series; default 1", 1, true, false, Series::open},
    {"checkpoint", ".aspic", "a checkpoint", "write scene and final state, to resume from,",
     "steps between checkpoints, each replacing the previous one", 0, false, true,
     StateFiles::open<write_whole_run, Keep::newest>},
    {"export", ".pvd", "ParaView's series", export_summary, export_every, 0, false, false, open_pvd, true,
     "-*.vtp"},
    {"export", ".pc2", "Blender's cache", export_summary, export_every, 0, false, false, open_pc2, true,
     ".obj"},
    {"export", ".npz", "numpy's arrays", export_summary, export_every, 0, false, false, open_npz, true},
};

}  // namespace

Status write_state(const std::string& path, const Model& model, const State& state, Overwrite overwrite) {
  ASPIC_CHECK(check_state_name("state", path));
  ASPIC_TRY(const auto sink, state_format_of("state", path).open(path, 0, overwrite, {}));
  return sink->finish({model, state});
}

Status write_checkpoint(const std::string& path, const std::string& scene_toml, const Model& model,
                        const State& state, Overwrite overwrite) {
  ASPIC_TRY(const auto sink, state_format_of("checkpoint", path).open(path, 0, overwrite, {scene_toml}));
  return sink->finish({model, state});
}

std::span<const StateFormat> state_formats() {
  return formats;
}

std::vector<std::string_view> state_options() {
  std::vector<std::string_view> options;
  for (const StateFormat& format : formats)
    if (options.empty() || options.back() != format.option) options.push_back(format.option);
  return options;
}

std::string state_help(std::string_view option) {
  std::string_view summary;
  std::vector<std::string> kinds;
  for (const StateFormat& format : formats) {
    if (format.option != option) continue;
    if (summary.empty()) summary = format.summary;
    kinds.push_back(fmt::format("{} ({})", format.label, format.ending));
  }
  return fmt::format("{} as {}", summary, fmt::join(kinds, " or "));
}

Status check_state_name(std::string_view option, const std::string& path) {
  if (path == "-")
    return fail(ErrorCode::usage,
                "a {} named - would be a file of that name: write /dev/stdout for standard output.", option);
  const std::string ending = ending_of(path);
  if (ending.empty() || is_device_or_pipe(path)) return {};
  std::vector<std::string_view> endings;
  for (const StateFormat& format : formats) {
    if (format.option != option) continue;
    if (format.ending == ending) return {};
    endings.push_back(format.ending);
  }
  return fail(ErrorCode::usage, "the {}'s name {} must end in {}, which sets its format.", option,
              printable_line(path), fmt::join(endings, " or "));
}

const StateFormat& state_format_of(std::string_view option, std::string_view path) {
  const StateFormat* chosen = nullptr;
  const std::string ending = ending_of(std::string(path));
  for (const StateFormat& format : formats) {
    if (format.option != option) continue;
    if (!chosen || format.ending == ending) chosen = &format;
  }
  return *chosen;
}

}  // namespace aspic

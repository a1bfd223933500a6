#include "io/state_sink.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "io/checkpoint.h"
#include "io/series_csv.h"
#include "io/state_csv.h"
#include "io/state_vtp.h"

namespace aspic {
namespace {

/// "end.csv" with "00000040" for the step: "end-00000040.csv".
std::string numbered(const std::string& path, const std::string& step) {
  const std::string ending = std::filesystem::path(path).extension().string();
  return fmt::format("{}-{}{}", path.substr(0, path.size() - ending.size()), step, ending);
}

/// Writes one state to a file that is not committed yet. Error (diverged): a number is not finite.
using StateWriter = Status (*)(AtomicFile&, const Sample&);

/// The last state in a file, or a file for each of many steps.
class StateFiles final : public StateSink {
 public:
  template <StateWriter Writer>
  static Result<std::unique_ptr<StateSink>> open(const std::string& path, std::uint64_t every,
                                                 Overwrite overwrite, const RunFacts&) {
    auto sink = std::make_unique<StateFiles>(path, every, overwrite, Writer);
    if (every == 0) {
      ASPIC_TRY(sink->file_, AtomicFile::create(path, overwrite));
    }
    return std::unique_ptr<StateSink>(std::move(sink));
  }
  StateFiles(const std::string& path, std::uint64_t every, Overwrite overwrite, StateWriter writer)
      : StateSink(every > 0 ? numbered(path, "*") : path, every),
        pattern_(path),
        overwrite_(overwrite),
        writer_(writer) {}

  Status take(const Sample& sample) override { return every() > 0 ? write(sample) : Status(); }
  Status finish(const Sample& last) override { return write(last); }

 private:
  Status write(const Sample& sample) {
    if (last_step_ == sample.state.step) return {};
    if (every() > 0) {
      ASPIC_TRY(file_,
                AtomicFile::create(numbered(pattern_, fmt::format("{:08}", sample.state.step)), overwrite_));
    }
    last_step_ = sample.state.step;
    ASPIC_CHECK(writer_(*file_, sample));
    return file_->commit();
  }
  std::string pattern_;
  Overwrite overwrite_;
  StateWriter writer_;
  std::optional<AtomicFile> file_;
  std::optional<std::uint64_t> last_step_;
};

/// Energies and momentum, a row for each of many steps.
class Series final : public StateSink {
 public:
  static Result<std::unique_ptr<StateSink>> open(const std::string& path, std::uint64_t every,
                                                 Overwrite overwrite, const RunFacts& facts) {
    ASPIC_TRY(auto writer,
              SeriesWriter::create(path, overwrite, facts.integrator == Integrator::implicit_euler));
    return std::unique_ptr<StateSink>(std::make_unique<Series>(path, every, std::move(writer)));
  }
  Series(const std::string& path, std::uint64_t every, SeriesWriter writer)
      : StateSink(path, every), writer_(std::move(writer)) {}

  Status take(const Sample& s) override { return writer_.add(s.model, s.state, s.solves); }
  Status finish(const Sample& last) override {
    const Status added = take(last);
    return added ? writer_.finish() : added;
  }

 private:
  SeriesWriter writer_;
};

/// The scene with the last state, or with the newest of many, which replaces the one before.
class CheckpointFile final : public StateSink {
 public:
  static Result<std::unique_ptr<StateSink>> open(const std::string& path, std::uint64_t every,
                                                 Overwrite overwrite, const RunFacts& facts) {
    ASPIC_TRY(auto file, AtomicFile::create(path, overwrite));
    return std::unique_ptr<StateSink>(
        std::make_unique<CheckpointFile>(path, every, std::move(file), facts.scene_toml));
  }
  CheckpointFile(const std::string& path, std::uint64_t every, AtomicFile file, std::string scene_toml)
      : StateSink(path, every), file_(std::move(file)), scene_toml_(std::move(scene_toml)) {}

  Status take(const Sample& sample) override {
    const bool first = !last_step_;
    if (first) last_step_ = sample.state.step;
    return every() > 0 && !first ? write(sample) : Status();
  }
  Status finish(const Sample& last) override {
    return written_ && last_step_ == last.state.step ? Status() : write(last);
  }

 private:
  Status write(const Sample& sample) {
    if (written_) {
      // What is there now is our own.
      ASPIC_TRY(file_, AtomicFile::create(path(), Overwrite::allow));
    }
    const Checkpoint checkpoint = {ASPIC_VERSION, scene_toml_, sample.model.simulation.timestep,
                                   sample.state};
    ASPIC_CHECK(write_checkpoint(file_, checkpoint));
    last_step_ = sample.state.step;
    written_ = true;
    return file_.commit();
  }
  AtomicFile file_;
  std::string scene_toml_;
  std::optional<std::uint64_t> last_step_;
  bool written_ = false;
};

Status write_csv(AtomicFile& file, const Sample& sample) {
  return write_state_csv(file, sample.state);
}

Status write_vtp(AtomicFile& file, const Sample& sample) {
  return write_state_vtp(file, sample.model, sample.state);
}

constexpr std::string_view state_summary = "write the final state";
constexpr std::string_view state_every =
    "steps between states: FILE-00000040.csv and so on, from the first to the last";

constexpr StateFormat table[] = {
    {"state", ".csv", "CSV", state_summary, state_every, 0, false, false, StateFiles::open<write_csv>},
    {"state", ".vtp", "VTK PolyData", state_summary, state_every, 0, false, false,
     StateFiles::open<write_vtp>},
    {"series", ".csv", "CSV", "write energies and momentum over time",
     "steps between rows of the series; default 1", 1, true, false, Series::open},
    {"checkpoint", ".aspic", "a checkpoint", "write scene and final state, to resume from,",
     "steps between checkpoints, each replacing the previous one", 0, false, true, CheckpointFile::open},
};

}  // namespace

std::span<const StateFormat> state_formats() {
  return table;
}

std::vector<std::string_view> state_options() {
  std::vector<std::string_view> options;
  for (const StateFormat& format : table)
    if (options.empty() || options.back() != format.option) options.push_back(format.option);
  return options;
}

std::string state_help(std::string_view option) {
  std::string_view summary;
  std::vector<std::string> kinds;
  for (const StateFormat& format : table) {
    if (format.option != option) continue;
    if (summary.empty()) summary = format.summary;
    kinds.push_back(fmt::format("{} ({})", format.label, format.ending));
  }
  return fmt::format("{} as {}", summary, fmt::join(kinds, " or "));
}

const StateFormat& state_format_of(std::string_view option, std::string_view path) {
  const StateFormat* chosen = nullptr;
  for (const StateFormat& format : table) {
    if (format.option != option) continue;
    if (!chosen || path.ends_with(format.ending)) chosen = &format;
  }
  return *chosen;
}

}  // namespace aspic

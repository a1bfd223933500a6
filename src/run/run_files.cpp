#include "run/run_files.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "run/recorder.h"
#include "io/checkpoint.h"
#include "io/state_csv.h"
#include "io/video_file.h"

namespace aspic {
namespace {

Status refuse_duplicates(const RunOptions& options) {
  struct Named {
    const char* option;
    const std::string* path;
  };
  const std::array<Named, 4> files = {{{"--state", &options.state_file},
                                       {"--series", &options.series_file},
                                       {"--checkpoint", &options.checkpoint_file},
                                       {"--video", &options.pictures.video}}};
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = i + 1; j < files.size(); ++j) {
      if (files[i].path->empty() || files[j].path->empty()) continue;
      std::error_code failed_a, failed_b;
      const auto a = std::filesystem::weakly_canonical(std::filesystem::absolute(*files[i].path), failed_a);
      const auto b = std::filesystem::weakly_canonical(std::filesystem::absolute(*files[j].path), failed_b);
      // Devices may take several outputs one after the other.
      if (failed_a || failed_b || a != b || a.native().starts_with("/dev/")) continue;
      return Error{ErrorCode::usage, fmt::format("{} and {} both name {}: give each file its own name.",
                                                 files[i].option, files[j].option, *files[i].path)};
    }
  }
  return {};
}

}  // namespace

Result<RunFiles> RunFiles::open(const RunOptions& options, Integrator integrator) {
  if (const Status distinct = refuse_duplicates(options); !distinct) return distinct.error();
  const Overwrite overwrite = options.force ? Overwrite::allow : Overwrite::refuse;
  RunFiles files;
  files.every_ = options.every;
  if (!options.series_file.empty()) {
    auto series =
        SeriesWriter::create(options.series_file, overwrite, integrator == Integrator::implicit_euler);
    if (!series) return series.error();
    files.series_ = std::move(*series);
    files.series_path_ = options.series_file;
  }
  if (!options.state_file.empty()) {
    auto file = AtomicFile::create(options.state_file, overwrite);
    if (!file) return file.error();
    files.state_ = std::move(*file);
  }
  if (!options.checkpoint_file.empty()) {
    auto file = AtomicFile::create(options.checkpoint_file, overwrite);
    if (!file) return file.error();
    files.checkpoint_ = std::move(*file);
  }
  const RecordingOptions& pictures = options.pictures;
  if (!pictures.frames.empty()) {
    auto frames = open_frame_directory(pictures.frames, pictures.frames_format, pictures.size, overwrite);
    if (!frames) return frames.error();
    files.frames_ = std::move(*frames);
  }
  if (!pictures.video.empty()) {
    auto video = open_video(pictures.video, pictures.size, frames_per_second(pictures), overwrite);
    if (!video) return video.error();
    files.video_ = std::move(*video);
  }
  return files;
}

std::vector<FrameSink*> RunFiles::frame_sinks() const {
  std::vector<FrameSink*> sinks;
  for (FrameSink* sink : {video_.get(), frames_.get()})
    if (sink) sinks.push_back(sink);
  return sinks;
}

Status RunFiles::add_row(const Model& model, const State& state, const SolveStatistics& solves) {
  return series_ ? series_->add(model, state, solves) : Status{};
}

Status RunFiles::finish(const Model& model, const std::string& scene_toml, const State& state) {
  Status first;
  const auto complete = [&](const std::string& path, Status written, auto& file, auto close) {
    if (written) written = close(*file);
    if (written) {
      written_.push_back(path);
    } else if (first) {
      first = written;
    }
    file.reset();
  };
  for (std::unique_ptr<FrameSink>* sink : {&video_, &frames_}) {
    if (!*sink) continue;
    const std::string path = (*sink)->path();
    complete(path, {}, *sink, [](FrameSink& s) { return s.finish(); });
  }
  if (series_) complete(series_path_, {}, series_, [](SeriesWriter& s) { return s.finish(); });
  const auto commit = [](AtomicFile& file) { return file.commit(); };
  if (state_) complete(std::string(state_->path()), write_state_csv(*state_, state), state_, commit);
  if (checkpoint_) {
    const Checkpoint checkpoint = {ASPIC_VERSION, scene_toml, model.simulation.timestep, state};
    complete(std::string(checkpoint_->path()), write_checkpoint(*checkpoint_, checkpoint), checkpoint_,
             commit);
  }
  return first;
}

}  // namespace aspic

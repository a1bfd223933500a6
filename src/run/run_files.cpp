#include "run/run_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "base/result.h"
#include "io/numbered_files.h"
#include "io/state_sink.h"
#include "io/video_format.h"
#include "page/live_facts.h"
#include "page/page_writer.h"

namespace aspic {
namespace {

Status refuse_duplicates(const std::vector<StateOutput>& states, const ImageOutput& images) {
  std::vector<std::pair<std::string, std::string>> files = {
      {"video", images.video}, {"page", images.page}, {"live page", images.page_live}};
  for (const StateOutput& output : states) {
    files.emplace_back(output.option, output.path);
    if (output.path.empty()) continue;
    const StateFormat& format = state_format_of(output.option, output.path);
    if (!format.companion.empty())
      files.emplace_back(output.option, with_ending(output.path, format.companion));
    if (output.option == "state" && output.every.value_or(0) > 0)
      files.emplace_back(output.option, numbered(output.path, "*"));
  }
  std::erase_if(files, [](const auto& file) { return file.second.empty(); });
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = i + 1; j < files.size(); ++j) {
      std::error_code failed_a, failed_b;
      const auto place = [](const std::string& path, std::error_code& failed) {
        return std::filesystem::weakly_canonical(std::filesystem::absolute(written_path(path)), failed);
      };
      const auto a = place(files[i].second, failed_a), b = place(files[j].second, failed_b);
      // Devices may take several outputs one after the other.
      if (failed_a || failed_b || a != b || a.native().starts_with("/dev/")) continue;
      return fail(ErrorCode::usage, "{} and {} would both write {}: give each its own name.", files[i].first,
                  files[j].first, files[i].second);
    }
  }
  return {};
}

}  // namespace

struct RunFiles::Parts {
  struct Output {
    std::unique_ptr<StateSink> sink;
    bool failed = false;
  };
  void note_failure(Output& output, const Error& error);

  std::vector<Output> outputs;
  std::vector<std::unique_ptr<FrameSink>> frame_sinks;
  std::vector<std::string> written;
  std::vector<Error> failures;
  std::optional<double> actuator_work;
  bool begun = false;
};

RunFiles::RunFiles(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
RunFiles::RunFiles(RunFiles&&) noexcept = default;
RunFiles& RunFiles::operator=(RunFiles&&) noexcept = default;
RunFiles::~RunFiles() = default;

const std::vector<Error>& RunFiles::failures() const {
  return parts_->failures;
}

const std::vector<std::string>& RunFiles::written() const {
  return parts_->written;
}

std::optional<double> RunFiles::actuator_work() const {
  return parts_->actuator_work;
}

std::vector<std::unique_ptr<FrameSink>> RunFiles::take_frame_sinks() {
  return std::move(parts_->frame_sinks);
}

Result<RunFiles> RunFiles::open(const std::vector<StateOutput>& states, const ImageOutput& images,
                                const RunFacts& facts, Overwrite overwrite, const PageFacts& page) {
  ASPIC_CHECK(check_endings(states));
  ASPIC_CHECK(refuse_duplicates(states, images));
  if (page.scene && !images.page_live.empty())
    ASPIC_CHECK(page::check_live(page.precision, page.arithmetic, !facts.inputs_toml.empty()));
  auto files = std::make_unique<Parts>();
  for (const StateOutput& output : states) {
    if (output.path.empty()) continue;
    const StateFormat& format = state_format_of(output.option, output.path);
    ASPIC_TRY(auto sink,
              format.open(output.path, output.every.value_or(format.default_every), overwrite, facts));
    files->outputs.push_back({std::move(sink)});
  }
  for (const std::string* const path : {&images.page, &images.page_live}) {
    if (!page.scene || path->empty()) continue;
    ASPIC_CHECK(page::check_page_name(*path));
    const page::PageSettings settings = {frames_per_second(images), images.speed, page.command,
                                         path == &images.page_live};
    ASPIC_TRY(auto sink,
              page::open_page(*path, overwrite, *page.scene, settings, page.first_step, page.last_step));
    files->outputs.push_back({std::move(sink)});
  }
  const auto add = [&](const VideoFormat& format, const std::string& path) -> Status {
    ASPIC_TRY(auto sink, open_video(format, path, images.size, frames_per_second(images), overwrite));
    files->frame_sinks.push_back(std::move(sink));
    return {};
  };
  if (!images.frames.empty()) ASPIC_CHECK(add(*images.frames_format, images.frames));
  if (!images.video.empty()) {
    ASPIC_TRY(const auto format, video_format_of(images.video));
    ASPIC_CHECK(add(*format, images.video));
  }
  return RunFiles(std::move(files));
}

std::uint64_t RunFiles::next_step(std::uint64_t step) const {
  std::uint64_t next = std::numeric_limits<std::uint64_t>::max();
  for (const auto& [sink, failed] : parts_->outputs) next = std::min(next, sink->next_step(step));
  return next;
}

void RunFiles::Parts::note_failure(Output& output, const Error& error) {
  if (!std::exchange(output.failed, true)) failures.push_back(error);
}

bool RunFiles::any_left() const {
  return std::ranges::any_of(parts_->outputs, [](const Parts::Output& output) { return !output.failed; });
}

Status RunFiles::take(const Sample& sample) {
  const bool first = !std::exchange(parts_->begun, true);
  for (Parts::Output& output : parts_->outputs) {
    const std::uint64_t step = sample.state.step;
    if (!first && (step == 0 || output.sink->next_step(step - 1) != step)) continue;
    const Status taken = output.sink->take(sample);
    if (taken) continue;
    // Before the first step a run loses nothing by ending.
    if (first || taken.error().code != ErrorCode::io) return taken;
    parts_->note_failure(output, taken.error());
  }
  return {};
}

Status RunFiles::finish(const Sample& last) {
  for (Parts::Output& output : parts_->outputs) {
    if (const Status finished = output.sink->finish(last); !finished)
      parts_->note_failure(output, finished.error());
    else
      parts_->written.push_back(output.sink->path());
    if (const auto work = output.sink->actuator_work()) parts_->actuator_work = work;
    output.sink.reset();
  }
  parts_->outputs.clear();
  return failures().empty() ? Status() : Status(failures().front());
}

Status check_endings(const std::vector<StateOutput>& outputs) {
  for (const StateOutput& output : outputs)
    if (!output.path.empty()) ASPIC_CHECK(check_state_name(output.option, output.path));
  return {};
}

double frames_per_second(const ImageOutput& output) {
  if (output.fps) return *output.fps;
  const auto format = video_format_of(output.video);
  return format ? (*format)->default_fps : output.frames_format->default_fps;
}

std::string free_name(const std::string& scene, std::string_view ending) {
  const std::string stem = std::filesystem::path(scene).stem().string();
  for (int number = 1;; ++number) {
    const std::string name = fmt::format("aspic-{}-{:04}{}", stem, number, ending);
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(name, error))) return name;
  }
}

}  // namespace aspic

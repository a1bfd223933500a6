#include "app/video_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/result.h"
#include "model/inputs.h"
#include "page/live_facts.h"
#include "variants/comparison.h"

namespace aspic::app {
namespace {

std::vector<std::uint64_t> models_of(const Comparison& comparison) {
  std::vector<std::uint64_t> numbers;
  for (std::size_t i = 0; i < comparison.count(); ++i)
    numbers.push_back(comparison.run(i).present().model_number());
  return numbers;
}

/// What a run was made of, not what the editor has since.
Scene scene_of(const Comparison& comparison, std::size_t run) {
  Scene scene = comparison.scene(run);
  scene.model = comparison.run(run).present().setup().settings;
  return scene;
}

/// Whether hands have a part in what the first run does: pulls, pins, balls that were thrown.
bool has_hands(const Comparison& comparison) {
  const PlaybackSession& run = comparison.run(0);
  const Setup& setup = run.present().setup();
  return !setup.thrown.empty() || !setup.pinned.empty() || !run.inputs().empty();
}

Status check_live(ComparisonView& view) {
  const Comparison& comparison = view.comparison();
  if (comparison.active())
    return fail(ErrorCode::usage, "a live page has one run, and this video has several.");
  return page::check_live(view.image(0).shown_state().precision,
                          comparison.run(0).present().engines().leader().arithmetic, has_hands(comparison));
}

/// What acts on a run, as its solver takes it; nothing where that would refuse it.
Inputs inputs_of_run(const PlaybackSession& run, Precision precision) {
  auto inputs = rounded_inputs(run.model(), run.inputs(), precision);
  return inputs ? std::move(*inputs) : Inputs();
}

class VideoPage final : public VideoFile {
 public:
  VideoPage(const Comparison& comparison, page::PageWriter writer, bool live)
      : VideoFile(comparison), writer_(std::move(writer)), live_(live) {}

 private:
  bool goes_on(const Comparison& comparison) const override { return !live_ || !has_hands(comparison); }
  Status write(const Comparison& comparison, const States& states) override {
    std::vector<Inputs> inputs;
    for (std::size_t i = 0; i < states.size(); ++i)
      inputs.push_back(inputs_of_run(comparison.run(i), states[i]->precision));
    return writer_.add(states, inputs);
  }
  Status complete_with(const States& last,
                       const std::vector<std::optional<Divergence>>& divergences) override {
    return writer_.finish(last, divergences);
  }
  std::string path() const override { return writer_.path(); }
  std::string sentence(std::uint64_t images) const override {
    return live_ ? fmt::format("{} simulates the same run in browsers.", path())
                 : fmt::format("{} holds the same {} frames for browsers.", path(), images);
  }

  page::PageWriter writer_;
  bool live_;
};

class VideoStates final : public VideoFile {
 public:
  VideoStates(const Comparison& comparison, std::vector<std::unique_ptr<StateSink>> sinks)
      : VideoFile(comparison), sinks_(std::move(sinks)), models_(sinks_.size()), inputs_(sinks_.size()) {}

 private:
  Status write(const Comparison& comparison, const States& states) override {
    for (std::size_t i = 0; i < sinks_.size(); ++i) {
      const PlaybackSession& run = comparison.run(i);
      // Kept for the end, when the run may have another.
      models_[i] = run.present().engines().shared_model();
      inputs_[i] = inputs_of_run(run, states[i]->precision);
      ASPIC_CHECK(sinks_[i]->take({.model = *models_[i], .state = *states[i], .inputs = &inputs_[i]}));
    }
    return {};
  }
  Status complete_with(const States& last, const std::vector<std::optional<Divergence>>&) override {
    for (std::size_t i = 0; i < sinks_.size(); ++i)
      ASPIC_CHECK(sinks_[i]->finish({.model = *models_[i], .state = *last[i], .inputs = &inputs_[i]}));
    return {};
  }
  std::string path() const override {
    std::vector<std::string> paths;
    for (const auto& sink : sinks_) paths.push_back(sink->path());
    return fmt::format("{}", fmt::join(paths, ", "));
  }
  std::string sentence(std::uint64_t images) const override {
    return fmt::format("{} {} the states of the video's {} frames.", path(),
                       sinks_.size() > 1 ? "hold" : "holds", images);
  }

  std::vector<std::unique_ptr<StateSink>> sinks_;  // of each run
  std::vector<SharedModel> models_;
  std::vector<Inputs> inputs_;
};

}  // namespace

VideoFile::VideoFile(const Comparison& comparison)
    : models_(models_of(comparison)), last_(comparison.count()), divergences_(comparison.count()) {}

void VideoFile::fail(const Error& error) {
  said_ = worded(error, FrontEnd::window);
  failed_ = true;
}

void VideoFile::add(ComparisonView& view) {
  const Comparison& comparison = view.comparison();
  if (complete()) return;
  if (models_ != models_of(comparison)) return finish("a value was changed or a ball was thrown.");
  if (!goes_on(comparison)) return finish("a live page cannot repeat a pull or pin.");
  States states;
  for (std::size_t i = 0; i < comparison.count(); ++i) {
    states.push_back(&view.image(i).shown_state());
    if (images_ > 0 && states[i]->step < last_[i].step) return finish("a run went back.");
  }
  if (const Status written = write(comparison, states); !written) {
    // What cannot be added may still be the end of what there is.
    if (images_ == 0 || written.error().code != ErrorCode::usage) return fail(written.error());
    return finish(worded(written.error(), FrontEnd::window));
  }
  for (std::size_t i = 0; i < states.size(); ++i) {
    last_[i] = *states[i];
    divergences_[i] = comparison.shown_divergence(i);
  }
  ++images_;
}

void VideoFile::finish(std::string_view why) {
  if (complete()) return;
  if (images_ == 0)
    return fail({ErrorCode::io, fmt::format("{} was not written: the video has no frame.", path())});
  States states;
  for (const State& state : last_) states.push_back(&state);
  if (const Status written = complete_with(states, divergences_); !written) return fail(written.error());
  said_ = sentence(images_);
  if (!why.empty()) said_ += fmt::format(" It ends before the video: {}", why);
}

Result<std::unique_ptr<VideoFile>> start_video_page(const std::string& path, ComparisonView& view,
                                                    page::PageSettings settings) {
  const Comparison& comparison = view.comparison();
  if (settings.live) ASPIC_CHECK(check_live(view));
  ASPIC_TRY(auto writer, page::PageWriter::create(path, Overwrite::refuse));
  std::vector<Scene> scenes;
  std::vector<page::PageRun> runs;
  for (std::size_t i = 0; i < comparison.count(); ++i) scenes.push_back(scene_of(comparison, i));
  for (std::size_t i = 0; i < comparison.count(); ++i)
    runs.push_back(
        {&scenes[i], &comparison.run(i).model(), comparison.active() ? view.name(i) : std::string()});
  ASPIC_CHECK(writer.begin(settings, runs));
  return std::unique_ptr<VideoFile>(
      std::make_unique<VideoPage>(comparison, std::move(writer), settings.live));
}

Result<std::unique_ptr<VideoFile>> start_video_states(const std::string& path, const StateFormat& format,
                                                      const Comparison& comparison) {
  std::vector<std::unique_ptr<StateSink>> sinks;
  for (std::size_t i = 0; i < comparison.count(); ++i) {
    const Scene scene = scene_of(comparison, i);
    ASPIC_TRY(auto sink, format.open(comparison.active() ? numbered_path(path, i + 1) : path, 1,
                                     Overwrite::refuse, {to_toml(scene), scene.model.simulation.integrator}));
    sinks.push_back(std::move(sink));
  }
  return std::unique_ptr<VideoFile>(std::make_unique<VideoStates>(comparison, std::move(sinks)));
}

}  // namespace aspic::app

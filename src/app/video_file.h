#pragma once
// Files that are written next to a video, from the same states.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/comparison_view.h"
#include "base/result.h"
#include "io/state_sink.h"
#include "page/page_writer.h"

namespace aspic::app {

/// A file of one setup, forward in time: where the runs become others, or one goes back, it ends by itself
/// and the video goes on.
class VideoFile {
 public:
  virtual ~VideoFile() = default;

  /// Adds what the images show.
  void add(ComparisonView& view);
  bool complete() const { return !said_.empty(); }
  /// Completes the file with the last image; `why` it ends before the video does.
  void finish(std::string_view why = "");
  /// What became of it, a sentence, and whether that is bad news.
  const std::string& said() const { return said_; }
  bool failed() const { return failed_; }

 protected:
  explicit VideoFile(const Comparison& comparison);
  using States = std::vector<const State*>;  // of each run
  /// Whether the file can go on with what the runs are now.
  virtual bool goes_on(const Comparison&) const { return true; }
  /// Errors: io; usage, the file cannot hold this state.
  virtual Status write(const Comparison& comparison, const States& states) = 0;
  virtual Status complete_with(const States& last,
                               const std::vector<std::optional<Divergence>>& divergences) = 0;
  virtual std::string path() const = 0;
  /// What it holds, after so many images.
  virtual std::string sentence(std::uint64_t images) const = 0;

 private:
  void fail(const Error& error);

  std::vector<std::uint64_t> models_;  // numbers of the runs' models
  std::vector<State> last_;            // of each run, in the file
  std::vector<std::optional<Divergence>> divergences_;
  std::uint64_t images_ = 0;
  std::string said_;
  bool failed_ = false;
};

/// A page for browsers of all runs as they are; `settings` have no command. A live page ends where a hand
/// pulls. Errors: io; of a live page also check_live(), usage: there are several runs.
Result<std::unique_ptr<VideoFile>> start_video_page(const std::string& path, ComparisonView& view,
                                                    page::PageSettings settings);
/// The states in a format of motions, of runs compared each in its own, numbered as aspic run --variant does.
/// Error (io).
Result<std::unique_ptr<VideoFile>> start_video_states(const std::string& path, const StateFormat& format,
                                                      const Comparison& comparison);

}  // namespace aspic::app

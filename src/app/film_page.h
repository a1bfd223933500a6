#pragma once
// A page for browsers that is written next to a film, from the same states.
#include <cstdint>
#include <string>
#include <vector>

#include "app/comparison_view.h"
#include "page/page_writer.h"

namespace aspic::app {

class FilmPage {
 public:
  /// Opens the file for all runs as they are. Error (io).
  static Result<FilmPage> start(const std::string& path, ComparisonView& view, double fps, double speed);

  /// Adds what the pictures show. It ends by itself, complete(), where a page cannot go on: the runs are
  /// others, or one has gone back in time.
  void add(ComparisonView& view);
  bool complete() const { return !said_.empty(); }
  /// Completes the file with the last picture.
  void finish();
  /// What became of it, a sentence, and whether that is bad news.
  const std::string& said() const { return said_; }
  bool failed() const { return failed_; }

 private:
  explicit FilmPage(page::PageWriter writer) : writer_(std::move(writer)) {}
  void fail(const Error& error);

  page::PageWriter writer_;
  std::vector<std::uint64_t> models_;  // numbers of the runs' models
  std::vector<State> last_;            // of each run, in the page
  std::vector<std::optional<Divergence>> divergences_;
  std::uint64_t pictures_ = 0;
  std::string said_;
  bool failed_ = false;
};

}  // namespace aspic::app

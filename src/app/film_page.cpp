#include "app/film_page.h"

#include <fmt/format.h>

#include <algorithm>

namespace aspic::app {
namespace {

std::vector<std::uint64_t> models_of(const Comparison& comparison) {
  std::vector<std::uint64_t> numbers;
  for (std::size_t i = 0; i < comparison.count(); ++i)
    numbers.push_back(comparison.run(i).present().model_number());
  return numbers;
}

}  // namespace

Result<FilmPage> FilmPage::start(const std::string& path, ComparisonView& view, double fps, double speed) {
  const Comparison& comparison = view.comparison();
  ASPIC_TRY(auto writer, page::PageWriter::create(path, Overwrite::refuse));
  FilmPage page(std::move(writer));
  std::vector<Scene> scenes;
  std::vector<page::PageRun> runs;
  for (std::size_t i = 0; i < comparison.count(); ++i) {
    // What the run was made of, not what the editor has since.
    scenes.push_back(comparison.scene(i));
    scenes.back().model = comparison.run(i).present().setup().settings;
  }
  for (std::size_t i = 0; i < comparison.count(); ++i)
    runs.push_back(
        {&scenes[i], &comparison.run(i).model(), comparison.active() ? view.name(i) : std::string()});
  ASPIC_CHECK(page.writer_.begin({.fps = fps, .speed = speed, .command = ""}, runs));
  page.models_ = models_of(comparison);
  page.last_.resize(comparison.count());
  page.divergences_.resize(comparison.count());
  return page;
}

void FilmPage::fail(const Error& error) {
  said_ = worded(error, FrontEnd::window);
  failed_ = true;
}

void FilmPage::add(ComparisonView& view) {
  const Comparison& comparison = view.comparison();
  if (complete()) return;
  // A page is of one setup: with another one it ends, and the film goes on.
  if (models_ != models_of(comparison)) return finish();
  std::vector<const State*> states;
  for (std::size_t i = 0; i < comparison.count(); ++i) {
    states.push_back(&view.picture(i).shown_state());
    if (pictures_ > 0 && states[i]->step < last_[i].step) return finish();
  }
  if (const Status added = writer_.add(states); !added) return fail(added.error());
  for (std::size_t i = 0; i < states.size(); ++i) {
    last_[i] = *states[i];
    divergences_[i] = comparison.shown_divergence(i);
  }
  ++pictures_;
}

void FilmPage::finish() {
  if (complete()) return;
  if (pictures_ == 0)
    return fail({ErrorCode::io, fmt::format("{} was not written: the film has no picture.", writer_.path())});
  std::vector<const State*> states;
  for (const State& state : last_) states.push_back(&state);
  if (const Status written = writer_.finish(states, divergences_); !written) return fail(written.error());
  said_ = fmt::format("{} holds the same {} pictures for browsers.", writer_.path(), pictures_);
}

}  // namespace aspic::app

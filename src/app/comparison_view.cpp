#include "app/comparison_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "model/integrator.h"
#include "scene/short_keys.h"
#include "variants/comparison.h"

namespace aspic::app {
namespace {

/// Differences that suggest themselves, those that are no difference left out.
std::vector<Difference> suggestions(const Scene& scene) {
  const bool stable = row_of(scene.model.simulation.integrator).traits.stable_at_any_step;
  std::vector<Difference> all = {{"integrator", stable ? "explicit-euler" : "implicit-euler"},
                                 {"h", fmt::format("{:g}", 0.5 * scene.model.simulation.timestep)}};
  if (const auto stiffness = present_value(scene, *find_short_key("k")))
    all.push_back({"k", fmt::format("{:g}", 4.0 * *stiffness)});
  all.push_back({"h", fmt::format("{:g}", 0.25 * scene.model.simulation.timestep)});
  return all;
}

std::string words_of(const Difference& difference) {
  return fmt::format("{} = {}", title_of(difference.key), difference.value);
}

}  // namespace

// ---- what is compared ----

void ComparisonView::add() {
  std::vector<Difference> differences = scene_.editor().differences();
  if (differences.size() + 1 >= most_compared)
    return messages_.refuse(fmt::format("Aspic compares at most {} runs. Close one first.", most_compared));
  for (const Difference& wanted : suggestions(scene_.scene())) {
    if (std::ranges::find(differences, wanted) != differences.end()) continue;
    differences.push_back(wanted);
    return scene_.set_differences(std::move(differences), "comparison with " + words_of(wanted));
  }
}

void ComparisonView::set(std::size_t i, const Difference& difference) {
  std::vector<Difference> differences = scene_.editor().differences();
  Difference& own = differences[i - 1];
  if (own == difference) return;
  if (const auto run = varied(scene_.scene(), asked_, std::span(&difference, 1)); !run)
    return messages_.error(run.error());
  own = difference;
  messages_.dismiss_error();
  scene_.set_differences(std::move(differences), "comparison with " + words_of(difference));
}

void ComparisonView::remove(std::size_t i) {
  std::vector<Difference> differences = scene_.editor().differences();
  differences.erase(differences.begin() + static_cast<std::ptrdiff_t>(i) - 1);
  scene_.set_differences(std::move(differences), "fewer runs compared");
}

void ComparisonView::leave() {
  if (!scene_.editor().differences().empty()) scene_.set_differences({}, "end of the comparison");
}

/// As if it had not been asked for.
void ComparisonView::refuse(const Difference& difference, const Error& why) {
  messages_.error(why);
  std::vector<Difference> rest = scene_.editor().differences();
  std::erase(rest, difference);
  scene_.set_differences(std::move(rest), "fewer runs compared");
}

Result<ComparisonView::Rendered> ComparisonView::rendered(std::size_t i) {
  Rendered made = {&comparison_.run(i), std::make_unique<SceneImage>(comparison_.run(i), comparison_.scene(i),
                                                                     view_, image_.full_quality)};
  ASPIC_CHECK(made.image->attach(*context_));
  return made;
}

void ComparisonView::match_editor() {
  if (comparison_.ghost() && ghost_source_ != scene_.editor().source()) remove_ghost();
  const std::vector<Difference> wanted = scene_.editor().differences();
  if (comparison_.differences() == wanted) return;
  const std::size_t before = comparison_.count();
  if (const auto refusal = comparison_.set(*context_, wanted))
    return refuse(refusal->difference, refusal->why);
  if (comparison_.count() < before) messages_.dismiss_refusal();
  std::vector<Rendered> next;
  for (std::size_t i = 1; i < comparison_.count(); ++i) {
    const auto known = std::ranges::find(images_, &comparison_.run(i), &Rendered::run);
    if (known != images_.end()) {
      next.push_back(std::move(*known));
    } else if (auto made = rendered(i)) {
      next.push_back(std::move(*made));
    } else {
      // Without an image there is no run.
      images_.clear();
      comparison_.end();
      return refuse(wanted[i - 1], made.error());
    }
  }
  images_ = std::move(next);
  if (!comparison_.several()) image_.keep(std::nullopt);
}

void ComparisonView::detach() {
  images_.clear();
  ghost_.reset();
  boxes_.clear();
  comparison_.end();
  comparison_.remove_ghost();
  image_.keep(std::nullopt);
  context_ = nullptr;
}

void ComparisonView::keep_ghost() {
  ghost_.reset();
  if (!messages_.check(comparison_.keep_ghost(*context_))) return;
  GhostRun& ghost = *comparison_.ghost();
  ghost_source_ = scene_.editor().source();
  ghost_ = std::make_unique<SceneImage>(ghost.simulation(), ghost.scene(), view_, image_.full_quality);
  ghost_->ghost = true;
  if (!messages_.check(ghost_->attach(*context_))) return remove_ghost();
  messages_.info(fmt::format(
      "This run is now the ghost, up to t = {:.3f} s. Change something and press Reset.", ghost.end()));
}

void ComparisonView::remove_ghost() {
  ghost_.reset();
  comparison_.remove_ghost();
  if (!comparison_.several()) image_.keep(std::nullopt);
}

bool ComparisonView::go_to(double time) {
  const auto gone = comparison_.clock().go_to(time);
  if (!gone) messages_.error(gone.error());
  if (gone && !*gone) return false;
  scene_.follow_history();
  return true;
}

// ---- images ----

std::string ComparisonView::name(std::size_t i) const {
  return short_name(i, comparison_.differences(), comparison_.scene(i),
                    std::string(comparison_.run(i).present().backend().title));
}

void ComparisonView::update() {
  for (const Error& message : comparison_.take_messages()) messages_.error(message);
  if (std::exchange(shown_number_, comparison_.shown_number()) == comparison_.shown_number()) return;
  for (std::size_t i = 0; i < comparison_.count(); ++i) image(i).keep(comparison_.run(i).snapshot());
  if (ghost_) ghost_->keep(comparison_.ghost()->simulation().snapshot());
}

void ComparisonView::place(const Box& whole) {
  const std::vector<Tile> tiles = tiles_of({std::max(static_cast<int>(whole.right - whole.left), 1),
                                            std::max(static_cast<int>(whole.bottom - whole.top), 1)},
                                           comparison_.count());
  boxes_.clear();
  for (const Tile& tile : tiles)
    boxes_.push_back({whole.left + tile.left, whole.top + tile.top, whole.left + tile.left + tile.width,
                      whole.top + tile.top + tile.height});
  if (!comparison_.active()) boxes_ = {whole};
  view_.whole = whole;
  view_.box = boxes_.front();
  view_.others.clear();
  for (std::size_t i = 1; i < comparison_.count(); ++i)
    view_.others.push_back({boxes_[i], image(i).offset()});
}

void ComparisonView::share_colors() {
  const bool active = comparison_.active();
  image_.common_range.reset();
  for (std::size_t i = 0; i < comparison_.count(); ++i)
    image(i).tint = active ? std::optional(run_tint(i)) : std::nullopt;
  const ViewSettings& view = comparison_.scene(0).view;
  if (!active || !has_scale(view.color)) return;
  QuantityRange range = image_.own_range();
  const auto shares = [&](std::size_t i) { return share_scale(comparison_.scene(i).view, view); };
  for (std::size_t i = 1; i < comparison_.count(); ++i)
    if (shares(i)) range = widest(range, image(i).own_range());
  image_.common_range = range;
  for (std::size_t i = 1; i < comparison_.count(); ++i)
    image(i).common_range = shares(i) ? std::optional(range) : std::nullopt;
}

bool ComparisonView::refining() const {
  return (ghost_ && ghost_->refining()) ||
         std::ranges::any_of(images_, [](const Rendered& p) { return p.image->refining(); });
}

Status ComparisonView::show(const WindowSize& window) {
  if (ghost_) {
    ghost_->shadows = false;
    ghost_->at_rest = image_.at_rest;
    ghost_->at_once = image_.at_once;
    ghost_->video.reset();
    if (image_.video) ghost_->video = VideoLook{image_.video->size};
    ASPIC_CHECK(ghost_->show(window, boxes_.front()));
  }
  for (std::size_t i = 1; i < comparison_.count(); ++i) {
    SceneImage& other = image(i);
    other.shadows = image_.shadows;
    other.full_quality = image_.full_quality;
    other.at_rest = image_.at_rest;
    other.at_once = image_.at_once;
    ASPIC_CHECK(other.show(window, boxes_[i]));
    if (const auto refusal = other.take_refusal()) messages_.error(*refusal);
  }
  return {};
}

}  // namespace aspic::app

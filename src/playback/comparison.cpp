#include "playback/comparison.h"

#include <fmt/format.h>

#include <algorithm>

namespace aspic {

// ---- the runs ----

std::vector<Difference> Comparison::differences() const {
  std::vector<Difference> all;
  for (const auto& variant : runs_.variants) all.push_back(variant->difference());
  return all;
}

std::optional<Comparison::Refusal> Comparison::set(gl::Context& context,
                                                   const std::vector<Difference>& differences) {
  if (this->differences() == differences) return std::nullopt;
  std::vector<std::unique_ptr<VariantRun>>& known = runs_.variants;
  std::vector<std::unique_ptr<VariantRun>> next(differences.size());
  // Which of the known runs each is; a difference may be there twice.
  std::vector<std::size_t> from(differences.size(), known.size());
  bool any_new = false;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    for (std::size_t k = 0; k < known.size() && from[i] == known.size(); ++k)
      if (known[k]->difference() == differences[i] && std::ranges::find(from, k) == from.end()) from[i] = k;
    if (from[i] < known.size()) continue;
    auto made = VariantRun::create(context, scene_, runs_.leader, asked_, differences[i]);
    if (!made) return Refusal{differences[i], made.error()};
    next[i] = std::move(*made);
    any_new = true;
  }
  for (std::size_t i = 0; i < differences.size(); ++i)
    if (!next[i]) next[i] = std::move(known[from[i]]);
  known = std::move(next);
  runs_changed();
  if (!any_new) return std::nullopt;
  if (const Status begun = runs_.leader.rebuild().reset(); !begun) messages_.push_back(begun.error());
  return std::nullopt;
}

void Comparison::end() {
  runs_.variants.clear();
  runs_changed();
}

void Comparison::runs_changed() {
  runs_.several = active() || ghost_;
  runs_.shown.clear();
  clock_.restart();
  if (several()) return;
  runs_.leader.pacer().limit(Hold::comparison, std::nullopt);
  runs_.settled = true;
}

bool Comparison::busy() const {
  return std::ranges::any_of(runs_.variants, [](const auto& v) { return v->simulation().busy(); });
}

std::optional<std::string> Comparison::hands_refused() const {
  for (const auto& variant : runs_.variants) {
    const Difference& difference = variant->difference();
    if (!variant->has_particles_of(runs_.leader))
      return fmt::format(
          "Pulls and pins apply to every run, but the run with {} = {} has different particles. Close the "
          "comparison first, or choose another difference.",
          title_of(difference.key), difference.value);
  }
  return std::nullopt;
}

// ---- the ghost ----

Status Comparison::keep_ghost(gl::Context& context) {
  remove_ghost();  // another gets what this one has
  ASPIC_CHECK(runs_.leader.halt(true));
  ASPIC_TRY(ghost_, GhostRun::create(context, scene_, runs_.leader, asked_));
  runs_.several = true;
  runs_.settled = false;
  runs_.shown.clear();
  return {};
}

void Comparison::remove_ghost() {
  ghost_.reset();
  runs_.several = active();
  if (!several()) runs_changed();
}

// ---- the clock ----

void Comparison::lead() {
  if (!several()) return;
  PlaybackSession& leader = runs_.leader;
  leader.pacer().limit(Hold::comparison, settled() ? std::nullopt : std::optional(leader.step()));
}

Status Comparison::follow(double dt, double budget) {
  if (!several()) return {};
  const PlaybackSession& leader = runs_.leader;
  VariantRun* const ahead = clock_.begin_frame(dt);
  const bool all_there = settled();
  runs_.settled = !leader.playback().seeking() && !leader.rebuild().changing();
  if (clock_.recalled()) return recall(*clock_.recalled(), dt, budget);
  const bool runs = clock_.others_run();
  if (ahead) ASPIC_CHECK(ahead->lead(leader.pacer(), runs, !all_there, dt, budget));
  for (const auto& variant : runs_.variants) {
    if (variant.get() == ahead) continue;
    ASPIC_CHECK(ahead ? variant->go_on_to(ahead->simulation().time(), !runs, dt, budget)
                      : variant->follow(scene_, leader, dt, budget));
    runs_.settled = settled() && variant->arrived();
    if (auto message = variant->take_message()) messages_.push_back(std::move(*message));
    if (auto message = variant->simulation().take_message()) messages_.push_back(std::move(*message));
  }
  return follow_with_ghost(ahead ? ahead->simulation().time() : leader.time(), dt, budget);
}

/// A time after the leader diverged, of all others.
Status Comparison::recall(double time, double dt, double budget) {
  for (const auto& variant : runs_.variants) {
    ASPIC_CHECK(variant->recall(time, dt, budget));
    runs_.settled = settled() && variant->arrived();
  }
  return follow_with_ghost(time, dt, budget);
}

Status Comparison::follow_with_ghost(double time, double dt, double budget) {
  if (ghost_) {
    ASPIC_CHECK(ghost_->follow(time, scene_.view, dt, budget));
    runs_.settled = settled() && ghost_->arrived();
  }
  if (settled()) show();
  return {};
}

/// The states of one time are those that are shown until the next ones are complete.
void Comparison::show() {
  std::vector<ShownState> now;
  std::vector<ShownState>& shown = runs_.shown;
  bool changed = shown.size() != count();
  for (std::size_t i = 0; i < count(); ++i) {
    now.push_back({run(i).present().image_number(), run(i).time(), run(i).divergence()});
    changed = changed || now[i].image != shown[i].image ||
              now[i].divergence.has_value() != shown[i].divergence.has_value();
  }
  const std::uint64_t of_ghost = ghost_ ? ghost_->simulation().present().image_number() : 0;
  if (!changed && of_ghost == ghost_shown_) return;
  Status read;
  for (std::size_t i = 0; read && i < count(); ++i) read = run(i).refresh_snapshot();
  if (read && ghost_) read = ghost_->simulation().refresh_snapshot();
  if (!read) return messages_.push_back(read.error());
  shown = std::move(now);
  ghost_shown_ = of_ghost;
  ++shown_number_;
}

}  // namespace aspic

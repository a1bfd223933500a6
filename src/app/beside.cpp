#include "app/beside.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>
#include <utility>

#include "model/integrator.h"
#include "scene/short_keys.h"

namespace aspic::app {
namespace {

/// Differences that suggest themselves, those that are no difference left out.
std::vector<Variation> suggestions(const Scene& scene) {
  const bool stable = row_of(scene.model.simulation.integrator).traits.stable_at_any_step;
  std::vector<Variation> all = {{"integrator", stable ? "explicit-euler" : "implicit-euler"},
                                {"h", fmt::format("{:g}", 0.5 * scene.model.simulation.timestep)}};
  if (const auto stiffness = present_value(scene, *find_short_key("k")))
    all.push_back({"k", fmt::format("{:g}", 4.0 * *stiffness)});
  all.push_back({"h", fmt::format("{:g}", 0.25 * scene.model.simulation.timestep)});
  return all;
}

std::string words_of(const Variation& variation) {
  return fmt::format("{} = {}", title_of(variation.key), variation.value);
}

}  // namespace

void Beside::detach() {
  companions_.clear();
  ghost_.reset();
  boxes_.clear();
  shown_.clear();
  picture_.release();
  leader_.pacer().limit(Hold::comparison, std::nullopt);
  context_ = nullptr;
}

std::string Beside::name(std::size_t i) const {
  std::vector<Variation> differences;
  for (const auto& companion : companions_) differences.push_back(companion->variation());
  return short_name(i, differences, i > 0 ? companions_[i - 1]->scene() : scene_.scene(),
                    std::string(run(i).present().backend().title));
}

// ---- what runs there are ----

void Beside::add() {
  std::vector<Variation> beside = scene_.editor().beside();
  if (beside.size() + 1 >= most_beside)
    return messages_.refuse(fmt::format("At most {} runs can be compared.", most_beside));
  for (const Variation& wanted : suggestions(scene_.scene())) {
    const auto same = [&](const Variation& v) { return v.key == wanted.key && v.value == wanted.value; };
    if (std::ranges::any_of(beside, same)) continue;
    beside.push_back(wanted);
    return scene_.set_beside(std::move(beside), "run beside: " + words_of(wanted));
  }
}

void Beside::set(std::size_t i, const Variation& variation) {
  std::vector<Variation> beside = scene_.editor().beside();
  Variation& own = beside[i - 1];
  if (own.key == variation.key && own.value == variation.value) return;
  if (const auto run = varied(scene_.scene(), asked_, std::span(&variation, 1)); !run)
    return messages_.error(run.error().message);
  own = variation;
  messages_.dismiss_error();
  scene_.set_beside(std::move(beside), "run beside: " + words_of(variation));
}

void Beside::remove(std::size_t i) {
  std::vector<Variation> beside = scene_.editor().beside();
  beside.erase(beside.begin() + static_cast<std::ptrdiff_t>(i) - 1);
  scene_.set_beside(std::move(beside), "fewer runs side by side");
}

void Beside::leave() {
  if (!scene_.editor().beside().empty()) scene_.set_beside({}, "one run alone");
}

/// Makes and ends runs until they are those of the editor. A new one begins at the start, and so all do.
void Beside::match_editor() {
  const std::vector<Variation>& wanted = scene_.editor().beside();
  const auto is = [](const auto& companion, const Variation& variation) {
    return companion && companion->variation().key == variation.key &&
           companion->variation().value == variation.value;
  };
  if (std::ranges::equal(companions_, wanted, is)) return;
  std::vector<std::unique_ptr<Companion>> next;
  bool any_new = false;
  for (const Variation& variation : wanted) {
    const auto known =
        std::ranges::find_if(companions_, [&](const auto& companion) { return is(companion, variation); });
    if (known != companions_.end()) {
      next.push_back(std::move(*known));
      continue;
    }
    auto made = Companion::create(*context_, scene_.scene(), leader_, view_, asked_, picture_.full_quality,
                                  variation);
    if (!made) {
      // As if it had not been asked for.
      messages_.error(made.error().message);
      std::vector<Variation> rest = wanted;
      std::erase_if(rest,
                    [&](const Variation& v) { return v.key == variation.key && v.value == variation.value; });
      companions_ = std::move(next);
      return scene_.set_beside(std::move(rest), "fewer runs side by side");
    }
    next.push_back(std::move(*made));
    any_new = true;
  }
  if (next.size() < companions_.size()) messages_.dismiss_refusal();
  companions_ = std::move(next);
  shown_.clear();
  others_run_ = false;
  if (any_new) messages_.check(leader_.rebuild().reset());
  if (!several()) end_waiting();
}

// ---- time ----

/// The first that did not diverge.
Companion* Beside::stand_in() const {
  const auto found = std::ranges::find_if(
      companions_, [](const auto& companion) { return !companion->simulation().divergence(); });
  return found == companions_.end() ? nullptr : found->get();
}

bool Beside::toggle() {
  if (!others_go_on()) return false;
  others_run_ = !others_run_;
  recalled_.reset();
  return true;
}

bool Beside::busy() const {
  return std::ranges::any_of(companions_, [](const auto& c) { return c->simulation().busy(); });
}

double Beside::clock_time() const {
  if (!several()) return leader_.time();
  const Simulation& setter = clock();
  for (std::size_t i = 0; i < count(); ++i)
    if (&run(i) == &setter) return shown_time(i);
  return leader_.time();
}

bool Beside::shows_clock() const {
  if (!several()) return true;
  if (!settled_ || shown_.size() != count()) return false;
  const Simulation& setter = clock();
  for (std::size_t i = 0; i < count(); ++i)
    if (&run(i) == &setter) return shown_[i].time == setter.time();
  return false;
}

void Beside::limit(Hold source, std::optional<std::uint64_t> step) {
  leader_.pacer().limit(source, std::nullopt);
  for (const auto& companion : companions_) companion->simulation().pacer().limit(source, std::nullopt);
  (others_go_on() ? stand_in()->simulation() : leader_).pacer().limit(source, step);
}

double Beside::end_time() const {
  const auto end_of = [](const Simulation& s) {
    return s.playback().history().time(s.playback().history().end_moment());
  };
  if (several() && clock_runs()) return clock_time();
  double end = end_of(leader_);
  if (!leader_.playback().ends_diverged()) return end;
  for (const auto& companion : companions_) end = std::max(end, end_of(companion->simulation()));
  return end;
}

bool Beside::go_to(double time) {
  const History& own = leader_.playback().history();
  const double last = own.time(own.end_moment());
  recalled_.reset();
  const bool beyond = time > last + 0.5 * leader_.model().simulation.timestep;
  if (!active() || !leader_.playback().ends_diverged() || !beyond || !(end_time() > last)) return false;
  // The window's own run stays at its end, or goes there.
  others_run_ = false;
  recalled_ = time;
  if (leader_.playback().here() != own.end_moment())
    messages_.check(leader_.playback().seek(own.end_moment()));
  scene_.follow_history();
  return true;
}

double Beside::figures_time() const {
  double limit = clock_time();
  for (std::size_t i = 0; i < count(); ++i) {
    const auto& energies = run(i).samples().energies();
    const double half = 0.5 * run(i).model().simulation.timestep;
    if (!run(i).divergence() && !energies.empty()) limit = std::min(limit, energies.back().time + half);
  }
  const auto& energies = clock().samples().energies();
  const auto after = std::ranges::upper_bound(energies, limit, {}, &EnergySample::time);
  return after == energies.begin() ? limit : std::prev(after)->time;
}

/// Of what was shown since the last measurement, where something was.
void Beside::measure_factor(double dt) {
  constexpr double window = 0.5;  // s
  const double now = clock_time();
  measured_for_ += dt;
  if (!clock_runs() || now < measured_from_) {
    factor_ = measured_for_ = 0.0;
    measured_from_ = now;
  } else if (measured_for_ > window && now > measured_from_) {
    factor_ = (now - measured_from_) / measured_for_;
    measured_for_ = 0.0;
    measured_from_ = now;
  }
}

std::optional<std::string> Beside::hands_refused() const {
  for (const auto& companion : companions_) {
    if (!companion->has_particles_of(leader_))
      return fmt::format(
          "Pulls and pins apply to every run, but the run with {} has different particles. Close the "
          "comparison first, or choose another difference.",
          words_of(companion->variation()));
  }
  return std::nullopt;
}

void Beside::lead() {
  match_editor();
  if (ghost_ && ghost_->source != scene_.editor().source()) remove_ghost();
  if (!several()) return;
  leader_.pacer().limit(Hold::comparison, settled_ ? std::nullopt : std::optional(leader_.step()));
}

Status Beside::follow(double dt, double budget) {
  if (!several()) return {};
  measure_factor(dt);
  Companion* const ahead = leader_.divergence() ? stand_in() : nullptr;
  // They go on where the window's own run did.
  if (ahead && was_running_) others_run_ = true;
  if (!ahead) others_run_ = false;
  was_running_ = leader_.running();
  const bool all_there = settled_;
  settled_ = !leader_.playback().seeking() && !leader_.rebuild().changing();
  if (!leader_.divergence() && !leader_.playback().seeking()) recalled_.reset();
  if (recalled_) return recall(*recalled_, dt, budget);
  if (ahead) ASPIC_CHECK(ahead->lead(leader_.pacer(), others_run_, !all_there, dt, budget));
  for (const auto& companion : companions_) {
    if (companion.get() == ahead) continue;
    ASPIC_CHECK(ahead ? companion->go_on_to(ahead->simulation().time(), !others_run_, dt, budget)
                      : companion->follow(scene_.scene(), leader_, dt, budget));
    settled_ = settled_ && companion->arrived();
    if (const auto message = companion->take_message()) messages_.error(*message);
    if (const auto message = companion->simulation().take_message()) messages_.error(*message);
  }
  if (ghost_) ASPIC_CHECK(follow_with_ghost(ahead ? ahead->simulation().time() : leader_.time(), dt, budget));
  if (settled_) keep_shown();
  return {};
}

/// A time after the window's own run diverged, of all others.
Status Beside::recall(double time, double dt, double budget) {
  for (const auto& companion : companions_) {
    ASPIC_CHECK(companion->recall(time, dt, budget));
    settled_ = settled_ && companion->arrived();
  }
  if (ghost_) ASPIC_CHECK(follow_with_ghost(time, dt, budget));
  if (settled_) keep_shown();
  return {};
}

// ---- what is shown ----

void Beside::end_waiting() {
  picture_.release();
  leader_.pacer().limit(Hold::comparison, std::nullopt);
  settled_ = true;
}

/// The states of one time are those that are shown until the next ones are complete.
void Beside::keep_shown() {
  std::vector<Shown> now;
  bool changed = shown_.size() != count();
  for (std::size_t i = 0; i < count(); ++i) {
    now.push_back({run(i).present().picture_number(), run(i).time(), run(i).divergence()});
    changed = changed || now[i].picture != shown_[i].picture ||
              now[i].divergence.has_value() != shown_[i].divergence.has_value();
  }
  if (ghost_) changed = changed || ghost_->shown != ghost_->simulation->present().picture_number();
  if (!changed) return;
  if (!messages_.check(leader_.refresh_snapshot())) return;
  picture_.keep(leader_.snapshot());
  for (const auto& companion : companions_) {
    if (!messages_.check(companion->simulation().refresh_snapshot())) return;
    companion->picture().keep(companion->simulation().snapshot());
  }
  if (ghost_) {
    if (!messages_.check(ghost_->simulation->refresh_snapshot())) return;
    ghost_->picture->keep(ghost_->simulation->snapshot());
    ghost_->shown = ghost_->simulation->present().picture_number();
  }
  shown_ = std::move(now);
}

// ---- pictures ----

void Beside::place(const Box& whole) {
  const std::vector<Tile> tiles = tiles_of({std::max(static_cast<int>(whole.right - whole.left), 1),
                                            std::max(static_cast<int>(whole.bottom - whole.top), 1)},
                                           count());
  boxes_.clear();
  for (const Tile& tile : tiles)
    boxes_.push_back({whole.left + tile.left, whole.top + tile.top, whole.left + tile.left + tile.width,
                      whole.top + tile.top + tile.height});
  if (!active()) boxes_ = {whole};
  view_.whole = whole;
  view_.box = boxes_.front();
  view_.others.clear();
  for (std::size_t i = 0; i < companions_.size(); ++i)
    view_.others.push_back({boxes_[i + 1], companions_[i]->picture().offset()});
}

void Beside::share_colours() {
  picture_.common_range.reset();
  // A film without names shows each run as it would be alone.
  const bool marked = active() && !(picture_.film && !picture_.film->text);
  for (std::size_t i = 0; i < count(); ++i)
    picture(i).tint = marked ? std::optional(run_tint(i)) : std::nullopt;
  const ViewSettings& view = scene_.scene().view;
  if (!active() || !has_scale(view.colour)) return;
  QuantityRange range = picture_.own_range();
  const auto shares = [&](const auto& companion) { return share_scale(companion->scene().view, view); };
  for (const auto& companion : companions_)
    if (shares(companion)) range = widest(range, companion->picture().own_range());
  picture_.common_range = range;
  for (const auto& companion : companions_)
    companion->picture().common_range = shares(companion) ? std::optional(range) : std::nullopt;
}

bool Beside::refining() const {
  return (ghost_ && ghost_->picture->refining()) ||
         std::ranges::any_of(companions_, [](const auto& c) { return c->picture().refining(); });
}

Status Beside::show(const WindowSize& window) {
  if (ghost_) {
    ghost_->picture->shadows = false;
    ghost_->picture->set_at_rest(picture_.at_rest(), picture_.at_once());
    ASPIC_CHECK(ghost_->picture->show(window, boxes_.front()));
  }
  for (std::size_t i = 0; i < companions_.size(); ++i) {
    ScenePicture& picture = companions_[i]->picture();
    picture.shadows = picture_.shadows;
    picture.full_quality = picture_.full_quality;
    picture.set_at_rest(picture_.at_rest(), picture_.at_once());
    ASPIC_CHECK(picture.show(window, boxes_[i + 1]));
    if (const auto refusal = picture.take_refusal()) messages_.error(*refusal);
  }
  return {};
}

}  // namespace aspic::app

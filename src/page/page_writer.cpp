#include "page/page_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "aspic/version.h"
#include "base/base64.h"
#include "base/printable.h"
#include "io/frame_schedule.h"
#include "model/counts.h"
#include "page/document.h"
#include "page/facts.h"
#include "page/live_facts.h"

namespace aspic::page {
namespace {

/// Six digits: a plot's pixels tell no more apart.
double rounded(double value) {
  return value == 0.0 ? 0.0 : std::stod(fmt::format("{:.6g}", value));
}

Json rounded_list(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(rounded(value));
  return list;
}

}  // namespace

Status check_page(std::uint64_t images, std::uint64_t positions_each, double fps, bool live) {
  if (live) positions_each *= 2;
  if (positions_each == 0 || images <= most_positions / positions_each) return {};
  const double share =
      static_cast<double>(most_positions) / static_cast<double>(positions_each) / static_cast<double>(images);
  const double fitting = fps * share >= 1.0 ? std::floor(fps * share) : rounded(0.9 * fps * share);
  return advised(fail(ErrorCode::usage,
                      "a page of {} frames of {} particles and balls would hold {:.0f} million positions{}, "
                      "and a browser holds {} million.",
                      images, live ? positions_each / 2 : positions_each,
                      static_cast<double>(images) * static_cast<double>(positions_each) * 1e-6,
                      live ? " and velocities" : "", most_positions / 1000000),
                 {{RemedyKind::lower_fps, {fmt::format("{:g}", fitting)}},
                  {RemedyKind::shorten},
                  advice("use fewer particles")});
}

Status check_page_name(const std::string& path) {
  if (path == "-")
    return fail(ErrorCode::usage,
                "a page named - would be a file of that name: write /dev/stdout for standard output.");
  const std::string ending = ending_of(path);
  if (ending.empty() || ending == ".html" || ending == ".htm" || is_device_or_pipe(path)) return {};
  return fail(ErrorCode::usage, "the page's name {} must end in .html.", printable_line(path));
}

Result<PageWriter> PageWriter::create(const std::string& path, Overwrite overwrite) {
  ASPIC_TRY(auto file, AtomicFile::create(path, overwrite));
  ASPIC_TRY(auto deflater, Deflater::create());
  return PageWriter(std::move(file), std::move(deflater));
}

Status PageWriter::write(std::string_view text) {
  characters_ += text.size();
  if (characters_ > most_characters || positions_ > most_positions)
    return fail(ErrorCode::io,
                "{} would exceed {} or {} million positions, which is slow in browsers. The page is "
                "incomplete: use fewer frames per second, less time, or fewer particles.",
                printable_line(path()), human_bytes(most_characters), most_positions / 1000000);
  return file_.write(text);
}

Status PageWriter::pack(const Result<std::string>& bytes, bool last) {
  if (!bytes) return bytes.error();
  rest_ += *bytes;
  const std::size_t size = last ? rest_.size() : rest_.size() / 3 * 3;
  ASPIC_CHECK(write(base64(std::string_view(rest_).substr(0, size))));
  rest_.erase(0, size);
  return {};
}

Status PageWriter::begin(const PageSettings& settings, std::span<const PageRun> runs) {
  const Scene& scene = *runs.front().scene;
  Json facts = {{"program", "aspic " ASPIC_VERSION},
                {"title", printable_line(scene.name)},
                {"author", scene.author ? printable_line(*scene.author) : ""},
                {"command", settings.command},
                {"fps", settings.fps},
                {"speed", settings.speed},
                {"view", view_facts(scene)},
                {"runs", Json::array()}};
  if (settings.live) {
    ASPIC_TRY(module_, live_module());
    facts["live"] = live_facts(scene);
    if (settings.last_step) facts["live"]["lastStep"] = *settings.last_step;
  }
  std::string bytes;
  for (const PageRun& run : runs) {
    const Model& model = *run.model;
    facts["runs"].push_back(run_facts(*run.scene, model, run.name, models_.size()));
    append_shapes(model, bytes);
    const Quanta quanta = quanta_of(model);
    tracks_.push_back({Track(model.particle_count(), quanta.position),
                       Track(model.ball_count(), quanta.ball_position),
                       Track(model.ball_count(), quanta.spin),
                       Track(change_vectors(model), quanta.change),
                       {},
                       {},
                       {},
                       {},
                       {},
                       {},
                       {},
                       Meter(model)});
    models_.push_back(&model);
  }
  ASPIC_CHECK(write(document_head(printable_line(scene.name), facts, settings.live)));
  return pack(deflater_.add(bytes), false);
}

Status PageWriter::add(std::span<const State* const> states, std::span<const Inputs> inputs) {
  bool went_on = false;
  for (std::size_t i = 0; i < states.size(); ++i)
    went_on = went_on || tracks_[i].steps.empty() || tracks_[i].steps.back() != states[i]->step;
  if (!went_on) return {};
  if (!module_.empty()) return add_live(*states.front());
  std::string bytes;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const State& state = *states[i];
    positions_ += state.position.size() + state.ball_position.size();
    Tracks& tracks = tracks_[i];
    const Inputs holding = i < inputs.size() ? inputs[i] : Inputs();
    const Measures m = tracks.meter.measure(state, holding);
    if (const auto bad = first_not_finite(m))
      return fail(ErrorCode::diverged, "{}: {} of step {} is not a finite number.", printable_line(path()),
                  *bad, state.step);
    tracks.kinetic.push_back(m.kinetic);
    tracks.elastic.push_back(m.elastic);
    tracks.gravitational.push_back(m.gravitational);
    if (const auto work = tracks.actuators.add(*models_[i], state, holding)) tracks.work.push_back(*work);
    tracks.steps.push_back(state.step);
    tracks.particles.append(state.position, bytes);
    tracks.balls.append(state.ball_position, bytes);
    tracks.spins.append(state.ball_angular_velocity, bytes);
    if (!models_[i]->actuation.empty())
      tracks.changes.append(changes_of(*models_[i], state.step, holding.channels), bytes);
  }
  return pack(deflater_.add(bytes), false);
}

/// A live page compares hashes; a start that is not the scene's it has to the bit.
Status PageWriter::add_live(const State& state) {
  Tracks& tracks = tracks_.front();
  std::string bytes;
  if (tracks.steps.empty() &&
      state_hash(state) != state_hash(initial_state(*models_.front(), state.precision))) {
    starts_ = true;
    for (const StateField& field : state_fields)
      for (const Vec3& v : state.*field.vectors)
        for (const double component : {v.x, v.y, v.z}) {
          const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(component));
          for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>(bits >> (8 * byte) & 255u);
        }
  }
  tracks.steps.push_back(state.step);
  tracks.hashes.push_back(state_hash_text(state));
  return pack(deflater_.add(bytes), false);
}

Status PageWriter::finish(std::span<const State* const> states,
                          std::span<const std::optional<Divergence>> divergences) {
  ASPIC_CHECK(pack(deflater_.finish(), true));
  Json ends = Json::array();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Tracks& tracks = tracks_[i];
    Json end = {{"hash", state_hash_text(*states[i])},
                {"precision", name_of(states[i]->precision)},
                {"steps", tracks.steps}};
    if (module_.empty()) {
      end["kinetic"] = rounded_list(tracks.kinetic);
      end["elastic"] = rounded_list(tracks.elastic);
      end["gravitational"] = rounded_list(tracks.gravitational);
      if (!tracks.work.empty()) end["work"] = rounded_list(tracks.work);
    } else {
      end["hashes"] = tracks.hashes;
      end["starts"] = starts_;
    }
    if (divergences[i])
      end["diverged"] = fmt::format("diverged in step {}: {} {}", divergences[i]->step,
                                    body_text(*divergences[i]), fault_text(*divergences[i]));
    ends.push_back(std::move(end));
  }
  ASPIC_CHECK(write(document_tail(ends, module_)));
  return file_.commit();
}

namespace {

/// The images of one run, at the steps that a video of it would show.
class PageSink final : public StateSink {
 public:
  PageSink(PageWriter writer, const Scene& scene, PageSettings settings, const FrameSchedule& schedule)
      : StateSink(writer.path(), 0),
        writer_(std::move(writer)),
        scene_(scene),
        settings_(std::move(settings)),
        schedule_(schedule) {}

  std::uint64_t next_step(std::uint64_t step) const override {
    for (std::uint64_t frame = frame_; frame < schedule_.count(); ++frame)
      if (schedule_.step_of(frame) > step) return schedule_.step_of(frame);
    return std::numeric_limits<std::uint64_t>::max();
  }
  Status take(const Sample& sample) override {
    if (!writer_.begun()) {
      const PageRun run = {&scene_, &sample.model};
      ASPIC_CHECK(writer_.begin(settings_, {&run, 1}));
    }
    while (frame_ < schedule_.count() && schedule_.step_of(frame_) <= sample.state.step) ++frame_;
    const State* const state = &sample.state;
    const Inputs inputs = inputs_of(sample);
    return writer_.add({&state, 1}, {&inputs, 1});
  }
  Status finish(const Sample& last) override {
    ASPIC_CHECK(take(last));
    const State* const state = &last.state;
    const std::optional<Divergence> divergence =
        last.divergence ? std::optional(*last.divergence) : std::nullopt;
    return writer_.finish({&state, 1}, {&divergence, 1});
  }

 private:
  PageWriter writer_;
  Scene scene_;
  PageSettings settings_;
  FrameSchedule schedule_;
  std::uint64_t frame_ = 0;  // the first that was not taken
};

}  // namespace

Result<std::unique_ptr<StateSink>> open_page(const std::string& path, Overwrite overwrite, const Scene& scene,
                                             const PageSettings& settings, std::uint64_t first_step,
                                             std::uint64_t last_step) {
  const FrameSchedule schedule(scene.model.simulation.timestep, first_step, last_step, settings.fps,
                               settings.speed);
  const ModelCounts counts = predict_counts(scene.model);
  ASPIC_CHECK(check_page(std::min(schedule.count(), last_step - first_step + 1),
                         counts.particles + counts.balls, settings.fps, settings.live));
  ASPIC_TRY(auto writer, PageWriter::create(path, overwrite));
  PageSettings planned = settings;
  planned.last_step = last_step;
  return std::unique_ptr<StateSink>(std::make_unique<PageSink>(std::move(writer), scene, planned, schedule));
}

}  // namespace aspic::page

// What a page calls of the WebAssembly module (src/page/web/live_worker.js). Text goes in through text() and
// comes out through answer(); there is one run. A return value of 0 is success; else answer() says why not.
#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "live/live_run.h"
#include "model/model.h"

#define ASPIC_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace aspic::live {
namespace {

std::string given, said;
std::vector<double> channels;
std::optional<LiveRun> run;

int done(const Status& status) {
  if (status) return 0;
  said = status.error().message();
  return 1;
}

/// What of the model a page draws and colors by, as JSON.
std::string facts() {
  const Model& model = run->model();
  std::string classes, radii;
  for (const SpringClass& s : model.spring_classes)
    classes += fmt::format("{}[{},{},{}]", classes.empty() ? "" : ",", s.stiffness, s.damping, s.rest_length);
  for (const Ball& ball : model.balls) radii += fmt::format("{}{}", radii.empty() ? "" : ",", ball.radius);
  return fmt::format(R"({{"particles":{},"balls":{},"timestep":{},"classes":[{}],"radii":[{}]}})",
                     model.particle_count(), model.ball_count(), model.simulation.timestep, classes, radii);
}

}  // namespace

/// Room for text of so many bytes, which create() or change() reads.
ASPIC_EXPORT(text) char* text(std::size_t size) {
  given.assign(size, ' ');
  return given.data();
}
ASPIC_EXPORT(answer) const char* answer() {
  return said.data();
}
ASPIC_EXPORT(answer_size) std::size_t answer_size() {
  return said.size();
}

/// Room for so many channels of the inputs, which change() reads.
ASPIC_EXPORT(inputs) double* inputs(std::size_t count) {
  channels.assign(count, 0.0);
  return channels.data();
}

/// LiveRun::create() and change(); the answer is facts().
ASPIC_EXPORT(create) int create() {
  run.reset();
  auto made = LiveRun::create(given);
  if (!made) return done(made.error());
  run.emplace(std::move(*made));
  said = facts();
  return 0;
}
ASPIC_EXPORT(change) int change() {
  if (const Status changed = run->change(given, channels); !changed) return done(changed);
  said = facts();
  return 0;
}

/// 2: it diverged, and the answer says how.
ASPIC_EXPORT(advance) int advance(double steps) {
  const auto advanced = run->advance(static_cast<std::uint64_t>(steps));
  if (!advanced) return done(advanced.error());
  const auto& divergence = advanced->divergence;
  if (!divergence) return 0;
  said = fmt::format("diverged in step {}: {} {}", divergence->step, body_text(*divergence),
                     fault_text(*divergence));
  return 2;
}

/// LiveRun::take(); the answer is what it measured, as JSON.
ASPIC_EXPORT(take) int take() {
  if (const Status taken = run->take(); !taken) return done(taken);
  const Measures& m = run->measures();
  const std::string work = run->work() ? fmt::format(R"("work":{},)", *run->work()) : "";
  said = fmt::format(
      R"({{"step":{},"hash":"{}","kinetic":{},"elastic":{},"gravitational":{},{}"changes":[{}]}})",
      run->step(), run->hash(), m.kinetic, m.elastic, m.gravitational, work, fmt::join(run->changes(), ","));
  return 0;
}
ASPIC_EXPORT(numbers) float* numbers() {
  return run->numbers().data();
}
ASPIC_EXPORT(load) int load(double step) {
  return done(run->load(static_cast<std::uint64_t>(step)));
}

}  // namespace aspic::live

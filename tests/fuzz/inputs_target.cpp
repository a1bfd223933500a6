// Input logs, for a cube, a cloth and balls.
#include <string>

#include "aspic/scene.h"
#include "fuzz/targets.h"
#include "model/inputs.h"
#include "model/model.h"

namespace aspic::fuzz {
namespace {

struct Subject {
  ModelSettings settings;
  Model model;
};

const Subject& subject() {
  static const Subject made = [] {
    Subject s;
    s.settings.cubes.resize(1);
    s.settings.cubes[0].particles_per_edge = 3;
    s.settings.cubes[0].pinned.names = {"top"};
    s.settings.cloths.resize(1);
    s.settings.cloths[0].particles = {4, 3};
    s.settings.balls.resize(2);
    s.model = *build_model(s.settings);
    return s;
  }();
  return made;
}

/// An accepted log can be given to a solver in double precision, and is written and read as the same.
void run(std::string_view text) {
  const LoggedRun run = {subject().settings, subject().model};
  const auto read = parse_inputs(text, "fuzz.toml", run);
  if (!read) return require_message(read.error(), {ErrorCode::scene_rejected});
  require(check_log(run.model, *read, Precision::double_).ok(), "an accepted log is one for its model");
  const auto again = parse_inputs(to_toml(*read, run.settings.simulation.timestep), "written.toml", run);
  require(again.ok(), again.ok() ? "" : "a log that was written is accepted: " + again.error().message());
  require(*again == *read && again->hash() == read->hash(), "a log that was written reads back as the same");
}

std::vector<std::string> seeds() {
  return {
      "[[inputs]]\nstep = 0\npulls = [{ particle = 3, anchor = [1, 2.5, -3e-8], stiffness = 900, damping = "
      "20 }, { ball = 1, anchor = [0, 1, 0], stiffness = 0.1 }]\n[[inputs]]\nstep = 7\n",
      "timestep = 0.002\n[[inputs]]\nstep = 10\npinned = [0, \"cloth[0].left\"]\nreleased = "
      "[\"cube[0].top\"]\n[[inputs]]\nstep = 20\nchannels = [0.5, 1e300, -1]\n"};
}

std::vector<std::string> words() {
  return {"[[inputs]]\n",
          "step = ",
          "pulls = [",
          "particle = ",
          "ball = ",
          "anchor = [",
          "stiffness = ",
          "damping = ",
          "pinned = [",
          "released = ",
          "channels = [",
          "timestep = ",
          "\"cube[0].top\"",
          "\"cloth[0].left-top\"",
          "inf",
          "nan",
          "1e308",
          "4.9e-324",
          "9223372036854775807"};
}

}  // namespace

const Target inputs_target = {"inputs", run, seeds, words};

}  // namespace aspic::fuzz

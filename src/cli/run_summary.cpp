#include "cli/run_summary.h"

#include <fmt/format.h>

#include "analysis/stability.h"
#include "aspic/analysis.h"
#include "base/shell_word.h"
#include "io/console.h"
#include "model/springs.h"

namespace aspic::cli {
namespace {

Json to_json(const SolveStatistics& s) {
  return {{"converged", s.converged},         {"stagnated", s.stagnated},
          {"not_converged", s.not_converged}, {"newton_iterations", s.newton_iterations},
          {"cg_iterations", s.cg_iterations}, {"worst_residual", s.worst_residual}};
}

Json to_json(const Divergence& d, double timestep) {
  Json json = {{"step", d.step}, {"time", static_cast<double>(d.step) * timestep}};
  if (d.residual) {
    json["residual"] = true;
  } else {
    json[d.ball ? "ball" : "particle"] = d.particle;
  }
  json["finite"] = d.finite;
  return json;
}

}  // namespace

Json to_json(const RunReport& run) {
  const auto& [scene, model, backend, outcome, inputs] = run;
  const State& state = outcome.state;
  const Measures m = measure(model, state, inputs.at(state.step));
  const double time = static_cast<double>(state.step) * model.simulation.timestep;
  const std::string hash = state_hash_text(state);
  // Not within the list: g++ 12 destroys what it has not made yet when memory runs out in a list with `?:`.
  const Json diverged = outcome.divergence ? to_json(*outcome.divergence, model.simulation.timestep) : Json();
  const Json logged =
      inputs.empty() ? Json() : Json{{"entries", inputs.entries().size()}, {"hash", inputs.hash_text()}};
  const Json solves = outcome.solves ? to_json(*outcome.solves) : Json();
  Json energies = {{"kinetic", m.kinetic},
                   {"elastic", m.elastic},
                   {"gravitational", m.gravitational},
                   {"total", m.total()}};
  if (m.contact) energies["contact"] = *m.contact;
  if (outcome.actuator_work) energies["actuator_work"] = *outcome.actuator_work;
  return {
      {"scene", scene.name},
      {"backend", backend.row->name},
      {"backend_reason", or_null(backend.reason)},
      {"device", backend.device},
      {"precision", name_of(state.precision)},
      {"force_path", or_null(backend.force_path)},
      {"arithmetic", name_of(backend.arithmetic)},
      {"integrator", name_of(model.simulation.integrator)},
      {"timestep", model.simulation.timestep},
      {"particles", model.particle_count()},
      {"springs", spring_count(model)},
      {"balls", model.ball_count()},
      {"first_step", outcome.first_step},
      {"steps", state.step},
      {"time", time},
      {"wall_seconds", outcome.wall_seconds},
      {"steps_per_second", outcome.steps_per_second()},
      {"state_hash", hash},
      {"inputs", logged},
      {"diverged", diverged},
      {"interrupted", outcome.interrupted},
      {"implicit_solves", solves},
      {"diagnostics", to_json(outcome.diagnostics)},
      {"energies", energies},
      {"momentum", Json{m.momentum.x, m.momentum.y, m.momentum.z}},
      {"max_speed", m.max_speed},
      {"min_height", m.min_height},
  };
}

Json to_json(const std::vector<Diagnostic>& diagnostics) {
  Json all = Json::array();
  for (const Diagnostic& d : diagnostics)
    all.push_back(
        {{"id", d.id}, {"where", d.where}, {"step", d.step}, {"text", d.text}, {"advice", d.advice}});
  return all;
}

std::string export_text(const std::vector<Diagnostic>& diagnostics) {
  if (diagnostics.empty()) return "";
  Json all = Json::array();
  for (const Diagnostic& d : diagnostics)
    all.push_back({{"kind", d.id}, {"body", d.where}, {"step", d.step}, {"text", d.sentence()}});
  return all.dump(-1, ' ', true, Json::error_handler_t::replace);
}

std::string to_text(const RunReport& run) {
  const auto& [scene, model, backend, outcome, inputs] = run;
  const State& state = outcome.state;
  const Measures m = measure(model, state, inputs.at(state.step));
  const double time = static_cast<double>(state.step) * model.simulation.timestep;
  std::string text = fmt::format("scene        {} ({} particles, {} springs{})\n", scene.name,
                                 model.particle_count(), spring_count(model),
                                 model.ball_count() > 0 ? fmt::format(", {} ball{}", model.ball_count(),
                                                                      model.ball_count() > 1 ? "s" : "")
                                                        : "");
  text += fmt::format("backend      {}{}, {} precision{}\n", backend.row->name,
                      backend.force_path.empty() ? "" : ", force path " + backend.force_path,
                      name_of(state.precision),
                      backend.reason.empty() ? "" : fmt::format(" (auto: {})", backend.reason));
  text += fmt::format("device       {}\n", backend.device);
  text += fmt::format("integrator   {}, time step {} s\n", name_of(model.simulation.integrator),
                      model.simulation.timestep);
  text += fmt::format("reached      step {} of {}, t = {:.6g} s\n", state.step, outcome.last_step, time);
  text += fmt::format("took         {:.3g} s, {:.4g} steps/s\n", outcome.wall_seconds,
                      outcome.steps_per_second());
  text += fmt::format(
      "energy       kinetic {:.6g} J, elastic {:.6g} J{}, gravitational {:.6g} J, total {:.6g} J\n",
      m.kinetic, m.elastic, m.contact ? fmt::format(" ({:.3g} J of contact)", *m.contact) : "",
      m.gravitational, m.total());
  if (outcome.actuator_work)
    text += fmt::format("actuators    work {:.6g} J (integrated over the series)\n", *outcome.actuator_work);
  text += fmt::format("extremes     fastest {:.6g} m/s, lowest y = {:.6g} m\n", m.max_speed, m.min_height);
  if (outcome.solves) {
    const SolveStatistics& s = *outcome.solves;
    text += fmt::format(
        "solves       {} converged, {} stagnated, {} not converged; worst residual {:.3g} m/s; {} Newton and "
        "{} conjugate gradient iterations\n",
        s.converged, s.stagnated, s.not_converged, s.worst_residual, s.newton_iterations, s.cg_iterations);
  }
  if (!inputs.empty()) {
    text += fmt::format("inputs       {} {}, hash {}\n", inputs.entries().size(),
                        inputs.entries().size() == 1 ? "entry" : "entries", inputs.hash_text());
  }
  text += fmt::format("state hash   {}\n", state_hash_text(state));
  return text;
}

Json to_json(const FrameTimes& t, const std::string& device) {
  return {{"count", t.frames},
          {"device", device},
          {"seconds_per_frame",
           {{"simulate", t.per_frame(t.simulate)},
            {"draw", t.per_frame(t.draw)},
            {"read", t.per_frame(t.read)},
            {"encode", t.per_frame(t.encode)}}}};
}

void print_frame_times(const FrameTimes& t, const std::string& device) {
  const auto ms = [&](double seconds) { return 1000.0 * t.per_frame(seconds); };
  print_message(fmt::format(
      "{} frame{} on {}; per frame: simulate {:.1f} ms, draw {:.1f} ms, read {:.1f} ms, encode {:.1f} ms.",
      t.frames, t.frames == 1 ? "" : "s", device, ms(t.simulate), ms(t.draw), ms(t.read), ms(t.encode)));
}

std::string command_of(const std::vector<std::string>& words) {
  std::string command = "aspic run";
  for (const std::string& word : words) command += " " + shell_word(word);
  return command;
}

void warn_if_unstable(const Model& model, const InterruptGuard& interrupt, const std::string& of) {
  const std::string found = unstable_step_warning(model, [&](double) { return !interrupt.interrupted(); });
  if (!interrupt.interrupted() && !found.empty()) print_warning(of + found);
}

Error divergence_error(const Model& model, const Outcome& outcome, const InterruptGuard& interrupt,
                       const std::string& of) {
  const Divergence& d = *outcome.divergence;
  const StabilityLimit stable = stability_limit(model, model.simulation.integrator, StabilityEffort::quick,
                                                [&](double) { return !interrupt.interrupted(); });
  const double h = model.simulation.timestep;
  return fail(ErrorCode::diverged,
              "{} diverged in step {} (t = {:.6g} s): {} {}. {} The last good step is {}; every output holds "
              "that state.",
              of, d.step, static_cast<double>(d.step) * h, body_text(d), fault_text(d),
              divergence_sentence(h, model.simulation.integrator, stable), outcome.state.step);
}

}  // namespace aspic::cli

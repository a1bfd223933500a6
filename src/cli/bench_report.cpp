#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <thread>
#include <utility>

#include "aspic/version.h"
#include "cli/bench.h"
#include "io/machine.h"

namespace aspic::cli {
namespace {

Json machine() {
  return {{"processor", or_null(processor_name())},
          {"cores", std::thread::hardware_concurrency()},
          {"memory_bytes", memory_bytes()}};
}

Json check_json(const PeerCheck& check) {
  return {{"passed", check.passed}, {"steps", check.steps}, {"deviation", check.deviation},
          {"bound", check.bound},   {"fall", check.fall},   {"fall_bound", check.fall_bound}};
}

Json row_json(const Measurement& m) {
  Json object = {{"name", m.name},
                 {"backend", m.backend},
                 {"force_path", or_null(m.force_path)},
                 {"arithmetic", m.peer ? Json() : Json(name_of(m.arithmetic))},
                 {"renderer", m.device},
                 {"check", m.peer ? check_json(*m.peer) : Json()},
                 {"integrator", name_of(m.integrator)},
                 {"size", m.size},
                 {"particles", m.particles},
                 {"springs", m.springs},
                 {"bytes", or_null(m.bytes)},
                 {"timestep", m.timestep},
                 {"steps", m.steps},
                 {"diverged", m.divergence.has_value()}};
  if (!m.counts()) return object;
  object.update({{"fastest_seconds", m.quantile(0.0)},
                 {"lower_quartile_seconds", m.quantile(0.25)},
                 {"median_seconds", m.median()},
                 {"upper_quartile_seconds", m.quantile(0.75)},
                 {"slowest_seconds", m.quantile(1.0)},
                 {"spread", m.spread()},
                 {"processors", m.processors()},
                 {"steps_per_second", m.steps_per_second()},
                 {"milliseconds_per_step", m.milliseconds_per_step()},
                 {"kernel_milliseconds_per_step", or_null(m.kernel_milliseconds_per_step())},
                 {"evaluations_per_step", m.evaluations_per_step},
                 {"spring_evaluations_per_second", m.spring_evaluations_per_second()},
                 {"seconds_per_simulated_second", m.seconds_per_simulated_second()},
                 {"growth", or_null(m.growth)},
                 {"ratio", or_null(m.ratio)},
                 {"processor_ratio", or_null(m.processor_ratio)}});
  Json seconds = Json::array(), processor_seconds = Json::array();
  for (const Took& took : m.repeats) {
    seconds.push_back(took.seconds);
    processor_seconds.push_back(took.processor_seconds);
  }
  object["seconds"] = seconds;
  object["processor_seconds"] = processor_seconds;
  // null: this backend does not say; a device's passes are told apart by its time stamps.
  Json passes = m.passes.empty() ? Json() : Json::array();
  for (const gl::PassTime& pass : m.passes)
    passes.push_back(
        {{"name", pass.name}, {"milliseconds", pass.milliseconds}, {"dispatches", pass.dispatches}});
  object["passes"] = passes;
  return object;
}

std::string table_line(const Measurement& m) {
  std::string line = fmt::format("{:<15} {:<16} {:>4} {:>10} {:>9.3g}", m.name, name_of(m.integrator), m.size,
                                 m.springs, m.timestep);
  if (m.peer && !m.peer->passed) {
    return line + fmt::format(
                      "  not counted: after {} steps {:.2g} m off (at most {:.2g}), its center {:.2g} m (at "
                      "most {:.2g})\n",
                      m.peer->steps, m.peer->deviation, m.peer->bound, m.peer->fall, m.peer->fall_bound);
  }
  if (m.divergence) return line + fmt::format("  diverged in step {}\n", m.divergence->step);
  const auto factor = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.2f}", *value) : "-";
  };
  const auto kernel = m.kernel_milliseconds_per_step();
  return line +
         fmt::format(
             " {:>10.4g} {:>9.4g} {:>9} {:>9.3g} {:>12.4g} {:>6.0f}% {:>5.2f} {:>7} {:>7} {:>7} {:>9}\n",
             m.steps_per_second(), m.milliseconds_per_step(), kernel ? fmt::format("{:.4g}", *kernel) : "-",
             m.spring_evaluations_per_second(), m.seconds_per_simulated_second(), 100.0 * m.spread(),
             m.processors(), factor(m.growth), factor(m.ratio), factor(m.processor_ratio),
             m.bytes ? fmt::format("{:.1f}", static_cast<double>(*m.bytes) / (1024.0 * 1024.0)) : "-");
}

/// Passes of one row, a line each.
std::string pass_lines(const Measurement& m) {
  const double sum = m.kernel_milliseconds_per_step().value_or(0.0);
  std::string text = fmt::format("\n{}, {} per edge, {}: {:.4g} ms of device time per step\n", m.name, m.size,
                                 name_of(m.integrator), sum);
  for (const gl::PassTime& pass : m.passes)
    text += fmt::format("  {:<24} {:>9.4f} ms {:>5.1f}% {:>7.1f} dispatches\n", pass.name, pass.milliseconds,
                        100.0 * pass.milliseconds / sum, pass.dispatches);
  return text;
}

}  // namespace

double quantile_of(std::vector<double> samples, double q) {
  std::ranges::sort(samples);
  const double at = q * static_cast<double>(samples.size() - 1);
  const auto below = static_cast<std::size_t>(at), above = std::min(below + 1, samples.size() - 1);
  return std::lerp(samples[below], samples[above], at - static_cast<double>(below));
}

namespace {

std::vector<double> each(const std::vector<Took>& repeats, double Took::*what) {
  std::vector<double> values;
  for (const Took& took : repeats) values.push_back(took.*what);
  return values;
}

}  // namespace

double Measurement::quantile(double q) const {
  return quantile_of(each(repeats, &Took::seconds), q);
}
std::optional<double> Measurement::kernel_milliseconds_per_step() const {
  if (passes.empty()) return std::nullopt;
  double sum = 0.0;
  for (const gl::PassTime& pass : passes) sum += pass.milliseconds;
  return sum;
}
double Measurement::processor_median() const {
  return quantile_of(each(repeats, &Took::processor_seconds), 0.5);
}

void compare_rows(std::vector<Measurement>& rows) {
  std::map<std::pair<std::string, Integrator>, double> first_of_name;
  const Measurement* first = nullptr;  // of this size and integrator: never a peer
  for (Measurement& m : rows) {
    if (!m.peer && (!first || first->size != m.size || first->integrator != m.integrator)) first = &m;
    if (!m.counts()) continue;
    const double throughput = m.spring_evaluations_per_second();
    if (!(throughput > 0.0)) continue;  // a scene without springs
    const auto [earlier, is_first] = first_of_name.try_emplace({m.name, m.integrator}, throughput);
    m.growth = earlier->second / throughput;
    if (!first || !first->counts()) continue;
    m.ratio = first->spring_evaluations_per_second() / throughput;
    const double by_processor = m.spring_evaluations_per_processor_second();
    if (std::isfinite(by_processor) && by_processor > 0.0)
      m.processor_ratio = first->spring_evaluations_per_processor_second() / by_processor;
  }
}

Json origin_json() {
  return {{"version", ASPIC_VERSION},
          {"date", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)))},
          {"machine", machine()},
          {"compiler", ASPIC_COMPILER},
          {"flags", ASPIC_FLAGS}};
}

Json json_of(const BenchReport& report) {
  Json rows = Json::array();
  for (const Measurement& m : report.rows) rows.push_back(row_json(m));
  Json json = origin_json();
  json.update({{"scene", report.scene},
               {"repeats", report.repeats},
               {"warm_up", report.warm_up},
               {"interrupted", report.interrupted},
               {"measurements", rows}});
  return json;
}

std::string table_of(const BenchReport& report) {
  std::string text =
      fmt::format("{}, {} repeat{} each after {} to warm up, in turn; medians\n{}, {} cores; {} {}\n",
                  report.scene, report.repeats, report.repeats == 1 ? "" : "s", report.warm_up,
                  processor_name(), std::thread::hardware_concurrency(), ASPIC_COMPILER, ASPIC_FLAGS);
  std::vector<std::string> devices;
  for (const Measurement& m : report.rows) {
    const std::string device = fmt::format("{}: {}\n", m.name, m.device);
    if (std::ranges::find(devices, device) == devices.end()) devices.push_back(device);
  }
  for (const std::string& device : devices) text += device;
  text += fmt::format(
      "\n{:<15} {:<16} {:>4} {:>10} {:>9} {:>10} {:>9} {:>9} {:>9} {:>12} {:>7} {:>5} {:>7} {:>7} {:>7} "
      "{:>9}\n",
      "backend", "integrator", "n", "springs", "h [s]", "steps/s", "ms/step", "kernel", "ev./s",
      "s per sim. s", "spread", "busy", "growth", "ratio", "cpu r.", "MiB");
  for (const Measurement& m : report.rows) text += table_line(m);
  for (const Measurement& m : report.rows) {
    if (!m.passes.empty()) text += pass_lines(m);
  }
  text +=
      "\nms/step: total time of a step; kernel: device time of its passes [ms], in separate steps;\nev./s: "
      "spring evaluations; spread: (slowest - fastest) / median; busy: CPU cores in use; growth: cost of\nan "
      "evaluation relative to the first size; ratio: ev./s of the first row with this size over this "
      "row's;\ncpu r.: the same by CPU time, for busy machines.\n";
  if (report.interrupted)
    text += "Interrupted: rows that are missing or have fewer repeats were not finished.\n";
  return text;
}

}  // namespace aspic::cli

#include "scene/input_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "aspic/scene.h"
#include "base/files.h"
#include "model/bodies.h"
#include "model/inputs.h"
#include "scene/diagnostics.h"
#include "scene/document.h"
#include "scene/write.h"

namespace aspic {
namespace {

using diagnostics::Position;

/// Reading ends with so many problems: a file that is none at all has one in each line.
constexpr std::size_t most_problems = 20;
/// Of the file itself.
constexpr std::string_view file_keys[] = {"timestep", "inputs"};
/// Pinned and released particles of all entries together: 64 MiB.
constexpr std::size_t most_particles = std::size_t{1} << 24;
/// As far as double precision counts.
constexpr std::int64_t last_step = std::int64_t{1} << 53;

class InputReader {
 public:
  explicit InputReader(const LoggedRun& run) : run_(run) {}

  InputLog read(const toml::table& file);
  std::vector<diagnostics::Problem> take_problems() { return std::move(problems_); }

 private:
  using Words = std::span<const std::string_view>;
  void fail(const toml::source_region& at, std::string message) {
    problems_.push_back({document::position_of(at, 0), std::move(message)});
  }
  bool full() const { return problems_.size() >= most_problems; }
  void check_keys(const toml::table& table, std::string_view where, Words keys);
  template <class T, class Take>
  std::optional<T> value(const toml::table& table, std::string_view key, std::string_view wanted,
                         const Take& take);
  std::optional<double> number(const toml::table& table, std::string_view key);
  std::optional<std::int64_t> whole(const toml::table& table, std::string_view key);
  template <class Take>
  void list(const toml::table& table, std::string_view key, std::string_view wanted, const Take& take);
  void read_entry(const toml::table& table, InputLog& log);
  void read_channels(const toml::table& table, Inputs& inputs);
  std::optional<Pull> read_pull(const toml::table& table);
  std::vector<std::uint32_t> read_particles(const toml::table& table, std::string_view key);
  void add_named(const toml::node& node, const std::string& name, std::vector<std::uint32_t>& particles);

  const LoggedRun& run_;
  std::vector<diagnostics::Problem> problems_;
  std::optional<std::int64_t> step_;  // of the entry before
  std::size_t particles_ = 0;
};

std::optional<double> number_of(const toml::node& node) {
  if (const auto* x = node.as_floating_point(); x && std::isfinite(x->get())) return x->get();
  if (const auto* x = node.as_integer()) return static_cast<double>(x->get());
  return std::nullopt;
}

std::optional<std::int64_t> whole_of(const toml::node& node) {
  if (const auto* x = node.as_integer()) return x->get();
  return std::nullopt;
}

void InputReader::check_keys(const toml::table& table, std::string_view where, Words keys) {
  for (const auto& [key, node] : table) {
    if (std::ranges::find(keys, key.str()) != keys.end() || full()) continue;
    fail(key.source(), fmt::format("unknown key '{}' in {}{}; allowed: {}", key.str(), where,
                                   diagnostics::did_you_mean(diagnostics::nearest(key.str(), keys)),
                                   diagnostics::list_text(keys, false)));
  }
}

template <class T, class Take>
std::optional<T> InputReader::value(const toml::table& table, std::string_view key, std::string_view wanted,
                                    const Take& take) {
  const toml::node* const node = table.get(key);
  if (!node) return std::nullopt;
  const std::optional<T> taken = take(*node);
  if (!taken)
    fail(node->source(), fmt::format("'{}' must be {}, not {}", key, wanted, document::kind_text(*node)));
  return taken;
}

std::optional<double> InputReader::number(const toml::table& table, std::string_view key) {
  return value<double>(table, key, "a finite number", number_of);
}

std::optional<std::int64_t> InputReader::whole(const toml::table& table, std::string_view key) {
  const auto taken = value<std::int64_t>(table, key, "an integer", whole_of);
  if (!taken || (*taken >= 0 && *taken <= last_step)) return taken;
  fail(table.get(key)->source(), fmt::format("'{}' must be 0 or more, and at most 2⁵³", key));
  return std::nullopt;
}

/// Hands each element of an array to `take`, which says whether it is one.
template <class Take>
void InputReader::list(const toml::table& table, std::string_view key, std::string_view wanted,
                       const Take& take) {
  const toml::node* const node = table.get(key);
  if (!node) return;
  const toml::array* const array = node->as_array();
  if (!array)
    return fail(node->source(),
                fmt::format("'{}' must be a list of {}, not {}", key, wanted, document::kind_text(*node)));
  for (const toml::node& element : *array) {
    if (full()) return;
    if (!take(element))
      fail(element.source(),
           fmt::format("'{}' must be a list of {}, not of {}", key, wanted, document::kind_text(element)));
  }
}

std::optional<Pull> InputReader::read_pull(const toml::table& table) {
  constexpr std::string_view keys[] = {"particle", "ball", "anchor", "stiffness", "damping"};
  check_keys(table, "a pull", keys);
  Pull pull;
  const bool ball = table.contains("ball");
  if (ball == table.contains("particle")) {
    fail(table.source(), ball ? "a pull has either 'particle' or 'ball', not both"
                              : "a pull needs 'particle' or 'ball', the index of its target");
    return std::nullopt;
  }
  pull.ball = ball;
  const auto index = whole(table, ball ? "ball" : "particle");
  // Larger ones are out of every range: the nearest says so as well.
  constexpr std::int64_t most = std::numeric_limits<std::uint32_t>::max();
  if (index) pull.particle = static_cast<std::uint32_t>(std::min(*index, most));
  std::vector<double> anchor;
  list(table, "anchor", "numbers", [&](const toml::node& element) {
    const auto x = number_of(element);
    if (x) anchor.push_back(*x);
    return x.has_value();
  });
  const auto stiffness = number(table, "stiffness"), damping = number(table, "damping");
  if (anchor.size() != 3) {
    fail(table.contains("anchor") ? table.get("anchor")->source() : table.source(),
         "a pull needs 'anchor', a list of three numbers [m]");
    return std::nullopt;
  }
  if (!table.contains("stiffness")) fail(table.source(), "a pull needs 'stiffness' [N/m]");
  pull.anchor = {anchor[0], anchor[1], anchor[2]};
  pull.stiffness = stiffness.value_or(0.0);
  pull.damping = damping.value_or(0.0);
  return index ? std::optional(pull) : std::nullopt;
}

/// Adds the particles of a name as `cube[0].top`.
void InputReader::add_named(const toml::node& node, const std::string& name,
                            std::vector<std::uint32_t>& particles) {
  std::size_t first = 0;
  std::vector<std::string> bodies;
  for (const BodyRow& row : body_rows()) {
    for (std::size_t i = 0; i < row.list.size(run_.settings); ++i) {
      const std::string body = fmt::format("{}[{}]", row.list.key, i);
      if (row.pins) bodies.push_back(body);
      if (row.pins && name.starts_with(body + ".")) {
        const PinnedSettings wanted = {{name.substr(body.size() + 1)}, {}};
        const auto found = row.named(*row.pins, run_.settings, i, wanted);
        if (!found) return fail(node.source(), fmt::format("{}: {}", body, found.error().what));
        for (std::size_t local = 0; local < found->size(); ++local)
          if ((*found)[local]) particles.push_back(static_cast<std::uint32_t>(first + local));
        return;
      }
      first += row.counts(run_.settings, i).particles;
    }
  }
  const std::vector<std::string_view> known(bodies.begin(), bodies.end());
  if (known.empty())
    return fail(node.source(),
                fmt::format("\"{}\": no body of the scene has names for its parts; give indices", name));
  fail(node.source(), fmt::format("\"{}\" names no part of a body: write {}, a dot, and a side or a corner "
                                  "as in the key 'pinned' of scenes, such as \"{}.top\"",
                                  name, diagnostics::list_text(known, false), known.front()));
}

std::vector<std::uint32_t> InputReader::read_particles(const toml::table& table, std::string_view key) {
  std::vector<std::uint32_t> particles;
  std::set<std::string> names;
  list(table, key, "indices and names", [&](const toml::node& element) {
    if (const auto* name = element.as_string()) {
      if (names.insert(name->get()).second) add_named(element, name->get(), particles);
      return true;
    }
    const auto index = whole_of(element);
    if (!index) return false;
    if (*index < 0 || *index >= run_.model.particle_count()) {
      fail(element.source(), fmt::format("'{}': there is no particle {}; the scene has {}, counted from 0",
                                         key, *index, run_.model.particle_count()));
    } else {
      particles.push_back(static_cast<std::uint32_t>(*index));
    }
    return true;
  });
  std::ranges::sort(particles);
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  particles_ += particles.size();
  return particles;
}

/// `{ legs = 0.3 }`: by the actuators that read them; the others are 0.
void InputReader::read_channels(const toml::table& table, Inputs& inputs) {
  const std::vector<std::string> names = input_names(run_.model);
  const std::vector<std::string_view> known(names.begin(), names.end());
  inputs.channels.assign(names.size(), 0.0);
  for (const auto& [name, node] : table) {
    const auto channel = static_cast<std::size_t>(std::ranges::find(known, name.str()) - known.begin());
    const auto x = number_of(node);
    if (channel == known.size())
      fail(name.source(),
           known.empty()
               ? std::string("no actuator of the scene has signal = \"input\", so no channel has an effect")
               : fmt::format("no actuator '{}' reads a channel; those that do are {}{}", name.str(),
                             diagnostics::list_text(known, false),
                             diagnostics::did_you_mean(diagnostics::nearest(name.str(), known))));
    else if (!x)
      fail(node.source(), fmt::format("'channels.{}' must be a finite number", name.str()));
    else
      inputs.channels[channel] = *x;
  }
}

void InputReader::read_entry(const toml::table& table, InputLog& log) {
  constexpr std::string_view keys[] = {"step", "pulls", "pinned", "released", "channels"};
  check_keys(table, "[[inputs]]", keys);
  if (!table.contains("step"))
    fail(table.source(), "[[inputs]] needs 'step', the first step for which it is valid");
  const auto step = whole(table, "step");
  if (step && step_ && *step <= *step_)
    fail(table.get("step")->source(), fmt::format("'step' must exceed that before, {}", *step_));
  if (step) step_ = step;
  Inputs inputs;
  const std::size_t before = problems_.size();
  list(table, "pulls", "tables", [&](const toml::node& element) {
    if (const auto* pull = element.as_table()) {
      if (const auto read = read_pull(*pull)) inputs.pulls.push_back(*read);
      return true;
    }
    return false;
  });
  inputs.pinned = read_particles(table, "pinned");
  inputs.released = read_particles(table, "released");
  if (const auto* const by_name = table.get_as<toml::table>("channels")) {
    read_channels(*by_name, inputs);
  } else {
    list(table, "channels", "finite numbers, or a table of them by actuator", [&](const toml::node& element) {
      const auto x = number_of(element);
      if (x) inputs.channels.push_back(*x);
      return x.has_value();
    });
  }
  if (particles_ > most_particles)
    fail(table.source(),
         fmt::format(
             "more than {} particles are pinned or released in all: pin fewer, or change pins less often",
             most_particles));
  if (problems_.size() > before || !step) return;
  if (const auto taken = rounded_inputs(run_.model, inputs, Precision::double_); !taken) {
    const auto key = std::ranges::find_if(
        keys, [&](std::string_view word) { return taken.error().what.starts_with(word); });
    const bool written = key != std::end(keys) && table.contains(*key);
    return fail(written ? table.get(*key)->source() : table.source(), taken.error().what);
  }
  log.set(static_cast<std::uint64_t>(*step), std::move(inputs));
}

InputLog InputReader::read(const toml::table& file) {
  check_keys(file, "the file", file_keys);
  const auto timestep = number(file, "timestep");
  if (timestep && !(*timestep > 0.0)) fail(file.get("timestep")->source(), "'timestep' must be above 0 [s]");
  InputLog log;
  list(file, "inputs", "tables: write [[inputs]]", [&](const toml::node& element) {
    if (const auto* table = element.as_table()) return read_entry(*table, log), true;
    return false;
  });
  const double own = run_.settings.simulation.timestep;
  return problems_.empty() && timestep ? log.with_timestep(*timestep, own) : log;
}

}  // namespace

bool is_input_log(std::string_view text) {
  const auto parsed = document::parse(text, 0);
  const auto* const file = std::get_if<toml::table>(&parsed);
  return file && !file->empty() && std::ranges::all_of(*file, [](const auto& entry) {
           return std::ranges::find(file_keys, entry.first.str()) != std::end(file_keys);
         });
}

Result<InputLog> parse_inputs(std::string_view text, const std::string& file_name, const LoggedRun& run) {
  const auto parsed = document::parse(text, 0);
  const std::vector<diagnostics::Source> sources = {{file_name, std::string(text)}};
  if (const auto* problem = std::get_if<diagnostics::Problem>(&parsed))
    return diagnostics::rejection(sources, {*problem});
  InputReader reader(run);
  InputLog log = reader.read(std::get<toml::table>(parsed));
  std::vector<diagnostics::Problem> problems = reader.take_problems();
  if (!problems.empty()) return diagnostics::rejection(sources, std::move(problems));
  return log;
}

Result<InputLog> read_inputs(const std::string& path, const LoggedRun& run) {
  ASPIC_TRY(const auto text, read_file(path));
  return parse_inputs(text, path, run);
}

std::string to_toml(const InputLog& log, double timestep) {
  std::string text = fmt::format(
      "# Inputs of a run: each table acts from the beginning of its step until the next table.\ntimestep = "
      "{}  # s\n",
      toml_value(timestep));
  for (const auto& [step, inputs] : log.entries()) {
    text += fmt::format("\n[[inputs]]\nstep = {}\n", step);
    for (const Pull& pull : inputs.pulls) {
      text += fmt::format("{}{{ {} = {}, anchor = {}, stiffness = {}, damping = {} }}",
                          &pull == &inputs.pulls.front() ? "pulls = [" : ",\n         ",
                          pull.ball ? "ball" : "particle", pull.particle, toml_value(pull.anchor),
                          toml_value(pull.stiffness), toml_value(pull.damping));
    }
    if (!inputs.pulls.empty()) text += "]\n";
    if (!inputs.pinned.empty()) text += fmt::format("pinned = [{}]\n", fmt::join(inputs.pinned, ", "));
    if (!inputs.released.empty()) text += fmt::format("released = [{}]\n", fmt::join(inputs.released, ", "));
    for (std::size_t n = 0; n < inputs.channels.size(); ++n)
      text += fmt::format("{}{}", n == 0 ? "channels = [" : ", ", toml_value(inputs.channels[n]));
    if (!inputs.channels.empty()) text += "]\n";
  }
  return text;
}

}  // namespace aspic

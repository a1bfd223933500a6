#include "scene/import_configuration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "aspic/scene.h"
#include "base/lines.h"
#include "base/printable.h"
#include "model/model.h"
#include "scene/diagnostics.h"
#include "scene/parameters.h"
#include "scene/write.h"

namespace aspic {
namespace {

/// Where a key's value goes: a parameter, or one component of one; or why it goes nowhere.
struct Target {
  std::string_view key;
  std::string_view path;    ///< empty: nowhere
  int axis = -1;            ///< component of a vector or of counts
  std::string_view reason;  ///< why not
};

constexpr std::string_view drawn = "view.draw";
constexpr std::array<Target, 24> targets = {{
    {"StudentID", "author", -1, ""},
    {"DrawParticle", drawn, 1, ""},
    {"DrawSpringStructural", drawn, 2, ""},
    {"DrawSpringShear", drawn, 3, ""},
    {"DrawSpringBending", drawn, 4, ""},
    {"DrawGoalpost", "", -1, "the posts are the net's pinned corners, rendered with it"},
    {"DrawPlane", "view.terrain", -1, ""},
    {"DrawBackground", "", -1, "there is one background"},
    {"DrawAxis", "view.axes", -1, ""},
    {"SimulationStart", "", -1, "scenes have no such setting"},
    {"IntegratorType", "simulation.integrator", -1, ""},
    {"NetInitPos_x", "goal-net[].position", 0, ""},
    {"NetInitPos_y", "goal-net[].position", 1, ""},
    {"NetInitPos_z", "goal-net[].position", 2, ""},
    {"NetWidth", "goal-net[].size", 0, ""},
    {"NetHeight", "goal-net[].size", 1, ""},
    {"NetLength", "goal-net[].size", 2, ""},
    {"NumAtWidth", "goal-net[].particles", 0, ""},
    {"NumAtHeight", "goal-net[].particles", 1, ""},
    {"NumAtLength", "goal-net[].particles", 2, ""},
    {"DeltaT", "simulation.timestep", -1, ""},
    {"SpringCoef", "goal-net[].structural.stiffness", -1, ""},
    {"DamperCoef", "goal-net[].structural.damping", -1, ""},
    {"SimulationPerFrame", "simulation.steps-per-frame", -1, ""},
}};

std::optional<double> number_in(std::string_view text) {
  if (text == "true") return 1.0;
  if (text == "false") return 0.0;
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.ends_with('f')) text.remove_suffix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Keys and values as messages and the scene's comments quote them: valid UTF-8 on one line, and not all of a
/// long one.
std::string shown(std::string_view text) {
  return excerpt(text, 60);
}

class Importer {
 public:
  Importer(const std::string& file_name, Scene scene) : file_name_(file_name) {
    result_.scene = std::move(scene);
  }

  Result<ImportedConfiguration> read(std::string_view text) {
    if (is_utf16(text))
      return aspic::fail(ErrorCode::scene_rejected, "{}: this is {}", printable_line(file_name_),
                         utf16_words);
    skip_byte_order_mark(text);
    while (!text.empty()) {
      ++line_;
      const std::string_view line = take_line(text);
      take(trimmed(line.substr(0, line.find('#'))));
    }
    if (!key_.empty()) missing_value();
    if (seen_.empty() && problems_.empty()) {
      line_ = 1;
      fail("no key: a configuration has lines such as *DeltaT, each with its value on the next line");
    }
    if (problems_.empty()) return std::move(result_);
    return Error{ErrorCode::scene_rejected, diagnostics::joined(problems_, "\n")};
  }

 private:
  void take(std::string_view line) {
    if (line.empty()) return;
    if (line.front() == '*') {
      if (!key_.empty()) missing_value();
      key_ = trimmed(line.substr(1));
      key_line_ = line_;
      if (const auto [at, fresh] = seen_.emplace(key_, line_); !fresh) {
        fail(fmt::format("*{} repeats line {}", shown(key_), at->second));
      }
    } else if (key_.empty()) {
      fail(fmt::format("\"{}\" is neither a key, which starts with *, nor the value of one", shown(line)));
    } else {
      store(line);
      key_.clear();
    }
  }

  void store(std::string_view text) {
    const auto target =
        std::find_if(targets.begin(), targets.end(), [&](const Target& t) { return t.key == key_; });
    if (target == targets.end()) {
      std::vector<std::string_view> known;
      for (const Target& t : targets) known.push_back(t.key);
      note(fmt::format("*{} is unknown and was left out (value {}){}", shown(key_), shown(text),
                       diagnostics::did_you_mean(diagnostics::nearest(key_, known))));
      return;
    }
    if (target->path.empty()) {
      note(fmt::format("*{} has no equivalent (value {}): {}", key_, shown(text), target->reason));
      return;
    }
    const Parameter& p = *find_parameter(target->path);
    if (p.type == ParameterType::text) return p.set(result_.scene, 0, Value(printable_line(text)));
    const auto number = number_in(text);
    if (!number) return fail(fmt::format("*{} must be a number, not \"{}\"", key_, shown(text)));
    const auto value = converted(p, *target, *number);
    if (!value) return;
    if (const auto complaint = check_value(p, *value))
      return fail(fmt::format("*{}: {}", key_, complaint->message));
    p.set(result_.scene, 0, *value);
  }

  std::optional<Value> converted(const Parameter& p, const Target& target, double number) {
    const bool whole = number == std::floor(number) && std::abs(number) < 1e9;
    const auto need_whole = [&] {
      fail(fmt::format("*{} must be an integer, not {}", key_, number));
      return std::nullopt;
    };
    Value value = *p.get(result_.scene, 0);
    switch (p.type) {
      case ParameterType::number:
        return Value(number);
      case ParameterType::integer:
        if (!whole) return need_whole();
        return Value(static_cast<std::int64_t>(number));
      case ParameterType::vector:
        std::get<Vec3>(value)[target.axis] = number;
        return value;
      case ParameterType::counts:
        if (!whole) return need_whole();
        std::get<std::vector<int>>(value)[static_cast<std::size_t>(target.axis)] = static_cast<int>(number);
        return value;
      case ParameterType::boolean:
        if (number == 0.0 || number == 1.0) return Value(number != 0.0);
        fail(fmt::format("*{} must be true or false, not {}", key_, number));
        return std::nullopt;
      case ParameterType::word:
        if (number == 0.0) return Value(std::string(name_of(Integrator::explicit_euler)));
        if (number == 1.0) return Value(std::string(name_of(Integrator::runge_kutta_4)));
        fail(fmt::format("*{} must be 0 (Euler) or 1 (Runge–Kutta), not {}", key_, number));
        return std::nullopt;
      case ParameterType::words: {
        if (number != 0.0 && number != 1.0) {
          fail(fmt::format("*{} must be true or false, not {}", key_, number));
          return std::nullopt;
        }
        auto& words = std::get<std::vector<std::string>>(value);
        const std::string word(p.words[static_cast<std::size_t>(target.axis)]);
        std::erase(words, word);
        if (number != 0.0) words.push_back(word);
        return value;
      }
      default:
        return std::nullopt;
    }
  }

  void missing_value() {
    problems_.push_back(fmt::format("{}:{}: *{} has no value: write it on the next line",
                                    printable_line(file_name_), key_line_, shown(key_)));
  }
  void fail(const std::string& what) {
    problems_.push_back(fmt::format("{}:{}: {}", printable_line(file_name_), line_, what));
  }
  void note(const std::string& what) {
    result_.notes.push_back(fmt::format("{}:{}: {}", printable_line(file_name_), key_line_, what));
  }

  const std::string& file_name_;
  ImportedConfiguration result_;
  std::vector<std::string> problems_;
  std::map<std::string, std::size_t, std::less<>> seen_;  // key to line
  std::string key_;                                       // waits for its value
  std::size_t line_ = 0, key_line_ = 0;
};

}  // namespace

Result<ImportedConfiguration> import_configuration(std::string_view text, const std::string& file_name) {
  if (text.find('\0') != std::string_view::npos) {
    return fail(ErrorCode::scene_rejected,
                "{}: this is a binary file, not text; give the framework's Configuration.txt",
                printable_line(file_name));
  }
  ASPIC_TRY(auto ground, load_scene("penalty"));
  ground.name = "imported";
  return Importer(file_name, std::move(ground)).read(text);
}

std::string imported_toml(const ImportedConfiguration& imported, const std::string& file_name) {
  std::string text = fmt::format(
      "# Imported from {}. The launcher throws balls at random in place of those that the user threw "
      "there.\n# For that framework's own contact formulas set model = \"course\" and spin = false in "
      "[contact], as the\n# built-in scene course-2018 does.\n",
      printable_line(file_name));
  for (const std::string& note : imported.notes)
    text += fmt::format("# Not translated: {}\n", printable_line(note));
  return text + to_toml(imported.scene);
}

}  // namespace aspic

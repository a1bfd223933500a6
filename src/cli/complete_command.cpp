// aspic --complete WORD …: what may stand in place of the last word, for the shells' completion
// (assets/shell).
#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"
#include "command_line/command_facts.h"
#include "command_line/window_layouts.h"
#include "gpu_solver/force_paths.h"
#include "io/video_format.h"
#include "model/integrator.h"
#include "report/outline.h"
#include "report/report.h"
#include "run/backends.h"
#include "scene/parameters.h"
#include "scene/short_keys.h"
#include "verify/check.h"

namespace aspic::cli {
namespace {

/// A word that is offered, and what it is.
struct Offer {
  std::string word, help;
};
using Offers = std::vector<Offer>;

template <class Range, class Name>
void add(Offers& to, const Range& range, const Name& name, std::string_view end = "") {
  for (const auto& row : range) to.push_back({std::string(name(row)) + std::string(end), ""});
}

void add_words(Offers& to, std::initializer_list<std::string_view> words) {
  add(to, words, [](std::string_view word) { return word; });
}

/// Keys of a scene with the first element of each list, or those of its view without the table's name.
void add_keys(Offers& to, bool view) {
  for (const Parameter& p : parameters()) {
    const std::string path = path_text(p.path, 0);
    if (!view) to.push_back({path + "=", ""});
    if (view && path.starts_with("view.")) to.push_back({path.substr(5) + "=", ""});
  }
}

/// Values of an option, from the tables which the program checks them against.
Offers values_of(const CommandFacts& command, const OptionFacts& option) {
  const std::string& name = option.names.back();
  const bool report = command.name.ends_with(" report");
  Offers found;
  const auto row_name = [](const auto& row) { return row.name; };
  if (name == "--backend" || name == "--backends") {
    add_words(found, {"auto"});
    add(found, backends(), row_name);
  } else if (name == "--precision") {
    add_words(found, {name_of(Precision::single), name_of(Precision::double_)});
  } else if (name == "--arithmetic") {
    add_words(found, {name_of(Arithmetic::exact), name_of(Arithmetic::fast)});
  } else if (name == "--force-path") {
    add_words(found, {"auto"});
    add(found, force_paths(), row_name);
  } else if (name == "--integrator") {
    add_words(found, {"all"});
    add(found, all_integrators, [](Integrator i) { return name_of(i); });
  } else if (name == "--timestep") {
    add_words(found, {"scene", "largest"});
  } else if (name == "--layout") {
    add(found, window_layouts, [](std::string_view layout) { return layout; });
  } else if (name == "--outline") {
    add(found, report::outlines(), row_name);
  } else if (name == "--only" && report) {
    add(found, report::sections(), row_name);
  } else if (name == "--only") {
    for (const verify::Check& check : verify::battery()) {
      const std::string group = check.name.substr(0, check.name.find('/'));
      if (found.empty() || found.back().word != group) found.push_back({group, ""});
    }
  } else if (name == "--frames-format") {
    for (const VideoFormat& format : video_formats())
      if (format.is_directory()) found.push_back({std::string(format.ending.substr(1)), ""});
  } else if (name == "--set" || name == "--view") {
    add_keys(found, name == "--view");
  } else if (name == "--variant" || name == "--vary") {
    add(found, short_keys(), row_name, "=");
    add_keys(found, false);
  } else if (const std::size_t bar = option.value.find('|'); bar != std::string::npos) {
    add_words(found, {option.value.substr(0, bar), option.value.substr(bar + 1)});
  }
  return found;
}

/// Tells the shell to offer names of files too.
void add_names(Offers& to, const std::string& value) {
  if (value == "FILE") to.push_back({":file", ""});
  if (value == "DIR") to.push_back({":directory", ""});
  if (value == "SCENE") to.push_back({":toml", ""});
}

const OptionFacts* option_named(const CommandFacts& command, std::string_view name) {
  for (const OptionFacts& option : command.options)
    if (std::ranges::find(option.names, name) != option.names.end()) return &option;
  return nullptr;
}

const CommandFacts* command_named(const CommandFacts& above, std::string_view word) {
  for (const CommandFacts& command : above.commands)
    if (command.name.ends_with(" " + std::string(word))) return &command;
  return nullptr;
}

Offers without_option(const CommandFacts& command, std::string_view start) {
  Offers found;
  if (!start.starts_with('-')) {
    for (const CommandFacts& below : command.commands)
      found.push_back({below.name.substr(below.name.rfind(' ') + 1), below.summary});
    for (const OptionFacts& argument : command.arguments) {
      if (argument.value == "SCENE")
        for (const BuiltinScene& scene : list_builtin_scenes())
          found.push_back({std::string(scene.name), ""});
      add_names(found, argument.value == "SCENE" ? argument.value : "FILE");
    }
  }
  if (found.empty())
    for (const OptionFacts& option : command.options)
      for (const std::string& name : option.names) found.push_back({name, option.help});
  return found;
}

}  // namespace

void complete(std::vector<std::string> words) {
  if (words.empty()) return;
  const CommandFacts aspic = describe_commands();
  const CommandFacts* command = &aspic;
  if (words.front().ends_with("aspic-view")) command = command_named(aspic, "view");
  // bash makes three words of --option=value.
  if (words.back() == "=") words.emplace_back();
  const std::string start = words.back();
  words.pop_back();
  if (!words.empty() && words.back() == "=") {
    words.pop_back();
    if (words.empty() || !words.back().starts_with("--")) return;  // the value of a key
  }

  const OptionFacts* option = nullptr;  // of the last word
  for (std::size_t n = 1; n < words.size(); ++n) {
    const bool is_value = option != nullptr && !option->value.empty();
    option = is_value ? nullptr : option_named(*command, words[n]);
    if (const CommandFacts* below = is_value ? nullptr : command_named(*command, words[n])) command = below;
  }
  std::string before, value_start = start;
  if (const std::size_t equals = start.find('='); start.starts_with("--") && equals != std::string::npos) {
    option = option_named(*command, start.substr(0, equals));
    before = start.substr(0, equals + 1);
    value_start = start.substr(equals + 1);
  }
  Offers offers;
  if (option != nullptr && !option->value.empty()) {
    offers = values_of(*command, *option);
    add_names(offers, option->value);
  } else {
    offers = without_option(*command, start);
  }
  for (const Offer& offer : offers) {
    const bool names = offer.word.starts_with(':');
    if (!names && !offer.word.starts_with(value_start)) continue;
    std::printf("%s%s\t%s\n", names ? "" : before.c_str(), offer.word.c_str(), offer.help.c_str());
  }
}

}  // namespace aspic::cli

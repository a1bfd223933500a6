// Manual pages.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "aspic/version.h"
#include "manual/manual.h"

namespace aspic::manual {
namespace {

/// What --help prints below the options: lines of examples, and the paragraphs below them.
struct Footer {
  std::vector<std::string> examples, notes;
};

Footer footer_of(const std::string& footer) {
  Footer parts;
  bool examples = false;
  for (std::size_t at = 0; at < footer.size();) {
    const std::size_t end = std::min(footer.find('\n', at), footer.size());
    const std::string line = footer.substr(at, end - at);
    at = end + 1;
    if (line == "Example:" || line == "Examples:")
      examples = true;
    else if (examples && line.starts_with("  "))
      parts.examples.push_back(line.substr(2));
    else {
      examples = false;
      // It has a section of all codes in the manual.
      if (line.starts_with("Exit codes:")) break;
      parts.notes.push_back(line);
    }
  }
  return parts;
}

/// "aspic-run", and aspic-scene for what is below it too.
std::string page_name(const CommandFacts& command) {
  std::string name = command.name;
  std::ranges::replace(name, ' ', '-');
  return name;
}

std::string title(const CommandFacts& command, std::string_view date) {
  std::string upper = page_name(command);
  std::ranges::transform(upper, upper.begin(),
                         [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
  // Names of options and files are not divided at the end of a line.
  return fmt::format(
      ".\\\" Made from the options of the program and from docs/commands.md.\n.TH {} 1 {} \"aspic {}\" "
      "\"Aspic\"\n.nh\n.ad l\n",
      roff_text(upper), date, ASPIC_VERSION);
}

std::string synopsis_line(const CommandFacts& command) {
  std::string line = fmt::format("\\fB{}\\fR", roff_text(command.name));
  if (!command.commands.empty()) return line + " \\fICOMMAND\\fR [\\fIoption\\fR ...]\n";
  for (const OptionFacts& argument : command.arguments) {
    const std::string word = fmt::format("\\fI{}\\fR", roff_text(argument.value));
    line += argument.required ? " " + word : " [" + word + "]";
  }
  for (const OptionFacts& option : command.options)
    if (option.required)
      line += fmt::format(" \\fB{}\\fR \\fI{}\\fR", roff_text(option.names.front()), roff_text(option.value));
  return line + " [\\fIoption\\fR ...]\n";
}

std::string option_entry(const OptionFacts& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += (names.empty() ? "" : ", ") + fmt::format("\\fB{}\\fR", roff_text(name));
  if (!option.value.empty() && option.names.front().starts_with('-'))
    names += fmt::format(" \\fI{}\\fR", roff_text(option.value));
  std::string help = roff_text(option.help);
  if (!help.ends_with('.')) help += '.';
  if (option.required) help += " Required.";
  if (option.repeatable && help.find("repeatable") == std::string::npos) help += " Repeatable.";
  std::string value = option.default_value;
  std::erase_if(value, [](char c) { return c == '[' || c == ']'; });  // of lists
  if (!value.empty()) help += fmt::format(" Default: {}.", roff_text(value));
  return fmt::format(".TP\n{}\n{}\n", names, help);
}

/// Arguments, then options.
std::string options_of(const CommandFacts& command) {
  std::string roff;
  for (const OptionFacts& argument : command.arguments) {
    OptionFacts shown = argument;
    shown.names = {argument.value};
    roff += option_entry(shown);
  }
  for (const OptionFacts& option : command.options) roff += option_entry(option);
  return roff;
}

std::string examples_of(const std::vector<std::string>& examples) {
  std::string roff = ".SH EXAMPLES\n";
  for (const std::string& line : examples) {
    // What explains a command is three spaces or more behind it.
    const std::size_t gap = line.find("   ");
    const std::string words = line.substr(0, gap);
    const std::size_t note = gap == std::string::npos ? gap : line.find_first_not_of(' ', gap);
    roff += ".TP\n\\fB" + roff_text(words) + "\\fR\n";
    if (note != std::string::npos) roff += roff_text(line.substr(note)) + "\n";
  }
  return roff;
}

const std::vector<std::string>& section(const Sections& sections, const std::string& name) {
  const auto found = sections.find(name);
  if (found == sections.end()) throw std::runtime_error("docs/commands.md has no section \"" + name + "\"");
  return found->second;
}

std::string exit_status(const Sections& page) {
  return ".SH EXIT STATUS\n" + roff_of(section(page, "Exit codes"));
}

/// Without blocks of code.
std::vector<std::string> without_code(const std::vector<std::string>& lines) {
  std::vector<std::string> rest;
  bool code = false;
  for (const std::string& line : lines) {
    const bool fence = line.starts_with("```");
    if (fence) code = !code;
    if (!fence && !code) rest.push_back(line);
  }
  return rest;
}

std::string surroundings(const Sections& page) {
  return ".SH ENVIRONMENT\n" + roff_of(section(page, "Environment")) + ".SH FILES\n" +
         roff_of(section(page, "Files"));
}

std::string see_also(const CommandFacts& aspic, const CommandFacts& command) {
  std::string names;
  const auto add = [&](const CommandFacts& other) {
    if (&other != &command)
      names += (names.empty() ? "" : ",\n") + fmt::format(".BR {} (1)", roff_text(page_name(other)));
  };
  add(aspic);
  for (const CommandFacts& other : aspic.commands) add(other);
  // A comma belongs to its line: .BR a (1),
  std::string lines;
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t end = std::min(names.find(",\n", at), names.size());
    lines += names.substr(at, end - at) + (end < names.size() ? ",\n" : "\n");
    at = end + 2;
  }
  return ".SH SEE ALSO\n" + lines +
         ".PP\nOther documents that this page names are installed in \\fIshare/doc/aspic\\fR.\n";
}

std::string name_section(const CommandFacts& command) {
  std::string summary = command.summary;
  // By convention a line of whatis(1) is a phrase.
  if (summary.size() > 1 && summary[1] >= 'a' && summary[1] <= 'z')
    summary[0] = static_cast<char>(summary[0] | 0x20);
  return fmt::format(".SH NAME\n{} \\- {}\n", roff_text(page_name(command)), roff_text(summary));
}

/// The program with the list of its commands.
std::string main_page(const CommandFacts& aspic, const Sections& page, std::string_view date) {
  const Footer footer = footer_of(aspic.footer);
  std::string roff = title(aspic, date) + name_section(aspic) + ".SH SYNOPSIS\n" + synopsis_line(aspic);
  roff += ".br\n\\fBaspic\\fR \\fICOMMAND\\fR \\fB\\-\\-help\\fR\n.SH DESCRIPTION\n" +
          roff_of(without_code(section(page, "")));
  roff += ".SH COMMANDS\n";
  for (const CommandFacts& command : aspic.commands)
    roff +=
        fmt::format(".TP\n\\fB{}\\fR(1)\n{}.\n", roff_text(page_name(command)), roff_text(command.summary));
  roff += ".SH OPTIONS\n" + options_of(aspic) + exit_status(page) + surroundings(page) +
          examples_of(footer.examples);
  return roff + see_also(aspic, aspic);
}

std::string command_page(const CommandFacts& aspic, const CommandFacts& command, const Sections& page,
                         std::string_view date) {
  Footer footer = footer_of(command.footer);
  std::string roff = title(command, date) + name_section(command) + ".SH SYNOPSIS\n";
  const bool window = last_word(command) == "view";
  if (command.commands.empty()) roff += synopsis_line(command);
  for (const CommandFacts& below : command.commands)
    roff += (&below == &command.commands.front() ? "" : ".br\n") + synopsis_line(below);
  if (window) {
    CommandFacts program = command;
    program.name = "aspic-view";
    roff += ".br\n" + synopsis_line(program);
  }
  roff += fmt::format(".SH DESCRIPTION\n{}.\n", roff_text(command.summary));
  if (window) roff += "\\fBaspic\\-view\\fR is the program that \\fBaspic view\\fR starts.\n";
  roff +=
      roff_of(section(page, command.name)) + roff_of(footer.notes) + ".SH OPTIONS\n" + options_of(command);
  for (const CommandFacts& below : command.commands) {
    roff += fmt::format(".SS {}\n{}.\n", roff_text(below.name), roff_text(below.summary)) + options_of(below);
    const Footer more = footer_of(below.footer);
    roff += roff_of(more.notes);
    for (const std::string& line : more.examples)
      if (std::ranges::find(footer.examples, line) == footer.examples.end()) footer.examples.push_back(line);
  }
  roff += exit_status(page);
  roff += window ? surroundings(page)
                 : ".SH ENVIRONMENT\n.BR aspic (1)\nhas a list of the environment variables.\n";
  roff += examples_of(footer.examples);
  return roff + see_also(aspic, command);
}

}  // namespace

std::vector<TextFile> manual_pages(const CommandFacts& aspic, const Sections& commands_page,
                                   std::string_view date) {
  std::vector<TextFile> pages = {{"man1/aspic.1", main_page(aspic, commands_page, date)}};
  for (const CommandFacts& command : aspic.commands)
    pages.push_back(
        {fmt::format("man1/{}.1", page_name(command)), command_page(aspic, command, commands_page, date)});
  return pages;
}

}  // namespace aspic::manual

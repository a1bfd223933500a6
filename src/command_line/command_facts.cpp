#include "command_line/command_facts.h"

#include <CLI/CLI.hpp>

#include "command_line/command_table.h"

namespace aspic {
namespace {

OptionFacts facts_of(const CLI::Option& option) {
  OptionFacts facts;
  for (const std::string& name : option.get_snames()) facts.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
  if (facts.names.empty()) facts.names.push_back(option.get_name());
  if (option.get_type_size_max() > 0) facts.value = option.get_type_name();
  facts.help = option.get_description();
  facts.default_value = option.get_default_str();
  facts.required = option.get_required();
  facts.repeatable = option.get_items_expected_max() > 1;
  return facts;
}

CommandFacts facts_of(const CLI::App& app, const std::string& before) {
  CommandFacts facts;
  facts.name = before + app.get_name();
  facts.summary = app.get_description();
  facts.footer = app.get_footer();
  for (const CLI::Option* option : app.get_options())
    (option->nonpositional() ? facts.options : facts.arguments).push_back(facts_of(*option));
  for (const CLI::App* command : app.get_subcommands({}))
    facts.commands.push_back(facts_of(*command, facts.name + " "));
  return facts;
}

}  // namespace

CommandFacts describe_commands() {
  return facts_of(CommandTable([](const auto&, const auto&) {}).app, "");
}

}  // namespace aspic

#pragma once
// main() of programs with commands: errors go to stderr, their codes are the exit codes.
#include <variant>

#include "cli/commands.h"
#include "io/program.h"

namespace aspic::cli {

/// Parses the command line and executes the command.
template <class Execute>
int command_main(int argc, const char* const* argv, const Execute& execute) {
  const auto run = [&]() -> Status {
    ASPIC_TRY(const auto command, parse_arguments(argc, argv));
    return std::visit(execute, command);
  };
  return run_program([&] {
    const Status done = run();
    if (done) return 0;
    if (done.error().code != closed_pipe) print_message(worded(done.error(), FrontEnd::command_line));
    return static_cast<int>(done.error().code);
  });
}

}  // namespace aspic::cli

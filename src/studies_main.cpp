// aspic-studies: all commands and the shells' completion. aspic becomes it for the commands that it lacks.
#include <string_view>

#include "cli/program_main.h"

int main(int argc, char** argv) {
  if (argc > 1 && std::string_view(argv[1]) == "--complete")
    return aspic::run_program([&] {
      aspic::cli::complete({argv + 2, argv + argc});
      return 0;
    });
  return aspic::cli::command_main(argc, argv,
                                  [](const auto& options) { return aspic::cli::execute(options); });
}

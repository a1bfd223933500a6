// aspic: parses the command line and runs the command; errors go to stderr, their codes are the exit codes.
#include <string_view>
#include <variant>

#include "cli/commands.h"
#include "io/console.h"
#include "io/program.h"

namespace {

aspic::Status run(int argc, const char* const* argv) {
  ASPIC_TRY(const auto command, aspic::parse_arguments(argc, argv));
  return std::visit([](const auto& options) { return aspic::cli::execute(options); }, command);
}

}  // namespace

int main(int argc, char** argv) {
  return aspic::run_program([&] {
    if (argc > 1 && std::string_view(argv[1]) == "--complete") {
      aspic::cli::complete({argv + 2, argv + argc});
      return 0;
    }
    const aspic::Status done = run(argc, argv);
    if (done) return 0;
    if (done.error().code != aspic::closed_pipe)
      aspic::print_message(worded(done.error(), aspic::FrontEnd::command_line));
    return static_cast<int>(done.error().code);
  });
}

// aspic: the commands that simulate and record; aspic-studies has the others.
#include <string_view>
#include <type_traits>

#include "cli/program_main.h"

namespace {

template <class Options>
constexpr bool is_study =
    std::is_same_v<Options, aspic::BenchOptions> || std::is_same_v<Options, aspic::ReportOptions> ||
    std::is_same_v<Options, aspic::SweepOptions> || std::is_same_v<Options, aspic::VerifyOptions>;

}  // namespace

int main(int argc, char** argv) {
  const auto execute = [&]<class Options>(const Options& options) {
    if constexpr (is_study<Options>) {
      return aspic::cli::execute_study({argv + 1, argv + argc});
    } else {
      return aspic::cli::execute(options);
    }
  };
  if (argc > 1 && std::string_view(argv[1]) == "--complete")
    return aspic::cli::execute_study({argv + 1, argv + argc}) ? 0 : 1;
  return aspic::cli::command_main(argc, argv, execute);
}

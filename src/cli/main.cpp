#include "cli/main.h"

#include <type_traits>
#include <variant>

#include "cli/commands.h"
#include "io/console.h"

namespace aspic::cli {

int main(int argc, const char* const* argv) {
  const auto command = parse_arguments(argc, argv);
  if (!command) {
    print_message(command.error().message);
    return static_cast<int>(command.error().code);
  }
  const Status done = std::visit(
      [](const auto& options) -> Status {
        using Options = std::decay_t<decltype(options)>;
        if constexpr (std::is_same_v<Options, ShowText>) return print_data(options.text);
        if constexpr (std::is_same_v<Options, RunOptions>) return run_command(options);
        if constexpr (std::is_same_v<Options, ViewOptions>) return view_command(options);
        if constexpr (std::is_same_v<Options, CompareOptions>) return compare_command(options);
        if constexpr (std::is_same_v<Options, BenchOptions>) return bench_command(options);
        if constexpr (std::is_same_v<Options, VerifyOptions>) return verify_command(options);
        if constexpr (std::is_same_v<Options, SceneListOptions>) return scene_list_command(options);
        if constexpr (std::is_same_v<Options, SceneShowOptions>) return scene_show_command(options);
        if constexpr (std::is_same_v<Options, SceneCheckOptions>) return scene_check_command(options);
        if constexpr (std::is_same_v<Options, SceneImportOptions>) return scene_import_command(options);
        if constexpr (std::is_same_v<Options, InfoOptions>) return info_command(options);
      },
      *command);
  if (done) return 0;
  print_message(done.error().message);
  return static_cast<int>(done.error().code);
}

}  // namespace aspic::cli

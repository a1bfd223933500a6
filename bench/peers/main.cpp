// aspic-peers: `aspic bench` next to other programs that simulate the same cube (README.md).
#include <fmt/format.h>

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "command_line/arguments.h"
#include "io/console.h"
#include "io/program.h"
#include "peers/contestants.h"

namespace aspic::peers {
namespace {

Result<cli::Guests> invite(const std::vector<PeerProgram>& programs, const ModelSettings& settings,
                           const Model& model, const Measurement& like, const InterruptGuard& interrupt) {
  ASPIC_TRY(const auto lattice, peer_lattice(settings, model));
  cli::Guests guests;
  guests.most_steps = lattice.most_steps;
  for (const PeerProgram& program : programs) {
    if (interrupt.interrupted()) return Error{ErrorCode::interrupted, ""};
    if (like.size > program.largest) {
      print_message(fmt::format("skipped {} at {} particles per edge: bench/peers/peers.txt says at most {}.",
                                program.name, like.size, program.largest));
      continue;
    }
    auto made = make_peer_contestant(program, settings, lattice, like);
    // One that is not installed leaves the others their row.
    if (made)
      guests.contestants.push_back(std::move(*made));
    else
      print_warning(
          fmt::format("skipped {}: {}", program.name, worded(made.error(), FrontEnd::command_line)));
  }
  return guests;
}

/// Takes --peer NAME,… out of the words.
std::vector<std::string> taken_names(std::vector<std::string>& words) {
  std::vector<std::string> names;
  for (std::size_t n = 0; n + 1 < words.size();) {
    if (words[n] != "--peer") {
      ++n;
      continue;
    }
    std::string_view left = words[n + 1];
    for (std::size_t comma = 0; comma != std::string_view::npos; left.remove_prefix(comma + 1)) {
      comma = left.find(',');
      names.emplace_back(left.substr(0, comma));
      if (comma == std::string_view::npos) break;
    }
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(n),
                words.begin() + static_cast<std::ptrdiff_t>(n) + 2);
  }
  return names;
}

Status run(std::vector<std::string> words) {
  const std::vector<std::string> names = taken_names(words);
  std::vector<const char*> arguments = {"aspic", "bench"};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  ASPIC_TRY(const auto command, parse_arguments(static_cast<int>(arguments.size()), arguments.data()));
  if (const auto* help = std::get_if<ShowText>(&command)) {
    return print_data(
        "aspic-peers [--peer NAME,…] [OPTIONS]: aspic bench next to other programs with the same "
        "cube, all of bench/peers/peers.txt or those named. Options of aspic bench:\n\n" +
        help->text);
  }
  const auto& options = std::get<BenchOptions>(command);
  if (options.images) return fail(ErrorCode::usage, "peers draw no images: leave --images out.");
  ASPIC_TRY(const auto programs, find_peers(names));
  return cli::execute_bench(options, [&](const auto&... of) { return invite(programs, of...); });
}

}  // namespace
}  // namespace aspic::peers

int main(int argc, char** argv) {
  using namespace aspic;
  return run_program([&] {
    const Status done = peers::run({argv + 1, argv + argc});
    if (done) return 0;
    if (done.error().code != closed_pipe) print_message(worded(done.error(), FrontEnd::command_line));
    return static_cast<int>(done.error().code);
  });
}

#pragma once

namespace aspic::cli {

/// The program: parses the command line, runs the command, reports errors on stderr. Returns an exit code of
/// docs/commands.md.
int main(int argc, const char* const* argv);

}  // namespace aspic::cli

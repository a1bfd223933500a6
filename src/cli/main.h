#pragma once

namespace aspic::cli {

/// The program: parses the command line, runs the command, tells errors on stderr. Returns the exit code of
/// spec §4.
int main(int argc, const char* const* argv);

}  // namespace aspic::cli

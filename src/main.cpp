#include "cli/main.h"

#include "cli/program.h"

int main(int argc, char** argv) {
  return aspic::cli::run_program([&] { return aspic::cli::main(argc, argv); });
}

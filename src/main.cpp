#include "cli/main.h"

#include "io/program.h"

int main(int argc, char** argv) {
  return aspic::run_program([&] { return aspic::cli::main(argc, argv); });
}

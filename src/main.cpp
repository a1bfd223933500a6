#include "cli/main.h"

int main(int argc, char** argv) {
  return aspic::cli::main(argc, argv);
}

#pragma once
// The parser of all commands and options, and where it puts what it reads.
#include <CLI/CLI.hpp>
#include <functional>

#include "command_line/arguments.h"
#include "command_line/raw_options.h"

namespace aspic {

struct CommandTable {
  RawOptions raw;
  RunOptions run;
  ViewOptions view;
  CompareOptions compare;
  BenchOptions bench;
  SweepOptions sweep;
  ReportOptions report;
  VerifyOptions verify;
  SceneListOptions list;
  SceneShowOptions show;
  SceneCheckOptions check;
  SceneImportOptions import;
  InfoOptions info;
  CLI::App app;

  /// Calls `finish` with the command and what completes its options when the parser has read it.
  using Finish = std::function<void(const CLI::App&, const std::function<Result<Command>()>&)>;
  explicit CommandTable(Finish finish);
  CommandTable(const CommandTable&) = delete;
  CommandTable& operator=(const CommandTable&) = delete;

 private:
  void on(CLI::App* command, std::function<Result<Command>()> complete);

  Finish finish_;
};

}  // namespace aspic

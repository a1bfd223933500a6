// What the remedies of errors are called where they are done. A new remedy is an enumerator and a row,
// without which this does not compile.
#include <algorithm>
#include <cctype>
#include <string_view>

#include "base/result.h"

namespace aspic {
namespace {

/// Imperative clauses with {0}, {1} for the values; empty: the reader has no way to it.
struct RemedyRow {
  std::string_view library, command_line, window, python;
};

constexpr RemedyRow row_of(RemedyKind kind) {
  switch (kind) {
    case RemedyKind::words:
      return {"{0}", "{0}", "{0}", "{0}"};
    case RemedyKind::use_backend:
      return {"use the backend \"{0}\"", "use --backend {0}", "switch to the {0} backend (key G)",
              "pass backend=\"{0}\""};
    case RemedyKind::draw_nothing:
      return {"use the backend \"{0}\" without images", "use --backend {0} without images", "",
              "pass backend=\"{0}\" and render nothing"};
    case RemedyKind::overwrite:
      return {"pass Overwrite::allow", "overwrite with --force", "", "pass overwrite=True"};
    case RemedyKind::lower_fps:
      return {"set fps to {0} or less", "use --fps {0} or less",
              "set Frames to {0} per second or less (Recording)", "pass fps={0} or less"};
    case RemedyKind::raise_speed:
      return {"set speed to {0} or more", "use --speed {0} or more", "set Speed to ×{0} or more (Simulation)",
              "pass speed={0} or more"};
    case RemedyKind::shorten:
      return {"simulate less time", "choose a shorter --duration", "record less time", "simulate less time"};
    case RemedyKind::image_size:
      return {"set size to {{{0}, {1}}}", "use --size {0}x{1}", "", "pass width={0}, height={1}"};
    case RemedyKind::write_images:
      return {"write numbered frames instead (ImageOutput::frames)",
              "write numbered frames instead (--frames)",
              "write numbered frames instead (Format under Recording)", "name a directory instead"};
    case RemedyKind::resume:
      return {"read {0} with read_checkpoint()", "continue its run: aspic run --resume {0}",
              "rename it to end in .aspic", "continue it with aspic.resume()"};
    case RemedyKind::replay:
      return {"read {0} with read_inputs()", "replay them in a scene: aspic run SCENE --replay {0}",
              "open a scene, then {0}", "pass {0} to Simulation.replay()"};
    case RemedyKind::give_checkpoint:
      return {"give a file that write_checkpoint() wrote", "give a file that aspic run --checkpoint wrote",
              "open a file that Save checkpoint… wrote", "give a file that Simulation.save() wrote"};
  }
  return {};
}

std::string_view form_of(const RemedyRow& row, FrontEnd front_end) {
  switch (front_end) {
    case FrontEnd::command_line:
      return row.command_line;
    case FrontEnd::window:
      return row.window;
    case FrontEnd::python:
      return row.python;
    case FrontEnd::library:
      break;
  }
  return row.library;
}

std::string clause_of(const Remedy& remedy, FrontEnd front_end) {
  const auto value = [&](std::size_t i) {
    return i < remedy.values.size() ? std::string_view(remedy.values[i]) : std::string_view();
  };
  return fmt::format(fmt::runtime(form_of(row_of(remedy.kind), front_end)), value(0), value(1));
}

/// "A.", "A, or b.", "A, b, or c."
std::string sentence_of(const std::vector<std::string>& clauses) {
  std::string sentence;
  for (std::size_t i = 0; i < clauses.size(); ++i) {
    if (i > 0) sentence += i + 1 == clauses.size() ? ", or " : ", ";
    sentence += clauses[i];
  }
  sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
  return sentence + ".";
}

}  // namespace

std::string worded(const Error& error, FrontEnd front_end) {
  std::vector<std::string> clauses;
  for (const Remedy& remedy : error.remedies) {
    std::string clause = clause_of(remedy, front_end);
    // An error that another one led to may repeat what that one says.
    if (!clause.empty() && std::ranges::find(clauses, clause) == clauses.end())
      clauses.push_back(std::move(clause));
  }
  if (clauses.empty()) return error.what;
  std::string text = error.what;
  while (!text.empty() && (text.back() == ' ' || text.back() == '\n')) text.pop_back();
  const bool shows_text = text.find('\n') != std::string::npos;
  if (!shows_text && !text.empty() && std::string_view(".!?:").find(text.back()) == std::string_view::npos)
    text += '.';
  if (!text.empty()) text += shows_text ? '\n' : ' ';
  return text + sentence_of(clauses);
}

std::string Error::message() const {
  return worded(*this, FrontEnd::library);
}

}  // namespace aspic

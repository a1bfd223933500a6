// aspic-view: the window, started by `aspic view`.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <variant>
#include <vector>

#include "app/app.h"
#include "app/revival.h"
#include "app/window.h"
#include "base/end_request.h"
#include "command_line/arguments.h"
#include "io/console.h"
#include "io/program.h"

namespace aspic::app {
namespace {

/// An error that comes before there is a window to show it in, or ends the window.
int fail(const Error& error) {
  print_message(worded(error, FrontEnd::command_line));
  return static_cast<int>(error.code);
}

AppOptions options_from(const ViewOptions& view) {
  AppOptions options;
  options.scene = view.scene;
  options.overrides = view.overrides;
  options.replay = view.replay_file;
  options.backend = view.backend.row;
  options.asked = view.backend;
  options.asked.row = nullptr;
  return options;
}

int show(const ViewOptions& view) {
  // A scene that is refused needs no window to say so.
  if (const auto editor = SceneEditor::open(view.scene, view.overrides); !editor) return fail(editor.error());
  const std::string kept_path = kept_state_path();
  const auto kept = load_kept_state(kept_path);
  if (!kept) print_message(worded(kept.error(), FrontEnd::command_line));
  AppOptions options = options_from(view);
  if (kept) options.kept = *kept;
  if (const LayoutRow* const row = find_layout(view.layout)) options.kept.layout.choose(*row);
  const WindowPlace place = options.kept.window.value_or(WindowPlace{1280, 720, std::nullopt});
  const ImageSize size = view.size.value_or(ImageSize{place.width, place.height});
  auto window = Window::create(size.width, size.height, "Aspic", place.position);
  if (!window) return fail(window.error());
  auto app = App::create((*window)->context(), options, (*window)->content_scale(), (*window)->services());
  if (!app) return fail(app.error());
  (*window)->set_receiver(app->get());
  using Clock = std::chrono::steady_clock;
  auto last = Clock::now();
  std::string title;
  const InterruptGuard guard;
  std::optional<Error> error;
  const auto ended = [&] { return guard.interrupted() || Window::is_lost(); };
  while (!error && !(*window)->should_close() && !ended()) {
    const auto since_last = [&] { return std::chrono::duration<double>(Clock::now() - last).count(); };
    double wait = 0.0;
    do {
      (*window)->poll(wait);
      wait = std::max((*app)->wait(since_last()), (*window)->image_interval() - since_last());
    } while (wait > 0.0 && !(*window)->should_close() && !ended());
    if (ended()) break;
    if (((*window)->should_close() && !(*app)->may_close()) || (*app)->closes())
      (*window)->set_should_close((*app)->closes());
    const auto now = Clock::now();
    // After a pause of the program itself time continues; it does not catch up.
    const double dt = std::min(std::chrono::duration<double>(now - last).count(), 0.25);
    last = now;
    if ((*app)->asleep() && !(*app)->doze(dt)) continue;
    if (const Status drawn = (*app)->frame((*window)->size(), dt); !drawn) {
      error = drawn.error();
      if (!(*window)->context().lost()) continue;
      window = replace_window(**app, std::move(*window), *error);
      if (!window) return fail(window.error());
      error.reset();
      continue;
    }
    (*window)->show_image();
    if ((*app)->title() != title) (*window)->set_title(title = (*app)->title());
  }
  const bool interrupted = guard.interrupted();
  end_requested = true;  // nobody waits for an encoder that has come to a halt
  for (const std::string& line : (*app)->video.finish()) print_message(line);
  (*window)->set_receiver(nullptr);
  if (!error) {
    KeptState left = (*app)->kept_state();
    if (!Window::is_lost()) left.window = (*window)->place();
    // What cannot be kept is no reason to fail: nothing of the user's is lost.
    if (const Status saved = save_kept_state(left, kept_path); !saved)
      print_message(worded(saved.error(), FrontEnd::command_line));
  }
  if (Window::is_lost())
    error = Error{
        ErrorCode::no_device,
        fmt::format("The display was lost{}. Start aspic view on another display.",
                    (*app)->scene.editor().changed() ? ", and with it unsaved changes of the scene" : "")};
  if (error) return fail(*error);
  return interrupted ? static_cast<int>(ErrorCode::interrupted) : 0;
}

int start(int argc, char** argv) {
  // The words are those of `aspic view`.
  std::vector<const char*> words = {"aspic", "view"};
  words.insert(words.end(), argv + (argc > 0 ? 1 : 0), argv + argc);
  const auto command = parse_arguments(static_cast<int>(words.size()), words.data());
  if (!command) return fail(command.error());
  if (const auto* text = std::get_if<ShowText>(&*command))
    return print_data(text->text) ? 0 : static_cast<int>(ErrorCode::io);
  return show(std::get<ViewOptions>(*command));
}

}  // namespace
}  // namespace aspic::app

int main(int argc, char** argv) {
  return aspic::run_program([&] { return aspic::app::start(argc, argv); });
}

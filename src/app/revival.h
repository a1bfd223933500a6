#pragma once
// A new window for an app whose window's context was lost.
#include <memory>

#include "app/app.h"
#include "app/window.h"
#include "base/result.h"

namespace aspic::app {

/// Closes a window whose context was lost with error `why`, and opens another of its size that the app goes
/// on in. Errors: those of Window::create and App::adopt_context; there is no window then, and the app must
/// not be used.
Result<std::unique_ptr<Window>> replace_window(App& app, std::unique_ptr<Window> window, const Error& why);

}  // namespace aspic::app

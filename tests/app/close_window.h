#pragma once
// Xlib's macros stay in a file of their own.

namespace aspic::test {

/// Asks a window of the X server to close, as the button in its frame would. False without a display.
bool ask_window_to_close(unsigned long window);

}  // namespace aspic::test

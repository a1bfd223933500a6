#pragma once
// The names of the window's layouts, which `aspic view` takes; app/layouts.h describes them.
#include <string_view>

namespace aspic {

/// The first is that of a first start.
inline constexpr std::string_view window_layouts[] = {"standard", "lecture", "lab", "video"};

/// The name of a layout that had another one before 0.3; that one is accepted until 0.4.
inline std::string_view present_layout(std::string_view name) {
  return name == "film" ? window_layouts[3] : name;
}

}  // namespace aspic

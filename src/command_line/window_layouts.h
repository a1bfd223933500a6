#pragma once
// The names of the window's layouts, which `aspic view` takes; app/layouts.h describes them.
#include <string_view>

namespace aspic {

/// The first is that of a first start.
inline constexpr std::string_view window_layouts[] = {"standard", "lecture", "lab", "film"};

}  // namespace aspic

#pragma once
#include <string>
#include <string_view>

namespace aspic {

/// RFC 4648. Texts of parts whose lengths are multiples of 3 follow one another as that of the whole would.
std::string base64(std::string_view bytes);

}  // namespace aspic

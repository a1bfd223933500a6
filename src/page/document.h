#pragma once
// The HTML around the data of a page: its style, and the program that shows it, from src/page/web.
#include <string>

#include "page/facts.h"

namespace aspic::page {

/// Everything before the data, which is base64 of a raw deflate stream.
std::string document_head(const std::string& title, const Json& facts);
/// Everything after it; `ends`: what is known at the end of each run.
std::string document_tail(const Json& ends);

}  // namespace aspic::page

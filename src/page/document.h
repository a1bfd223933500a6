#pragma once
// The HTML around the data of a page: its style, and the program that shows it, from src/page/web.
#include <string>
#include <string_view>

#include "page/facts.h"

namespace aspic::page {

/// Everything before the data, which is base64 of a raw deflate stream.
/// `live`: it simulates, and may run WebAssembly in a worker.
std::string document_head(const std::string& title, const Json& facts, bool live);
/// Everything after it; `ends`: what is known at the end of each run; `module`: what a live page runs, a raw
/// deflate stream of WebAssembly; empty: it is none.
std::string document_tail(const Json& ends, std::string_view module);

}  // namespace aspic::page

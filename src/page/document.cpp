#include "page/document.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "base/base64.h"
#include "base/embedded_file.h"
#include "gpu/shader_source.h"

namespace aspic {
std::span<const EmbeddedFile> page_files();  // cmake/EmbedFiles.cmake
}

namespace aspic::page {
namespace {

/// The program's parts, each after what it uses.
constexpr std::string_view scripts[] = {"maths.js",    "data.js",    "springs.js",    "shapes.js", "gl.js",
                                        "bodies.js",   "drawing.js", "camera.js",     "player.js", "plot.js",
                                        "controls.js", "live.js",    "live_panel.js", "main.js"};
constexpr std::string_view of_live_pages = "live";  // begins the names of parts that only those have

std::string_view text_of(std::span<const EmbeddedFile> files, std::string_view name) {
  return find_embedded(files, name).value();
}

/// JSON that an element of a page can hold: nothing in it ends the element.
std::string within_script(const Json& json) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace), out;
  for (const char c : text) out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text)
    out += c == '<'   ? "&lt;"
           : c == '>' ? "&gt;"
           : c == '&' ? "&amp;"
           : c == '"' ? "&quot;"
                      : std::string(1, c);
  return out;
}

/// The page's shaders by name, the light of images (shaders/render) among them.
Json shaders() {
  Json texts = Json::object();
  for (const EmbeddedFile& file : page_files())
    if (!file.name.ends_with(".js") && !file.name.ends_with(".css") && !file.name.ends_with(".html"))
      texts[std::string(file.name)] = file.text;
  for (const std::string_view name : {"daylight.glsl", "soft_shadow.glsl", "landscape.glsl", "encode.glsl"})
    texts[std::string(name)] = text_of(embedded_shaders(), fmt::format("render/{}", name));
  return texts;
}

/// The document without what is filled in, in the parts between.
std::array<std::string_view, 5> parts() {
  std::array<std::string_view, 5> found;
  std::string_view rest = text_of(page_files(), "page.html");
  std::size_t i = 0;
  for (const std::string_view mark : {"@POLICY@", "@TITLE@", "@STYLE@", "@SCRIPT@"}) {
    const std::size_t at = rest.find(mark);
    found[i++] = rest.substr(0, at);
    rest.remove_prefix(at + mark.size());
  }
  found[i] = rest;
  return found;
}

constexpr std::string_view data_opening = "<script type=\"text/plain\" id=\"data\">";

}  // namespace

std::string document_head(const std::string& title, const Json& facts, bool live) {
  const auto [begin, after_policy, before_style, before_script, end] = parts();
  return fmt::format(
      "{}{}{}{}{}{}{}<script type=\"application/json\" id=\"facts\">{}</script>\n"
      "<script type=\"application/json\" id=\"shaders\">{}</script>\n{}",
      begin, live ? " 'wasm-unsafe-eval'; worker-src blob:" : "", after_policy, escaped(title), before_style,
      text_of(page_files(), "page.css"), before_script, within_script(facts), within_script(shaders()),
      data_opening);
}

std::string document_tail(const Json& ends, std::string_view module) {
  std::string text = fmt::format("</script>\n<script type=\"application/json\" id=\"ends\">{}</script>\n",
                                 within_script(ends));
  if (!module.empty())
    text += fmt::format(
        "<script type=\"text/plain\" id=\"module\">{}</script>\n"
        "<script type=\"text/plain\" id=\"worker\">{}</script>\n",
        base64(module), text_of(page_files(), "live_worker.js"));
  text += "<script>\n\"use strict\";\n";
  for (const std::string_view name : scripts)
    if (!module.empty() || !name.starts_with(of_live_pages)) text += text_of(page_files(), name);
  return text + "</script>" + std::string(parts().back());
}

}  // namespace aspic::page

#include "app/palette.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <utility>
#include <vector>

#include "app/new_body.h"
#include "app/panels.h"
#include "app/parameter_widget.h"
#include "scene/load.h"

namespace aspic::app {
namespace {

/// More than anyone reads: a longer query finds the rest.
constexpr std::size_t most_hits = 14;

struct Hit {
  std::string name, keys, help;
  std::function<void()> act;             ///< of an action or a scene
  const Parameter* parameter = nullptr;  ///< of a value, which is changed in its row
  std::size_t index = 0;
};

std::vector<Hit> find(const PanelParts& p, std::string_view query) {
  std::vector<Hit> hits;
  for (const Command& c : p.gui.commands().rows()) {
    if (c.act && holds_words(c.name, query))
      hits.push_back({std::string(c.name), std::string(c.keys), "", c.act, nullptr, 0});
  }
  for (const BuiltinScene& scene : list_builtin_scenes()) {
    const std::string name(scene.name), help(scene.description);
    if (holds_words(fmt::format("open {} {}", name, help), query))
      hits.push_back({"open " + name, "", help, [&p, name] { p.scene.open(name); }, nullptr, 0});
  }
  for (const BodyRow& row : body_rows()) {
    const std::string name = fmt::format("add a {}", spaced(row.list.key));
    if (holds_words(name, query))
      hits.push_back({name, "", "Beside the bodies that there are. Restarts the simulation.",
                      [&p, &row] { add_body(p.scene, row.list); }, nullptr, 0});
  }
  for (const std::string& body : followed_names(p.scene.scene())) {
    const std::string name = "follow " + body;
    if (holds_words(name, query))
      hits.push_back({name, "", "The camera moves along with it.",
                      [&p, body] { set_followed(p.scene, body); }, nullptr, 0});
  }
  for (const LayoutRow& row : layouts()) {
    const std::string name = fmt::format("layout {}", row.name), help(row.summary);
    if (holds_words(fmt::format("{} {}", name, help), query))
      hits.push_back({name, "", help, [&p, &row] { p.layout.choose(row); }, nullptr, 0});
  }
  const Scene& scene = p.scene.scene();
  for (const Parameter& q : parameters()) {
    for (std::size_t i = 0; hits.size() < most_hits && i < index_count(q, scene); ++i) {
      const std::string name = path_text(q.path, i);
      if (q.path != "name" && q.type != ParameterType::text && applies(q, scene, i) &&
          holds_words(fmt::format("{} {} {}", name, spaced(name), q.meaning), query))
        hits.push_back({name, "", "", {}, &q, i});
    }
  }
  if (hits.size() > most_hits) hits.resize(most_hits);
  return hits;
}

}  // namespace

bool holds_words(std::string_view text, std::string_view query) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  while (!query.empty()) {
    const std::size_t end = std::min(query.find(' '), query.size());
    const std::string_view word = query.substr(0, end);
    if (std::search(text.begin(), text.end(), word.begin(), word.end(), same) == text.end() && !word.empty())
      return false;
    query.remove_prefix(std::min(end + 1, query.size()));
  }
  return true;
}

void Palette::open() {
  open_ = just_opened_ = true;
  query_.clear();
  chosen_ = 0;
}

void Palette::draw(const PanelParts& p, double width, double height) {
  if (!open_) return;
  const double scale = p.gui.scale();
  const auto at = [](double x, double y) { return ImVec2(static_cast<float>(x), static_cast<float>(y)); };
  ImGui::SetNextWindowPos(at(0.5 * width, 0.12 * height), ImGuiCond_Always, {0.5f, 0.0f});
  ImGui::SetNextWindowSize(at(std::min(520.0 * scale, width), 0.0));
  if (just_opened_) ImGui::SetNextWindowFocus();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, static_cast<float>(8.0 * scale));
  ImGui::Begin("##palette", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings);
  if (std::exchange(just_opened_, false)) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1.0f);
  const std::string before = query_;
  const bool entered = ImGui::InputTextWithHint("##query", "an action, a scene or a value", &query_,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  const bool typing = ImGui::IsItemActive();
  named(p.gui, "palette/query", "Words of its name or of what it does. Enter does what is marked.");
  const std::vector<Hit> hits = find(p, query_);
  const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
  if (typing && pressed(ImGuiKey_DownArrow)) ++chosen_;
  if (typing && pressed(ImGuiKey_UpArrow)) --chosen_;
  chosen_ = query_ == before ? std::clamp(chosen_, 0, std::max(static_cast<int>(hits.size()) - 1, 0)) : 0;
  const Hit* done = nullptr;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit& hit = hits[i];
    const bool marked = static_cast<int>(i) == chosen_;
    if (hit.parameter) {
      edit(p.gui, p.scene, hit.parameter->path, hit.index, {hit.name});
      continue;
    }
    if (ImGui::Selectable(fmt::format("{}##{}", hit.name, i).c_str(), marked) || (entered && marked))
      done = &hit;
    named(p.gui, "palette/" + hit.name, hit.help.empty() ? hit.name : hit.help);
    if (hit.keys.empty()) continue;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(hit.keys.c_str()).x);
    ImGui::TextDisabled("%s", hit.keys.c_str());
  }
  if (hits.empty()) ImGui::TextDisabled("nothing has these words");
  ImGui::End();
  ImGui::PopStyleVar();
  if (!done) return;
  close();
  done->act();
}

}  // namespace aspic::app

#include "app/palette.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <utility>
#include <vector>

#include "app/panels.h"
#include "app/parameter_widget.h"
#include "aspic/scene.h"
#include "scene/new_body.h"

namespace aspic::app {
namespace {

// Dear ImGui 1.87 gave it another name.
#if IMGUI_VERSION_NUM >= 18700
constexpr ImGuiKey keypad_enter = ImGuiKey_KeypadEnter;
#else
constexpr ImGuiKey keypad_enter = ImGuiKey_KeyPadEnter;
#endif

/// More than anyone reads: a longer query finds the rest.
constexpr std::size_t most_hits = 14;

/// Values that are looked at: a scene with thousands of balls has more than can be found by name.
constexpr std::size_t most_values = 400;

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

bool begins_with(std::string_view text, std::string_view word) {
  return text.size() >= word.size() &&
         std::ranges::equal(text.substr(0, word.size()), word, {}, lower, lower);
}

std::vector<std::string_view> words_in(std::string_view text, std::string_view breaks) {
  std::vector<std::string_view> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(breaks), text.size());
    if (end > 0) words.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

/// The next of the words that a value may be, or the other of yes and no; nothing for numbers.
std::optional<Value> next_value(const Parameter& p, const Scene& scene, std::size_t index) {
  const auto value = p.get(scene, index);
  if (!value) return std::nullopt;
  if (const bool* const on = std::get_if<bool>(&*value)) return Value(!*on);
  const auto* const word = std::get_if<std::string>(&*value);
  if (!word || p.words.empty()) return std::nullopt;
  const auto now = static_cast<std::size_t>(std::ranges::find(p.words, *word) - p.words.begin());
  return Value(std::string(p.words[(now + 1) % p.words.size()]));
}

}  // namespace

struct Palette::Hit {
  int fit = 0;
  std::string name = {}, keys = {}, help = {};
  std::function<void()> act = {};        ///< of all but values
  const Parameter* parameter = nullptr;  ///< of a value, which is changed in its row
  std::size_t index = 0;
};

/// The best first, of equal ones actions before values, before sections, scenes and the rest.
std::vector<Palette::Hit> Palette::find(const PanelParts& p) {
  std::vector<Hit> hits;
  const auto add = [&](const std::string& name, std::string_view more, Hit hit) {
    const auto fit = fit_of(name, more, query_);
    if (!fit) return;
    hit.fit = *fit;
    hit.name = name;
    hits.push_back(std::move(hit));
  };
  for (const Command& c : p.gui.commands().rows())
    if (c.act) add(std::string(c.name), "", {.keys = std::string(c.keys), .act = c.act});
  const Scene& scene = p.scene.scene();
  std::size_t values = 0;
  for (const Parameter& q : parameters()) {
    if (q.path == "name" || q.type == ParameterType::text) continue;
    for (std::size_t i = 0; values < most_values && i < index_count(q, scene); ++i) {
      const std::string name = path_text(q.path, i);
      const std::size_t before = hits.size();
      if (applies(q, scene, i))
        add(name, fmt::format("{} {}", spaced(name), q.meaning), {.parameter = &q, .index = i});
      values += hits.size() - before;
    }
  }
  for (const auto& [section, help] : section_names())
    add("section " + section, help,
        {.help = help, .act = [&p, section = section] { show_section(p.layout, section); }});
  for (const BuiltinScene& builtin : list_builtin_scenes()) {
    const std::string name(builtin.name);
    add("open " + name, "",
        {.help = std::string(builtin.description), .act = [&p, name] { p.scene.open(name); }});
  }
  for (const BodyRow& row : body_rows())
    add(fmt::format("add a {}", noun_of(row.list.key)), "",
        {.help = "Adds it in free space. Restarts the simulation.",
         .act = [&p, &row] { add_body(p.scene, row.list); }});
  add("add a box", "", {.help = "Adds it in free space. Restarts the simulation.", .act = [&p] {
                          p.scene.change("add box", [](Scene& s) { add_box(s); });
                        }});
  for (const std::string& body : followed_names(scene))
    add("follow " + body, "",
        {.help = "Moves the camera along with it.", .act = [&p, body] { set_followed(p.scene, body); }});
  for (const LayoutRow& row : layouts())
    add(fmt::format("layout {}", row.name), row.summary,
        {.help = std::string(row.summary), .act = [&p, &row] { p.layout.choose(row); }});
  std::ranges::stable_sort(hits, {}, &Hit::fit);
  if (hits.size() > most_hits) hits.resize(most_hits);
  return hits;
}

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

std::optional<int> fit_of(std::string_view name, std::string_view more, std::string_view query) {
  if (!holds_words(fmt::format("{} {}", name, more), query)) return std::nullopt;
  if (!holds_words(name, query)) return 3;
  const std::vector<std::string_view> asked = words_in(query, " "), words = words_in(name, " .-[]");
  const bool each = std::ranges::all_of(asked, [&](std::string_view word) {
    return std::ranges::any_of(words, [&](std::string_view own) { return begins_with(own, word); });
  });
  if (!each) return 2;
  const std::string_view last = name.substr(name.rfind('.') + 1);
  return asked.empty() || begins_with(last, asked.front()) ? 0 : 1;
}

void Palette::open() {
  open_ = just_opened_ = true;
  back_to_query_ = false;
  typed_row_ = -1;
  query_.clear();
  chosen_ = 0;
}

/// The widget of a value; Enter begins typing there, or takes the next of its words. True while it has the
/// keyboard.
bool Palette::value_row(const PanelParts& p, const Hit& hit, bool marked, bool entered) {
  if (marked) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled(
        corner, {corner.x + ImGui::GetContentRegionAvail().x, corner.y + ImGui::GetFrameHeight()},
        ImGui::GetColorU32(ImGuiCol_Header));
  }
  if (marked && entered) {
    if (const auto next = next_value(*hit.parameter, p.scene.scene(), hit.index)) {
      p.scene.set_value(*hit.parameter, hit.index, *next);
      back_to_query_ = true;
    } else {
      ImGui::SetKeyboardFocusHere();
    }
  }
  ImGui::BeginGroup();
  edit(p.gui, p.scene, hit.parameter->path, hit.index, {hit.name});
  ImGui::EndGroup();
  return ImGui::IsItemActive();
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
  const bool return_to_query = std::exchange(back_to_query_, false);
  if (std::exchange(just_opened_, false) || return_to_query) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1.0f);
  const std::string before = query_;
  const bool entered =
      ImGui::InputTextWithHint("##query", "an action, a scene, a section or a value", &query_,
                               ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  const bool typing = ImGui::IsItemActive();
  named(p.gui, "palette/query",
        "Type part of a name. Down and Up select, Enter runs the selection or edits the value.");
  const std::vector<Hit> hits = find(p);
  const auto pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
  const int last = std::max(static_cast<int>(hits.size()) - 1, 0);
  if (typing && pressed(ImGuiKey_DownArrow)) ++chosen_;
  if (typing && pressed(ImGuiKey_UpArrow)) --chosen_;
  chosen_ = query_ == before ? std::clamp(chosen_, 0, last) : 0;
  const Hit* done = nullptr;
  int typed_row = -1;
  for (int i = 0; i < static_cast<int>(hits.size()); ++i) {
    const Hit& hit = hits[static_cast<std::size_t>(i)];
    const bool marked = i == chosen_;
    if (hit.parameter) {
      if (value_row(p, hit, marked, entered)) typed_row = chosen_ = i;
      if (marked) p.gui.mark("palette/marked");
      continue;
    }
    if (ImGui::Selectable(fmt::format("{}##{}", hit.name, i).c_str(), marked) || (entered && marked))
      done = &hit;
    if (marked) p.gui.mark("palette/marked");
    named(p.gui, "palette/" + hit.name, hit.help.empty() ? hit.name : hit.help);
    if (hit.keys.empty()) continue;
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(hit.keys.c_str()).x);
    ImGui::TextDisabled("%s", hit.keys.c_str());
  }
  if (hits.empty()) ImGui::TextDisabled("No matches");
  // After a value was entered the next one can be looked for.
  if (typed_row_ >= 0 && typed_row < 0 && (pressed(ImGuiKey_Enter) || pressed(keypad_enter)))
    back_to_query_ = true;
  typed_row_ = typed_row;
  const bool elsewhere = ImGui::IsMouseClicked(ImGuiMouseButton_Left) &&
                         !ImGui::IsWindowHovered(ImGuiHoveredFlags_RootAndChildWindows |
                                                 ImGuiHoveredFlags_AllowWhenBlockedByActiveItem |
                                                 ImGuiHoveredFlags_AllowWhenBlockedByPopup);
  ImGui::End();
  ImGui::PopStyleVar();
  if (done || elsewhere) close();
  if (done) done->act();
}

}  // namespace aspic::app

#include "app/gui.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "base/embedded_file.h"

namespace aspic {

std::span<const EmbeddedFile> embedded_fonts();  // generated: one

namespace app {
namespace {

constexpr float font_height = 15.0f;
/// What a texture has room for.
constexpr float largest_font = 96.0f;

/// What labels, units and tooltips are written with.
constexpr ImWchar characters[] = {0x0020, 0x00ff, 0x0370, 0x03ff, 0x2010, 0x2027, 0x2070, 0x209f,
                                  0x2190, 0x21ff, 0x2200, 0x22ff, 0x25a0, 0x25ff, 0};

/// Whether a key does something to a text, Enter among them, instead of being in it.
bool edits(int key) {
  return (key >= GLFW_KEY_ESCAPE && key <= GLFW_KEY_END) || key == GLFW_KEY_KP_ENTER;
}

ImVec4 gray(float value, float alpha = 1.0f) {
  return {value, value * 1.02f, value * 1.07f, alpha};
}

/// Dark and quiet: gray surfaces, one accent.
void set_theme(float scale) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  ImGui::StyleColorsDark(&style);
  style.WindowRounding = 0.0f;
  style.FrameRounding = style.GrabRounding = style.PopupRounding = 4.0f;
  style.WindowBorderSize = 0.0f;
  style.WindowPadding = {12.0f, 10.0f};
  style.FramePadding = {7.0f, 4.0f};
  style.ItemSpacing = {8.0f, 6.0f};
  style.ScrollbarSize = 11.0f;
  const ImVec4 accent = {0.25f, 0.56f, 0.62f, 1.0f};
  const auto tint = [&](float alpha) { return ImVec4(accent.x, accent.y, accent.z, alpha); };
  ImVec4* c = style.Colors;
  c[ImGuiCol_Text] = gray(0.88f);
  c[ImGuiCol_TextDisabled] = gray(0.56f);
  c[ImGuiCol_WindowBg] = gray(0.105f);
  c[ImGuiCol_PopupBg] = gray(0.13f, 0.98f);
  c[ImGuiCol_Border] = gray(0.25f);
  c[ImGuiCol_FrameBg] = gray(0.18f);
  c[ImGuiCol_FrameBgHovered] = gray(0.23f);
  c[ImGuiCol_FrameBgActive] = gray(0.27f);
  c[ImGuiCol_Button] = gray(0.21f);
  c[ImGuiCol_ButtonHovered] = tint(0.55f);
  c[ImGuiCol_ButtonActive] = tint(0.85f);
  c[ImGuiCol_Header] = {0.13f, 0.215f, 0.235f, 1.0f};
  c[ImGuiCol_HeaderHovered] = tint(0.40f);
  c[ImGuiCol_HeaderActive] = tint(0.60f);
  c[ImGuiCol_CheckMark] = {0.45f, 0.82f, 0.87f, 1.0f};
  c[ImGuiCol_SliderGrab] = tint(0.5f);  // the value can be read through it
  c[ImGuiCol_SliderGrabActive] = accent;
  c[ImGuiCol_TextSelectedBg] = tint(0.5f);
  c[ImGuiCol_Separator] = gray(0.22f);
  style.ScaleAllSizes(scale);
}

#if IMGUI_VERSION_NUM >= 18900
/// After the backend, which asks the keyboard: that may be ahead of the events.
void tell_modifiers(const KeyEvent& event) {
  struct Modifier {
    ImGuiKey key;
    int bit, left, right;
  };
  static constexpr Modifier modifiers[] = {
      {ImGuiMod_Ctrl, GLFW_MOD_CONTROL, GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL},
      {ImGuiMod_Shift, GLFW_MOD_SHIFT, GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT},
      {ImGuiMod_Alt, GLFW_MOD_ALT, GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT},
      {ImGuiMod_Super, GLFW_MOD_SUPER, GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER}};
  for (const Modifier& m : modifiers) {
    // GLFW's bits lack the key of the event itself.
    const bool own = event.key == m.left || event.key == m.right;
    ImGui::GetIO().AddKeyEvent(m.key, own ? event.action != GLFW_RELEASE : (event.modifiers & m.bit) != 0);
  }
}
#endif

}  // namespace

Result<std::unique_ptr<Gui>> Gui::create(double scale, WindowServices services, const Commands& commands,
                                         WidgetWatcher* watcher) {
  std::unique_ptr<Gui> gui(new Gui(scale, std::move(services), commands, watcher));
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
#if IMGUI_VERSION_NUM >= 18900
  io.ConfigInputTrickleEventQueue = false;  // App spreads events over images itself: ready_for()
#endif
  io.UserData = gui.get();
  gui->set_look();
  // Without its callbacks: events come through ours, so that tests can hand them over too.
  ImGui_ImplGlfw_InitForOpenGL(gui->services_.window, false);
  if (!ImGui_ImplOpenGL3_Init("#version 430 core"))
    return Error{ErrorCode::no_device,
                 "Cannot draw the panels: their OpenGL functions could not be loaded. Install libgl1, or use "
                 "aspic run, which needs no window."};
  return gui;
}

void Gui::set_look() {
  text_size_ = wanted_text_size_;
  set_theme(static_cast<float>(scale()));
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  fonts.Clear();
  const std::string_view font = embedded_fonts().front().text;
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  const auto add = [&](float height, const ImWchar* characters_of) {
    const float pixels = std::min(std::round(height * static_cast<float>(pixels_per_unit_)), largest_font);
    ImFont* const made = fonts.AddFontFromMemoryTTF(
        const_cast<char*>(font.data()), static_cast<int>(font.size()), pixels, &config, characters_of);
    made->Scale = height / pixels;
    return made;
  };
  const float height = std::min(std::round(font_height * static_cast<float>(scale())), largest_font);
  add(height, characters);
  static constexpr ImWchar plain[] = {0x0020, 0x007e, 0};
  large_font_ = add(std::min(3.0f * height, largest_font), plain);
}

Gui::~Gui() {
  if (ImGui::GetIO().BackendRendererUserData) ImGui_ImplOpenGL3_Shutdown();
  if (ImGui::GetIO().BackendPlatformUserData) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

bool Gui::ready_for(const KeyEvent& event) const {
  const bool changed = std::ranges::find(changed_, event.key) != changed_.end();
  // A modifier that was tapped with a click is down in the image that sees the click.
  if (event.key >= GLFW_KEY_LEFT_SHIFT) return !changed;
  return !takes_keyboard() || (!changed && (!edited_ || event.action == GLFW_RELEASE));
}

void Gui::key(const KeyEvent& event) {
  if (event.character != 0) return ImGui::GetIO().AddInputCharacter(event.character);
  // What GLFW says of modifiers lacks the key of the event itself; this keeps its own account.
  // In a list ImGui takes the space bar where others take Enter.
  const bool enters = event.key == GLFW_KEY_ENTER || event.key == GLFW_KEY_KP_ENTER;
  const int key = enters && list_is_open() ? GLFW_KEY_SPACE : event.key;
  ImGui_ImplGlfw_KeyCallback(services_.window, key, 0, event.action, event.modifiers);
#if IMGUI_VERSION_NUM >= 18900
  tell_modifiers(event);
#endif
  if (event.action != GLFW_REPEAT) changed_.push_back(event.key);
  edited_ = edited_ || (event.action != GLFW_RELEASE && edits(event.key));
}

void Gui::mouse_button(int button, int action) {
  if (button < 0 || button >= 5) return;
  held_[button] = action != GLFW_RELEASE;
  // A click that came and went between two images is still seen by one of them.
  pressed_[button] = pressed_[button] || held_[button];
}

void Gui::cursor(double x, double y) {
  mouse_x_ = x;
  mouse_y_ = y;
}

void Gui::scroll(double dx, double dy) {
  ImGui::GetIO().MouseWheelH += static_cast<float>(dx);
  ImGui::GetIO().MouseWheel += static_cast<float>(dy);
}

bool Gui::takes_keyboard() const {
  // A field that the last image opened or closed counts already.
  return list_is_open() ||
         (ImGui::IsAnyItemActive() && ImGui::GetCurrentContext()->WantTextInputNextFrame == 1);
}

bool Gui::list_is_open() {
  return !ImGui::GetCurrentContext()->OpenPopupStack.empty();
}

bool Gui::takes_mouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}

void Gui::begin(const WindowSize& size, double dt) {
  if (wanted_text_size_ != text_size_ || size.pixels_per_unit() != pixels_per_unit_) {
    pixels_per_unit_ = size.pixels_per_unit();
    set_look();
    ImGui_ImplOpenGL3_DestroyFontsTexture();
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(size.width), static_cast<float>(size.height)};
  io.DisplayFramebufferScale = {static_cast<float>(size.pixels_per_unit()),
                                static_cast<float>(size.pixel_height) / static_cast<float>(size.height)};
  io.DeltaTime = static_cast<float>(std::max(dt, 1e-4));
  // The mouse as events told it, which may be ahead of where it is by now.
  const ImVec2 mouse{static_cast<float>(mouse_x_), static_cast<float>(mouse_y_)};
#if IMGUI_VERSION_NUM >= 18900
  io.AddMousePosEvent(mouse.x, mouse.y);  // after the one that ImGui_ImplGlfw_NewFrame() queued
#else
  io.MousePos = mouse;
#endif
  for (int i = 0; i < 5; ++i) {
    io.MouseDown[i] = pressed_[i] || held_[i];
    pressed_[i] = false;
  }
  // Arrows, Enter and Escape act on lists alone: elsewhere they are the window's.
  if (list_is_open())
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  else
    io.ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
  ImGui::NewFrame();
  changed_.clear();
  edited_ = awake_ = false;
}

void Gui::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (watcher_) watcher_->end_of_image();
}

Box Gui::last_item() {
  const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(b.x),
          static_cast<double>(b.y)};
}

bool Gui::explain(std::string_view text, std::string_view keys) {
  constexpr double rest = 0.6;  // s
  if (watcher_)
    watcher_->tooltip(last_item(), fmt::format("{}{}{}", text, keys.empty() ? "" : "\nKey: ", keys));
  const ImGuiIO& io = ImGui::GetIO();
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return false;
  const double now = ImGui::GetTime();
  // Gone for an image, or on another widget: it begins again.
  const bool stays =
      rested_on_ == last_item() && rested_seen_ >= now - 1.5 * static_cast<double>(io.DeltaTime);
  rested_on_ = last_item();
  rested_seen_ = now;
  if (!stays || ImGui::IsAnyItemActive() || ImGui::IsAnyMouseDown()) rested_since_ = now;
  return now - rested_since_ >= rest;
}

Gui& Gui::current() {
  return *static_cast<Gui*>(ImGui::GetIO().UserData);
}

}  // namespace app
}  // namespace aspic

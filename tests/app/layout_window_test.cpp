// How the window is laid out: text, widths, what is remembered, and that every control explains itself.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <imgui.h>

#include <cmath>

#include "app/stage.h"
#include "aspic/scene.h"

namespace aspic::test {
namespace {

using app::Box;

class Layout : public Stage {
 protected:
  std::array<int, 2> window_size() const override { return roomy; }
  /// As after a first start, with every section open or none.
  static app::KeptState with_sections(bool open) {
    app::KeptState kept;
    kept.greeted = true;
    for (const char* name : {"Scene", "Simulation", "Bodies", "Cells", "Materials", "Springs", "Contact",
                             "Balls", "View", "Recording", "Performance", "Energy", "Compare backends"})
      kept.layout.sections[name] = open;
    return kept;
  }
  /// Lets the camera come to rest without an image of all its way.
  void rest() {
    for (int i = 0; i < 100 && app().view.camera.update(1.0); ++i) {
    }
    frames(1);
  }
  Box box(const std::string& name) { return widgets().at(name); }
};

/// A display with more than a pixel for each window unit, as under Wayland.
class DenseLayout : public Layout, public testing::WithParamInterface<double> {
 protected:
  std::array<int, 2> window_size() const override { return {960, 540}; }
};

TEST_P(DenseLayout, HasTheSamePlacesAndSharperText) {
  open("cube-plane", {}, "reference", with_sections(false));
  const std::map<std::string, Box> before = widgets();
  const float font = ImGui::GetIO().Fonts->Fonts[0]->FontSize;
  pixels_per_unit = GetParam();
  resize(static_cast<int>(960 * GetParam()), static_cast<int>(540 * GetParam()));
  frames(2);
  EXPECT_EQ(ImGui::GetIO().Fonts->Fonts[0]->FontSize, std::round(font * static_cast<float>(GetParam())));
  EXPECT_EQ(app().view.pixels_per_unit, GetParam());
  ASSERT_EQ(widgets().size(), before.size());
  for (const auto& [name, was] : before) {
    EXPECT_NEAR(box(name).left, was.left, 3.0) << name;
    EXPECT_NEAR(box(name).top, was.top, 3.0) << name;
    EXPECT_NEAR(box(name).right, was.right, 3.0) << name;
    EXPECT_NEAR(box(name).bottom, was.bottom, 3.0) << name;
  }
  click("section/Contact");
  EXPECT_TRUE(has("contact.friction")) << "the mouse is where it is";
}
INSTANTIATE_TEST_SUITE_P(Layout, DenseLayout, testing::Values(1.5, 2.0));

TEST_F(Layout, EveryControlExplainsItself) {
  open("cube-plane", {}, "reference", with_sections(true));
  std::size_t keys = 0;
  for (const BuiltinScene& scene : list_builtin_scenes()) {
    app().scene.open(std::string(scene.name));
    frames(2);
    for (const auto& [name, text] : explanations()) {
      EXPECT_FALSE(text.empty()) << name << " in " << scene.name << " has no tooltip";
      std::string path = name.substr(0, name.find('/'));
      if (const std::size_t bracket = path.find('['); bracket != std::string::npos)
        path.replace(bracket, path.find(']') - bracket + 1, "[]");
      const Parameter* const p = find_parameter(path);
      if (!p) continue;
      ++keys;
      // One control of all types of springs, where those of each type are folded away.
      if (text.find("\n\nScene keys: ") != std::string::npos) {
        EXPECT_THAT(text, testing::HasSubstr(name.substr(0, name.find('/')) + ","));
        continue;
      }
      EXPECT_THAT(text, testing::HasSubstr(std::string(p->meaning))) << name;
      EXPECT_THAT(text, testing::HasSubstr("Scene key: " + path.substr(0, path.find('[')))) << name;
      if (!p->unit.empty()) {
        EXPECT_THAT(text, testing::HasSubstr(std::string(p->unit))) << name;
      }
    }
  }
  EXPECT_GT(keys, 200u) << "the sections are open";
  for (const auto& [name, key] : {std::pair("simulation/run", "Space"), std::pair("scene/reload", "Ctrl+L"),
                                  std::pair("camera/home", "Home"), std::pair("simulation/step", ".")})
    EXPECT_THAT(explanations().at(name), testing::HasSubstr(std::string("Key: ") + key)) << name;
}

TEST_F(Layout, NothingIsCutOffAndNothingOverlaps) {
  open("cube-and-balls", {}, "reference", with_sections(true));
  for (const auto& [width, height] : {std::pair(1280, 720), std::pair(1920, 1080), std::pair(800, 600)}) {
    resize(width, height);
    for (const double size : {1.0, 1.5, 2.0}) {
      app().layout.text_size = size;
      frames(3);
      const std::string at = fmt::format("{} x {}, text {}", width, height, size);
      const Box view = app().view.box;
      EXPECT_GE(view.right - view.left, 0.29 * width) << at;
      const bool two = view.right < width;
      std::vector<std::pair<std::string, Box>> boxes;
      for (const auto& [name, box] : widgets()) {
        if (!name.starts_with("layout/l") && !name.starts_with("layout/right")) boxes.emplace_back(name, box);
      }
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        const auto& [name, b] = boxes[i];
        // The bar is under the image, and the large buttons in it.
        const bool in_view = name == "timeline" || name.starts_with("actions/");
        if (in_view) {
          EXPECT_GE(b.left, view.left) << name << " at " << at;
          EXPECT_LE(b.right, view.right) << name << " at " << at;
        }
        const bool left = b.left < view.left;
        if (!in_view) {
          EXPECT_GE(b.left, left ? 0.0 : view.right) << name << " at " << at;
          EXPECT_LE(b.right, left ? view.left : two ? width : 0.0) << name << " at " << at;
        }
        EXPECT_GT(b.right - b.left, 8.0 * size) << name << " at " << at;
        for (std::size_t j = i + 1; j < boxes.size(); ++j) {
          const Box& o = boxes[j].second;
          const double wide = std::min(b.right, o.right) - std::max(b.left, o.left);
          const double high = std::min(b.bottom, o.bottom) - std::max(b.top, o.top);
          EXPECT_FALSE(wide > 0.5 && high > 0.5) << name << " and " << boxes[j].first << " at " << at;
        }
      }
    }
  }
}

TEST_F(Layout, PanelsAndCameraComeBackAsTheyWereLeft) {
  open("cube-plane");
  click("section/Performance");
  click("section/Scene");
  click("section/Simulation");
  click("section/Contact");
  const Box edge = box("layout/left");
  drag(GLFW_MOUSE_BUTTON_LEFT, edge.center_x(), edge.center_y(), 55, 0);
  frames(2);
  const double left = app().view.box.left;
  EXPECT_GT(left, 322 + 20);
  app().view.camera.orbit(0.1, 0.05);
  rest();
  const CameraSettings plane = app().view.camera.goal();
  app().scene.open("cube-sphere");
  app().view.camera.zoom(3);
  rest();
  const CameraSettings sphere = app().view.camera.goal();
  simulation().pacer().set_pace(Pace::real_time);
  simulation().pacer().set_speed(0.5);
  app().video.settings.format = find_video_format("webm");
  const app::KeptState kept = app().kept_state();
  close();

  const auto read = app::read_kept_state(app::to_text(kept));
  ASSERT_TRUE(read.ok()) << read.error().message();
  open("cube-sphere", {}, "", *read);
  EXPECT_EQ(app().view.camera.shown(), sphere) << "to the bit";
  EXPECT_NEAR(app().view.box.left, left, 1e-9);
  EXPECT_TRUE(has("contact.model"));
  EXPECT_TRUE(has("section/Performance"));
  EXPECT_EQ(simulation().pacer().pace(), Pace::real_time);
  EXPECT_EQ(simulation().pacer().speed(), 0.5);
  EXPECT_EQ(app().video.settings.format, find_video_format("webm"));
  app().scene.open("cube-plane");
  EXPECT_EQ(app().view.camera.shown(), plane);
  press(GLFW_KEY_HOME);
  rest();
  EXPECT_EQ(app().view.camera.shown(), app().scene.editor().scene().view.camera) << "the scene's own";
  EXPECT_EQ(app().kept_state().cameras.size(), 1u) << "what is as the scene says needs no keeping";
  click("layout/reset");
  EXPECT_EQ(app().view.box.left, 322.0);
  EXPECT_FALSE(has("contact.model"));
  EXPECT_EQ(app().kept_state().layout, app::Layout());
}

TEST_F(Layout, AFirstStartIsALessonInRealTimeAndSaysTheKeysOnce) {
  open("cube-plane", {}, "", app::KeptState());
  EXPECT_EQ(simulation().pacer().pace(), Pace::real_time);
  for (const char* widget :
       {"scene/search", "simulation/run", "springs/all/stiffness", "view.color", "energy/plot"})
    EXPECT_TRUE(has(widget)) << widget;
  // In sight, without scrolling, as it is at first.
  app().layout.reset();
  frames(2);
  for (const char* widget : {"actions/start", "actions/reset", "actions/compare", "actions/video",
                             "energy/plot", "energy/plot/total", "springs/all/stiffness", "view.color"})
    EXPECT_LT(box(widget).bottom, 690.0) << widget;
  for (const char* widget : {"cube[0].edge-length", "cube[0].shear.stiffness", "contact.model", "balls/throw",
                             "record/format", "shadow/on", "stability/map"})
    EXPECT_FALSE(has(widget)) << widget;
  EXPECT_EQ(app().layout.row().open.size(), 5u);
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_GT(box("notice/close").top, app().view.box.center_y()) << "below the body before it falls";
  for (const char* key : {"Space", "Ctrl+drag", "F1", "Ctrl+P"})
    EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr(key));
  const app::KeptState kept = app().kept_state();
  close();
  open("cube-plane", {}, "", kept);
  EXPECT_FALSE(app().messages.notice().has_value()) << "once is enough";
}

TEST_F(Layout, ComesBackAsItWasLeftHoweverItIsChosen) {
  open("cube-plane", {}, "reference");
  click("section/Contact");
  app().layout.right_width = 400.0;
  const auto shown = [&]() -> app::Layout {
    const app::Layout& now = app().layout;
    return now;
  };
  const app::Layout standard = shown();
  std::map<std::string, app::Layout> seen;
  for (const app::LayoutRow& row : app::layouts()) {
    EXPECT_EQ(app().layout.row().name, row.name);
    frames(2);
    seen[std::string(row.name)] = shown();
    for (const std::string_view section : row.open)
      EXPECT_EQ(has(fmt::format("section/{}", section)), app().layout.panels)
          << section << " of " << row.name;
    EXPECT_EQ(has("clock"), row.clock) << row.name;
    EXPECT_EQ(app().gui().scale(), row.text_size) << row.name;
    press(GLFW_KEY_L);
  }
  EXPECT_EQ(app().layout.row().name, app::layouts().front().name) << "L goes round";
  EXPECT_EQ(app().layout, standard);
  frames(1);
  EXPECT_TRUE(has("contact.model"));
  const auto read = app::read_kept_state(app::to_text(app().kept_state()));
  ASSERT_TRUE(read.ok()) << read.error().message();
  EXPECT_EQ(read->layout, app().layout);
  bring_into_sight("layout/name");
  click("layout/name");
  click("layout/name/lab");
  EXPECT_EQ(app().layout, seen.at("lab"));
  press(GLFW_KEY_P, GLFW_MOD_CONTROL);
  frames(2);
  for (const char32_t c : U"layout lecture") {
    if (c != 0) app().character(c);
    frames(1);
  }
  press(GLFW_KEY_ENTER);
  frames(2);
  EXPECT_EQ(app().layout.row().name, "lecture");
}

TEST_F(Layout, OfAVideoIsTheImageAlone) {
  app::KeptState kept;
  kept.greeted = true;
  kept.layout.choose(*app::find_layout("video"));
  open("cube-plane", {"cube[0].position=[0,2.5,0]"}, "reference", kept);
  EXPECT_EQ(app().view.box, (Box{0, 0, 1280, 720}));
  app().messages.dismiss();
  app().cursor(middle_x(), middle_y());
  frames(4);
  EXPECT_TRUE(app().pointer.hovered().has_value());
  EXPECT_THAT(widgets(), testing::IsEmpty()) << "no readout, no panel";
  press(GLFW_KEY_TAB);
  frames(2);
  EXPECT_TRUE(has("record/format"));
}

TEST_F(Layout, ACameraOfTheCommandLineGoesFirst) {
  app::KeptState kept;
  kept.cameras = {{"cube-plane", {{1, 2, 3}, {0, 0, 0}, 30}}};
  open("cube-plane", {"view.camera.fov=20"}, "", kept);
  EXPECT_EQ(app().view.camera.shown().fov, 20.0);
}

TEST_F(Layout, TextAndPanelsGrowTogether) {
  open("cube-plane");
  const Box before = box("simulation/run");
  app().layout.text_size = 1.5;
  frames(2);
  const Box after = box("simulation/run");
  EXPECT_NEAR(after.bottom - after.top, 1.5 * (before.bottom - before.top), 2.0);
  EXPECT_NEAR(app().view.box.left, 1.5 * 322, 1.0);
  EXPECT_EQ(app().kept_state().layout.text_size, 1.5);
  app().layout.text_size = 1.0;
  frames(2);
  const Box back = box("simulation/run");
  EXPECT_EQ(back, before);
}

TEST_F(Layout, TheSliderChangesTextOnceItIsLetGo) {
  open("cube-plane", {}, "", with_sections(false));
  click("section/View");
  const Box slider = box("layout/text-size");
  drag(GLFW_MOUSE_BUTTON_LEFT, slider.center_x(), slider.center_y(), 20, 0);
  frames(3);
  EXPECT_GT(app().gui().scale(), 1.2);
  EXPECT_EQ(app().gui().scale(), app().layout.text_size);
}

TEST_F(Layout, CameraPresetsTurnAboutTheTarget) {
  open("cube-plane", {}, "", with_sections(false));
  click("section/View");
  const CameraSettings home = app().view.camera.goal();
  const double distance = length(home.position - home.target);
  const std::pair<const char*, Vec3> cases[] = {{"camera/front", {0, 0, distance}},
                                                {"camera/side", {distance, 0, 0}}};
  for (const auto& [name, offset] : cases) {
    click(name);
    rest();
    const CameraSettings shown = app().view.camera.shown();
    EXPECT_NEAR(length(shown.position - (home.target + offset)), 0.0, 1e-9) << name;
  }
  click("camera/top");
  rest();
  EXPECT_NEAR(app().view.camera.shown().position.y - home.target.y, distance, 1e-3 * distance);
  click("camera/isometric");
  rest();
  const Vec3 d = app().view.camera.shown().position - home.target;
  EXPECT_NEAR(d.x, d.y, 1e-9);
  EXPECT_NEAR(d.y, d.z, 1e-9);
  click("camera/home");
  rest();
  EXPECT_EQ(app().view.camera.shown(), home);
}

}  // namespace
}  // namespace aspic::test

// The image in the window: fine at rest, quick in motion; what is drawn over it, and what is saved of it.
#include <gmock/gmock.h>
#include <imgui_internal.h>
#include <stb_image.h>

#include "app/stage.h"
#include "io/atomic_file.h"

namespace aspic::test {
namespace {

class SavedImage : public Stage {
 protected:
  /// A body so large that images begin coarsely, in motion for a while.
  void open_busy(std::vector<std::string> overrides = {}) {
    overrides.emplace_back("cube[0].particles-per-edge=24");
    open("cube-plane", std::move(overrides), "cpu");
    press(GLFW_KEY_SPACE);
    frames(1);
    ASSERT_LT(app().image.pixels().width(), view_width());
  }
  int view_width() { return static_cast<int>(app().view.box.right - app().view.box.left); }
  /// What the window shows of the scene.
  Image view() {
    const Image window = image();
    const app::Box& box = app().view.box;
    Image view{static_cast<int>(box.right - box.left), static_cast<int>(box.bottom - box.top), {}};
    for (int y = 0; y < view.height; ++y) {
      const std::ptrdiff_t first =
          static_cast<int>(box.left) + (static_cast<int>(box.top) + y) * window.width;
      const auto row = window.rgb.begin() + 3 * first;
      view.rgb.insert(view.rgb.end(), row, row + std::ptrdiff_t{3} * view.width);
    }
    return view;
  }
  Image saved(const std::string& name) {
    Image image;
    int channels = 0;
    unsigned char* const rgb =
        stbi_load((directory() / name).c_str(), &image.width, &image.height, &channels, 3);
    EXPECT_TRUE(rgb);
    for (int i = 0; rgb && i < 3 * image.width * image.height; ++i)
      image.rgb.push_back(static_cast<std::byte>(rgb[i]));
    stbi_image_free(rgb);
    return image;
  }
  static bool tooltip_shown() {
    const ImGuiWindow* const window = ImGui::FindWindowByName("##Tooltip_00");
    return window && window->Active;
  }
};

TEST_F(SavedImage, HalfASecondAfterABusyMomentItIsFineAndStaysSo) {
  open_busy();
  press(GLFW_KEY_SPACE);
  ASSERT_TRUE(simulation().settle().ok());
  frames(30);
  EXPECT_EQ(app().image.pixels().width(), view_width());
  const Image fine = view();
  const std::uint64_t number = app().image.number();
  // What does not change the image does not make it coarse.
  app().cursor(3.0, 3.0);
  press(GLFW_KEY_ESCAPE);
  frames(20);
  EXPECT_EQ(app().image.number(), number);
  app().image.full_quality = true;
  drag(GLFW_MOUSE_BUTTON_LEFT, middle_x(), middle_y(), 90, 0);
  press(GLFW_KEY_HOME);
  frames_to_rest();
  app().cursor(3.0, 3.0);
  frames(20);
  EXPECT_EQ(view().rgb, fine.rgb) << "as hardware draws it";
}

TEST_F(SavedImage, TheFineOneIsDrawnInPartsAndGivenUpWhenSomethingChanges) {
  open_busy();
  press(GLFW_KEY_SPACE);
  ASSERT_TRUE(simulation().settle().ok());
  app::SceneImage& image = app().image;
  image.part_seconds = 0.0;  // one pass at a time
  for (int i = 0; i < 60 && !image.refining(); ++i) frame();
  ASSERT_TRUE(image.refining());
  const std::uint64_t number = image.number();
  const int coarse = image.pixels().width();
  for (int i = 0; i < 5; ++i) {
    frame();
    ASSERT_TRUE(image.refining());
    EXPECT_FALSE(app().idle()) << "the next part is due";
    EXPECT_EQ(image.pixels().width(), coarse) << "shown meanwhile";
  }
  EXPECT_EQ(image.number(), number);
  type(U'.');
  ASSERT_TRUE(simulation().settle().ok());
  frame();
  EXPECT_FALSE(image.refining());
  EXPECT_GT(image.number(), number) << "another coarse one";
  frames(30);
  EXPECT_EQ(image.pixels().width(), view_width());
  EXPECT_FALSE(image.refining());
}

TEST_F(SavedImage, AColorThatNeedsMoreThanABlockBecomesANotice) {
  open("flag", {"view.color=material"},
       "reference");  // on which images hold the words of springs themselves
  frames(2);
  const gl::DeviceLimits own = context().info().limits;
  gl::DeviceLimits small = own;
  small.storage_block_bytes = 16u << 10;
  context().assume_limits(small);
  const Image plain = view();
  app().scene.set_value(*find_parameter("view.color"), 0, Value("strain"), "");
  frames(3);
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_TRUE(app().messages.notice()->is_error);
  EXPECT_THAT(app().messages.notice()->text, ::testing::HasSubstr("Cannot show this color"));
  EXPECT_THAT(app().messages.notice()->text, ::testing::HasSubstr("incident springs"));
  press(GLFW_KEY_SPACE);
  frames_to_step(3);
  context().assume_limits(own);
  frames(3);
  EXPECT_NE(view().rgb, plain.rgb) << "there is room again";
}

TEST_F(SavedImage, ASavedImageIsFineAndWithoutPanels) {
  open_busy();
  press(GLFW_KEY_F12);
  frames(1);
  const Image image = saved("aspic-cube-plane-0001.png");
  EXPECT_EQ(image.width, view_width());
  press(GLFW_KEY_F12, GLFW_MOD_SHIFT);
  frames(1);
  const Image window = saved("aspic-cube-plane-0002.png");
  EXPECT_EQ(window.width, window_size()[0]);
  press(GLFW_KEY_SPACE);
  ASSERT_TRUE(simulation().settle().ok());
  frames(30);
  press(GLFW_KEY_F12);
  frames(1);
  const Image still = saved("aspic-cube-plane-0003.png");
  frames(2);
  app().messages.dismiss();
  frames(2);
  const Image shown = view();
  ASSERT_EQ(still.rgb.size(), shown.rgb.size());
  // Down to the large buttons, which are no part of a saved image.
  const auto rows = static_cast<std::size_t>(widgets().at("actions/start").top - app().view.box.top - 10.0);
  const std::size_t bytes = 3 * rows * static_cast<std::size_t>(shown.width);
  ASSERT_LT(bytes, shown.rgb.size());
  int largest = 0;
  for (std::size_t i = 0; i < bytes; ++i)
    largest =
        std::max(largest, std::abs(std::to_integer<int>(still.rgb[i]) - std::to_integer<int>(shown.rgb[i])));
  EXPECT_LE(largest, 1) << "encoded anew on its way into the window";
}

TEST_F(SavedImage, SavedImagesHaveTheSizeAndBackgroundThatWereChosen) {
  open("cube-plane", {"cube[0].position=[0,3,0]"}, "reference");
  frames(30);
  app().messages.dismiss();
  const Image before = view();
  app().image.saved = {1, true};
  press(GLFW_KEY_F12);
  frames(1);
  int width = 0, height = 0, channels = 0;
  unsigned char* const rgba =
      stbi_load((directory() / "aspic-cube-plane-0001.png").c_str(), &width, &height, &channels, 4);
  ASSERT_TRUE(rgba);
  EXPECT_EQ(width, 2 * view_width());
  EXPECT_EQ(channels, 4);
  int clear = 0, covered = 0, red = 0;
  for (int i = 0; i < width * height; ++i) {
    const unsigned char* const p = rgba + std::ptrdiff_t{4} * i;
    clear += p[3] == 0 ? 1 : 0;
    covered += p[3] > 200 ? 1 : 0;
    red += p[3] > 200 && p[0] > p[2] ? 1 : 0;
  }
  stbi_image_free(rgba);
  EXPECT_GT(clear, width * height / 2);
  EXPECT_GT(covered, width * height / 200);
  EXPECT_GT(red, 9 * covered / 10) << "the jelly's own color";
  app().messages.dismiss();
  frames(2);
  EXPECT_EQ(view().rgb, before.rgb) << "the window shows what it showed";
}

TEST_F(SavedImage, TheLegendIsOfTheWindowsPixels) {
  open_busy({"view.color=strain"});
  ASSERT_TRUE(has("legend"));
  const app::Box coarse = widgets().at("legend");
  press(GLFW_KEY_SPACE);
  ASSERT_TRUE(simulation().settle().ok());
  frames(30);
  EXPECT_EQ(widgets().at("legend"), coarse);
  EXPECT_LT(coarse.right - coarse.left, 260.0);
  EXPECT_GE(coarse.right, app().view.box.right - 60.0);
  app().scene.set_value(*find_parameter("view.color"), 0, Value("material"), "");
  frames(2);
  EXPECT_FALSE(has("legend"));
}

TEST_F(SavedImage, TooltipsWaitAndStandBesideThePanel) {
  open("cube-plane", {}, "reference");
  resize(roomy[0], roomy[1]);
  bring_into_sight("simulation/run");
  const app::Box start = widgets().at("simulation/run");
  app().cursor(start.center_x(), start.center_y());
  frames(10);
  EXPECT_FALSE(tooltip_shown());
  frames(40);
  ASSERT_TRUE(tooltip_shown());
  EXPECT_GE(ImGui::FindWindowByName("##Tooltip_00")->Pos.x, app().view.box.left);
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
  frames(60);
  EXPECT_FALSE(tooltip_shown()) << "none while something is held";
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
}

class SmallImage : public SavedImage {
 protected:
  std::array<int, 2> window_size() const override { return {800, 600}; }
};

TEST_F(SmallImage, TheReadoutOfAParticleIsInTheView) {
  open("goal-net", {}, "reference");
  const app::Box view = app().view.box;
  for (double x = view.left + 20.0; x < view.right && !app().pointer.hovered(); x += 12.0) {
    for (double y = view.center_y(); y < view.bottom && !app().pointer.hovered(); y += 25.0) {
      app().cursor(x, y);
      frames(3);
    }
  }
  ASSERT_TRUE(app().pointer.hovered());
  frames(2);
  const app::Box readout = widgets().at("particle");
  EXPECT_GE(readout.left, view.left);
  EXPECT_LE(readout.right, view.right);
  EXPECT_LE(readout.bottom, view.bottom);
  EXPECT_GE(readout.top, view.top);
}

TEST_F(SmallImage, TheReadoutStaysInItsCornerWhenALegendAppears) {
  open("cube-plane", {"cube[0].position=[0,3,0]"}, "reference");
  app().cursor(middle_x(), middle_y());
  frames(5);
  ASSERT_TRUE(app().pointer.hovered());
  const app::Box before = widgets().at("particle");
  app().scene.change("color", [](Scene& s) { s.view.color = ViewColor::strain; });
  frames(5);
  ASSERT_TRUE(has("legend"));
  const app::Box after = widgets().at("particle"), legend = widgets().at("legend");
  EXPECT_EQ(after.left, before.left);
  EXPECT_LT(after.left, app().view.box.center_x());
  EXPECT_GT(after.bottom, app().view.box.center_y());
  EXPECT_TRUE(after.right <= legend.left || after.bottom <= legend.top) << "beside or above the legend";
}

TEST_F(SmallImage, AxesGiveWayToTheReadout) {
  open("goal-net", {"view.axes=true", "view.color=speed"}, "reference");
  for (const auto& [width, height] : {std::pair(800, 600), std::pair(600, 420), std::pair(420, 320)}) {
    resize(width, height);
    frames(2);
    const app::Box view = app().view.box;
    app().cursor(view.left - 1.0, view.top - 1.0);
    frames(3);
    for (double x = view.left + 10.0; x < view.right && !app().pointer.hovered(); x += 12.0) {
      for (double y = view.center_y(); y < view.bottom && !app().pointer.hovered(); y += 25.0) {
        app().cursor(x, y);
        frames(3);
      }
    }
    ASSERT_TRUE(app().pointer.hovered()) << width;
    frames(2);
    if (width == 800) {
      EXPECT_TRUE(has("axes")) << "here there is room";
    }
    if (!has("axes")) continue;
    const app::Box axes = widgets().at("axes");
    for (const char* name : {"particle", "legend"}) {
      const app::Box box = widgets().at(name);
      EXPECT_TRUE(axes.right <= box.left || box.right <= axes.left || axes.bottom <= box.top ||
                  box.bottom <= axes.top)
          << name << " at " << width;
    }
  }
}

}  // namespace
}  // namespace aspic::test

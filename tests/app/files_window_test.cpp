// Scenes and their files: opening, saving, reloading, and where a scene is seen from at first.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "app/parameter_widget.h"
#include "app/stage.h"
#include "aspic/scene.h"
#include "model/integrator.h"
#include "model/terrain.h"
#include "support/projection.h"

namespace aspic::test {
namespace {

class Files : public Stage {
 protected:
  void set(std::string_view path, const Value& value) {
    app().scene.set_value(*find_parameter(path), 0, value, "");
    frames(2);
  }
  std::string write(const std::string& name, const std::string& text) {
    const std::string path = (directory() / name).string();
    std::ofstream(path) << text;
    // Two writes within the clock's grain have the same time.
    std::filesystem::last_write_time(
        path, std::filesystem::last_write_time(path) + std::chrono::seconds(++writes_));
    return path;
  }
  /// Opens the palette and types.
  void ask(std::u32string_view query) {
    press(GLFW_KEY_P, GLFW_MOD_CONTROL);
    frames(3);
    for (const char32_t c : query) type(c);
    frames(2);
  }
  static std::string scene_text(int n) {
    return "schema = 1\n[[cube]]\nparticles-per-edge = " + std::to_string(n) + "\n";
  }

 private:
  int writes_ = 0;
};

TEST_F(Files, DroppedSceneOpensAndABrokenOneDoesNot) {
  open("cube-plane");
  app().drop({write("mine.toml", scene_text(4))});
  EXPECT_EQ(simulation().model().particle_count(), 64u);
  app().drop({write("broken.toml", "schema = 1\n[[cube]]\nparticles-per-edge = two\n")});
  EXPECT_EQ(simulation().model().particle_count(), 64u);
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("broken.toml:3"));
}

TEST_F(Files, ReloadsWhenTheFileChangesAndKeepsTheOldSceneWhileItIsBroken) {
  open(write("mine.toml", scene_text(4)));
  write("mine.toml", scene_text(3));
  frames(40);
  EXPECT_EQ(simulation().model().particle_count(), 27u);
  write("mine.toml", "schema = 1\n[[cube]]\nparticles-per-edge = 1\n");
  frames(40);
  EXPECT_EQ(simulation().model().particle_count(), 27u);
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("mine.toml:3"));
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("particles-per-edge = 1"))
      << "the line itself";
  write("mine.toml", scene_text(5));
  frames(40);
  EXPECT_EQ(simulation().model().particle_count(), 125u);
}

TEST_F(Files, BrokenAndMendedWhileItRuns) {
  open(write("mine.toml", scene_text(4)), {}, "reference");
  press(GLFW_KEY_SPACE);
  frames_to_step(20);
  write("mine.toml", scene_text(4) + "[contact]\nfriction = much\n");
  frames_until([&] { return app().messages.notice() && app().messages.notice()->is_error; });
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("mine.toml:5"));
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("friction = much"));
  EXPECT_TRUE(simulation().running()) << "the old scene keeps running";
  frames_to_step(simulation().step() + 20);
  EXPECT_TRUE(app().messages.notice() && app().messages.notice()->is_error)
      << "the message stays as long as the file is broken";
  const std::uint64_t before = simulation().step();
  write("mine.toml", scene_text(4) + "[contact]\nfriction = 0.9\n");
  frames_until([&] { return simulation().model().contact.friction == 0.9; });
  EXPECT_FALSE(app().messages.notice() && app().messages.notice()->is_error) << "mended";
  EXPECT_TRUE(simulation().running());
  EXPECT_GE(simulation().step(), before) << "constants alone: the motion goes on";
  frames_to_step(before + 20);
  // Broken and mended to the very same content: the message goes too.
  write("mine.toml", "[");
  frames_until([&] { return app().messages.notice() && app().messages.notice()->is_error; });
  write("mine.toml", scene_text(4) + "[contact]\nfriction = 0.9\n");
  frames_until([&] { return !(app().messages.notice() && app().messages.notice()->is_error); });
  EXPECT_TRUE(simulation().running());
}

TEST_F(Files, AFileWithOtherConstantsLetsTheMotionGoOn) {
  open(write("mine.toml", scene_text(4)));
  for (int i = 0; i < 6; ++i) type(U'.');
  const std::string hash = state_hash_text(simulation().snapshot());
  drag(GLFW_MOUSE_BUTTON_LEFT, middle_x(), middle_y(), 90, -30);
  const CameraSettings camera = app().view.camera.goal();
  write("mine.toml", scene_text(4) + "[contact]\nfriction = 0.9\n");
  frames(40);
  EXPECT_EQ(simulation().model().contact.friction, 0.9);
  EXPECT_EQ(simulation().step(), 6u);
  EXPECT_EQ(state_hash_text(simulation().snapshot()), hash);
  EXPECT_EQ(app().view.camera.goal(), camera) << "the camera stays where it was put";
}

TEST_F(Files, SavedSceneHoldsChangesAndCamera) {
  open("cube-plane");
  set("cube[].shear.stiffness", 1234.5);
  app().scroll(0, 0);
  drag(GLFW_MOUSE_BUTTON_LEFT, middle_x(), middle_y(), 90, -30);
  app().scene.save_as("saved.toml");
  const auto saved = load_scene((directory() / "saved.toml").string());
  ASSERT_TRUE(saved.ok()) << saved.error().message();
  EXPECT_EQ(saved->model.cubes[0].shear.stiffness, 1234.5);
  EXPECT_EQ(saved->view.camera, app().view.camera.goal());
  app().scene.save_as("saved.toml");
  EXPECT_TRUE(app().messages.notice() && app().messages.notice()->is_error) << "nothing is overwritten";
}

TEST_F(Files, ASceneIsSavedAgainAndIsTheOneThatIsOpen) {
  open("cube-plane", {}, "reference");
  set("contact.friction", 0.35);
  EXPECT_THAT(app().title(), testing::HasSubstr("(changed)"));
  press(GLFW_KEY_S, GLFW_MOD_CONTROL);
  frames(3);
  press(GLFW_KEY_ENTER);  // the name is there and has the keyboard
  frames(3);
  EXPECT_EQ(load_scene((directory() / "cube-plane.toml").string())->model.contact.friction, 0.35);
  EXPECT_THAT(app().title(), testing::Not(testing::HasSubstr("(changed)")));
  EXPECT_TRUE(app().scene.editor().is_file());
  set("contact.friction", 0.4);
  EXPECT_THAT(app().title(), testing::HasSubstr("(changed)"));
  press(GLFW_KEY_S, GLFW_MOD_CONTROL);
  frames(3);
  press(GLFW_KEY_ENTER);
  frames(3);
  press(GLFW_KEY_ENTER);
  frames(3);
  EXPECT_EQ(load_scene((directory() / "cube-plane.toml").string())->model.contact.friction, 0.4);
  frames(60);
  EXPECT_TRUE(app().scene.editor().can_undo()) << "what was saved is not read as a change of the file";
  EXPECT_FALSE(app().messages.notice() && app().messages.notice()->is_error);
}

TEST_F(Files, ABrowserFindsAndOpensAFile) {
  std::filesystem::create_directory(directory() / "scenes");
  write("scenes/other.toml", scene_text(3));
  write("scenes/notes.txt", "no scene");
  open("cube-plane", {}, "reference");
  press(GLFW_KEY_O, GLFW_MOD_CONTROL);
  frames(3);
  click("files/entry/scenes");
  EXPECT_FALSE(has("files/entry/notes.txt"));
  click("files/entry/other.toml");
  click("files/accept");
  EXPECT_EQ(simulation().model().particle_count(), 27u);
  EXPECT_FALSE(has("files/name"));
  press(GLFW_KEY_O, GLFW_MOD_CONTROL);
  frames(3);
  press(GLFW_KEY_ESCAPE);
  frames(3);
  EXPECT_FALSE(has("files/name"));
}

TEST_F(Files, TypingReplacesTheNameThatIsSuggested) {
  open("cube-plane", {}, "reference");
  press(GLFW_KEY_S, GLFW_MOD_CONTROL);
  frames(3);
  type(U'm');
  type(U'y');
  frames(2);
  press(GLFW_KEY_ENTER);
  frames(3);
  EXPECT_TRUE(std::filesystem::exists(directory() / "my.toml"));
  EXPECT_FALSE(has("files/name"));
}

TEST_F(Files, AFileThatIsNotThereIsSaid) {
  open("cube-plane", {}, "reference");
  press(GLFW_KEY_O, GLFW_MOD_CONTROL);
  frames(3);
  for (const char32_t c : std::u32string_view(U"none.toml")) type(c);
  frames(2);
  EXPECT_FALSE(has("files/missed"));
  press(GLFW_KEY_ENTER);
  frames(3);
  EXPECT_TRUE(has("files/missed"));
  EXPECT_TRUE(has("files/name")) << "and asked for again";
  type(U'x');
  frames(3);
  EXPECT_FALSE(has("files/missed")) << "until another is typed";
}

TEST_F(Files, AFileThatWasWrittenIsAChangeThatCanBeUndone) {
  open(write("mine.toml", scene_text(4)), {}, "reference");
  set("contact.friction", 0.35);
  write("mine.toml", scene_text(4) + "[contact]\nrestitution = 0.2\n");
  frames(40);
  EXPECT_EQ(simulation().model().contact.restitution, 0.2);
  EXPECT_NE(simulation().model().contact.friction, 0.35);
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("Undo restores"));
  EXPECT_FALSE(app().scene.editor().changed());
  EXPECT_EQ(app().title(), "mine.toml - Aspic");
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(3);
  EXPECT_EQ(simulation().model().contact.friction, 0.35) << "the changes made here";
  EXPECT_TRUE(app().scene.editor().changed());
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  frames(3);
  EXPECT_EQ(simulation().model().contact.restitution, 0.2);
}

TEST_F(Files, TheSearchOpensTheOnlySceneThatIsLeft) {
  open("cube-plane", {}, "reference");
  click("scene/search");
  for (const char32_t c : std::u32string_view(U"torus")) type(c);
  frames(3);
  EXPECT_TRUE(has("scene/cube-plane")) << "the one that is open";
  EXPECT_TRUE(has("scene/cube-torus"));
  EXPECT_FALSE(has("scene/flag"));
  press(GLFW_KEY_ENTER);
  frames(3);
  EXPECT_EQ(app().scene.editor().source(), "cube-torus");
  EXPECT_TRUE(has("scene/flag"));
  click("scene/search");
  type(U'q');
  frames(3);
  click("scene/search/clear");
  EXPECT_TRUE(has("scene/flag"));
}

TEST_F(Files, ThePaletteFindsActionsScenesAndValues) {
  open("cube-plane", {}, "reference");
  ask(U"start pause");
  ASSERT_TRUE(has("palette/start or pause"));
  press(GLFW_KEY_ENTER);
  frames(3);
  EXPECT_TRUE(simulation().running());
  EXPECT_FALSE(has("palette/query"));
  press(GLFW_KEY_SPACE);
  ask(U"BOWL");
  click("palette/open cube-bowl");
  EXPECT_EQ(app().scene.editor().source(), "cube-bowl");
  ask(U"friction");
  EXPECT_TRUE(has("contact.friction")) << "a value is changed where it is found";
  EXPECT_FALSE(has("palette/start or pause"));
  press(GLFW_KEY_ESCAPE);
  frames(2);
  EXPECT_FALSE(has("palette/query"));
}

TEST_F(Files, ThePaletteFindsValuesBeforeScenesAndSectionsToo) {
  open("cube-plane", {}, "reference");
  const auto marked = [&](const std::string& widget) {
    const app::Box row = widgets().at("palette/marked"), own = widgets().at(widget);
    return std::abs(row.center_y() - own.center_y()) < 8.0;
  };
  // A scene's description speaks of gravity; the value has the name.
  ask(U"gravity");
  EXPECT_FALSE(has("palette/open flag"));
  EXPECT_TRUE(marked("simulation.gravity"));
  press(GLFW_KEY_ENTER);
  frames(4);
  for (const char32_t c : std::u32string_view(U"2")) type(c);
  frames(2);
  press(GLFW_KEY_ENTER);
  frames(4);
  EXPECT_EQ(app().scene.scene().model.simulation.gravity.x, 2.0) << "Enter began typing there";
  EXPECT_EQ(app().scene.editor().source(), "cube-plane");
  ASSERT_TRUE(has("palette/query"));
  // No key reaches the window meanwhile; what is typed now is the next query.
  press(GLFW_KEY_SPACE);
  press(GLFW_KEY_TAB);
  frames(2);
  EXPECT_FALSE(simulation().running());
  EXPECT_TRUE(app().layout.panels);
  press(GLFW_KEY_ESCAPE);
  frames(2);

  ask(U"stiffness");
  press(GLFW_KEY_DOWN);
  frames(2);
  EXPECT_TRUE(marked("cube[0].shear.stiffness"));
  press(GLFW_KEY_ENTER);
  frames(4);
  for (const char32_t c : std::u32string_view(U"123")) type(c);
  frames(2);
  press(GLFW_KEY_ENTER);
  frames(4);
  EXPECT_EQ(app().scene.scene().model.cubes[0].shear.stiffness, 123.0);
  for (const char32_t c : std::u32string_view(U"integrator")) type(c);
  frames(3);
  EXPECT_TRUE(marked("simulation.integrator")) << "the next one is looked for at once";
  press(GLFW_KEY_ENTER);
  frames(3);
  EXPECT_EQ(app().scene.scene().model.simulation.integrator, Integrator::symplectic_euler)
      << "the next of its words";
  press(GLFW_KEY_ESCAPE);
  frames(2);

  EXPECT_FALSE(has("stability/map"));
  ask(U"stability");
  EXPECT_TRUE(marked("palette/section Stability"));
  press(GLFW_KEY_ENTER);
  frames(3);
  ASSERT_TRUE(has("section/Stability"));
  EXPECT_TRUE(app().layout.sections.at("Stability"));
  EXPECT_LT(widgets().at("section/Stability").bottom, 720.0) << "scrolled into sight";
  ask(U"by material");
  EXPECT_TRUE(has("palette/section Springs"));
  app().cursor(middle_x(), app().view.box.bottom - 20.0);
  frames(1);
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
  frames(1);
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
  frames(2);
  EXPECT_FALSE(has("palette/query")) << "a click elsewhere closes it";
}

TEST_F(Files, OpeningAnotherSceneIsTakenBackByUndo) {
  open("cube-plane", {}, "reference");
  app().scene.set_value(*find_parameter("simulation.gravity"), 0, Value(Vec3{0.0, -3.0, 0.0}));
  frames(3);
  EXPECT_EQ(app().title(), "cube-plane (changed) - Aspic");
  type(U'.');
  frames(2);
  click("scene/cube-bowl");
  EXPECT_EQ(app().title(), "cube-bowl - Aspic");
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(3);
  EXPECT_EQ(app().title(), "cube-plane (changed) - Aspic");
  EXPECT_EQ(simulation().model().simulation.gravity, (Vec3{0.0, -3.0, 0.0}));
  EXPECT_EQ(simulation().step(), 0u);
  EXPECT_EQ(app().view.camera.home(), app().scene.scene().view.camera);
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("Undone: open cube-bowl."));
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  frames(3);
  EXPECT_EQ(app().title(), "cube-bowl - Aspic");
  EXPECT_EQ(simulation().model().terrain[0].shape, TerrainShape::bowl);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(3);
  EXPECT_EQ(app().title(), "cube-plane - Aspic");
}

TEST_F(Files, OnePageIsOpenAtATimeAndTheBrowserIsModal) {
  open("cube-plane", {}, "reference");
  press(GLFW_KEY_F1);
  frames(2);
  EXPECT_TRUE(has("help/close"));
  press(GLFW_KEY_P, GLFW_MOD_CONTROL);
  frames(2);
  EXPECT_TRUE(has("palette/query"));
  EXPECT_FALSE(has("help/close"));
  press(GLFW_KEY_ESCAPE);
  press(GLFW_KEY_O, GLFW_MOD_CONTROL);
  frames(3);
  EXPECT_TRUE(has("files/name"));
  press(GLFW_KEY_F1);
  frames(2);
  EXPECT_FALSE(has("files/name"));
  press(GLFW_KEY_O, GLFW_MOD_CONTROL);
  frames(3);
  EXPECT_FALSE(has("help/close"));
  // Neither keys nor clicks reach what is behind it.
  const bool open_before = has("simulation/run");
  click("section/Simulation");
  press(GLFW_KEY_SPACE);
  frames(2);
  EXPECT_EQ(has("simulation/run"), open_before);
  EXPECT_FALSE(simulation().running());
  press(GLFW_KEY_ESCAPE);
  frames(2);
  EXPECT_FALSE(has("files/name"));
  press(GLFW_KEY_SPACE);
  EXPECT_TRUE(simulation().running());
}

TEST_F(Files, OpenedFilesStayInTheList) {
  open("cube-plane", {}, "reference");
  app().scene.save_as("mine.toml");
  frames(2);
  EXPECT_TRUE(has("scene/mine.toml"));
  click("scene/cube-bowl");
  ASSERT_EQ(app().scene.editor().source(), "cube-bowl");
  click("scene/mine.toml");
  EXPECT_EQ(app().scene.editor().source(), "mine.toml");
}

TEST_F(Files, ASpeedThatWasLeftIsSaidAtTheStart) {
  app::KeptState kept;
  kept.greeted = true;
  kept.speed = 0.0625;
  open("cube-plane", {}, "reference", kept);
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("The speed is ×0.0625"));
}

TEST_F(Files, AResetOutOfSightSaysSoAndAPullInAPauseIsStarted) {
  open("cube-plane", {}, "reference");
  // As F frames a cube that has come down.
  app().view.camera.jump_to({{3.0, 0.0, 6.0}, {0.0, -0.5, 0.0}, 30.0, Projection::perspective});
  press(GLFW_KEY_R);
  frames(2);
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("outside the image"));
  // Ctrl is held for the pull.
  press(GLFW_KEY_SPACE, GLFW_MOD_CONTROL);
  EXPECT_TRUE(simulation().running());
  press(GLFW_KEY_SPACE, GLFW_MOD_CONTROL);
  EXPECT_FALSE(simulation().running());
}

TEST_F(Files, IntegratorsHaveTheNamesOfLabels) {
  open("cube-plane", {}, "reference");
  const auto titles = app::titles_of(*find_parameter("simulation.integrator"));
  ASSERT_EQ(titles.size(), integrator_table.size());
  EXPECT_EQ(titles[0], "explicit Euler");
  click("simulation.integrator");
  click("simulation.integrator/implicit-euler");
  EXPECT_EQ(app().scene.scene().model.simulation.integrator, Integrator::implicit_euler);
}

TEST_F(Files, TheSearchShowsNamesBeforeDescriptions) {
  open("cube-plane", {}, "reference");
  click("scene/search");
  for (const char32_t c : std::u32string_view(U"hole")) type(c);
  frames(3);
  EXPECT_LT(widgets().at("scene/cube-hole").top, widgets().at("scene/cube-torus").top);
  click("scene/search/clear");
}

TEST_F(Files, OtherTerrainBeginsAnew) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, "reference");
  for (int i = 0; i < 20; ++i) type(U'.');
  click("terrain/sphere");
  frames(2);
  EXPECT_EQ(simulation().step(), 0u) << "not in the midst of a body";
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(3);
  EXPECT_EQ(simulation().step(), 0u);
  EXPECT_EQ(simulation().model().terrain[0].shape, TerrainShape::plane);
}

TEST_F(Files, ACameraThatSeesNothingIsFramed) {
  app::KeptState kept;
  kept.cameras = {{"cube-plane", {{40.0, 1.0, 0.0}, {60.0, 1.0, 0.0}, 45.0}}};
  kept.layout.panels = false;
  kept.greeted = true;
  open("cube-plane", {}, "reference", kept);
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("Tab"));
  frames_to_rest();
  EXPECT_TRUE(app().view.sees_bodies(simulation().snapshot()));
}

TEST_F(Files, ANarrowViewKeepsTheSidesOfTheScene) {
  open("goal-net", {}, "reference");
  ASSERT_LT(app().view.width(), app().view.height());
  const Camera lens = app().view.lens();
  const Vec3 ball = simulation().snapshot().ball_position[0];
  const auto seen = test::project(lens, ball);
  ASSERT_TRUE(seen.has_value());
  EXPECT_GT(seen->x, 0.0);
  EXPECT_LT(seen->x, app().view.width());
}

TEST_F(Files, TheFirstPaceIsRealTime) {
  EXPECT_EQ(app::KeptState().pace, Pace::real_time);
}

// Nothing is drawn while nothing happens, and the file is looked at all the same.
TEST_F(Files, AWindowAtRestSleepsUntilSomethingHappens) {
  const std::string path = (directory() / "asleep.toml").string();
  const std::string text(*builtin_scene_text("cube-plane"));
  std::ofstream(path) << text;
  open(path, {}, "reference");
  EXPECT_FALSE(app().asleep());
  frames(12, 0.25);
  ASSERT_TRUE(app().asleep());
  EXPECT_FALSE(app().doze(0.6));
  app().cursor(middle_x(), middle_y());
  EXPECT_FALSE(app().asleep()) << "the mouse";
  frames(12, 0.25);
  ASSERT_TRUE(app().asleep());
  app().refresh();
  EXPECT_FALSE(app().asleep()) << "another window went away";
  frames(12, 0.25);
  ASSERT_TRUE(app().asleep());
  press(GLFW_KEY_SPACE);
  EXPECT_FALSE(app().asleep()) << "the motion";
  press(GLFW_KEY_SPACE);
  frames(12, 0.25);
  ASSERT_TRUE(app().asleep());
  std::string changed = text;
  changed.replace(changed.find("timestep = 0.001"), 16, "timestep = 0.002");
  std::ofstream(path) << changed;
  std::filesystem::last_write_time(path, std::filesystem::last_write_time(path) + std::chrono::seconds(2));
  EXPECT_TRUE(app().doze(0.6)) << "the file";
  EXPECT_FALSE(app().asleep());
  frames(2);
  EXPECT_EQ(simulation().model().simulation.timestep, 0.002);
}

}  // namespace
}  // namespace aspic::test

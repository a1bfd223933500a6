#include <gmock/gmock.h>

#include <fstream>

#include "app/stage.h"
#include "scene/load.h"

namespace aspic::test {
namespace {

using app::BackendName;
using app::Effect;

class Panels : public Stage {
 protected:
  void set(std::string_view path, const Value& value, std::size_t index = 0) {
    app().set_value(*find_parameter(path), index, value, "");
    frames(1);
  }
  const ModelSettings& settings() { return app().editor().scene().model; }
};

TEST_F(Panels, ButtonsRunStepAndReset) {
  open("cube-plane", {}, BackendName::reference);
  click("simulation/run");
  EXPECT_TRUE(simulation().running());
  frames_to_step(20);
  click("simulation/run");
  EXPECT_FALSE(simulation().running());
  ASSERT_TRUE(simulation().settle().ok());
  const std::uint64_t step = simulation().step();
  click("simulation/step");
  EXPECT_EQ(simulation().step(), step + 1);
  click("simulation/reset");
  EXPECT_EQ(simulation().step(), 0u);
  click("simulation/backend");
  EXPECT_EQ(simulation().backend(), BackendName::gpu);
}

TEST_F(Panels, ScenesAreChosenByClick) {
  open("cube-plane");
  click("scene/cube-sphere");
  EXPECT_EQ(app().editor().source(), "cube-sphere");
  EXPECT_EQ(simulation().model().terrain.front().shape, TerrainShape::sphere);
  click("terrain/bowl");
  EXPECT_EQ(simulation().model().terrain.front().shape, TerrainShape::bowl);
  EXPECT_EQ(simulation().model().terrain.front().point, (Vec3{2, 7, 1}));
  click("scene/undo");
  EXPECT_EQ(simulation().model().terrain.front().shape, TerrainShape::sphere);
  click("scene/redo");
  EXPECT_EQ(simulation().model().terrain.front().shape, TerrainShape::bowl);
}

TEST_F(Panels, WordsAndFlagsFollowTheTable) {
  open("cube-plane");
  click("simulation.integrator");
  click("simulation.integrator/runge-kutta-4");
  EXPECT_EQ(settings().simulation.integrator, Integrator::runge_kutta_4);
  EXPECT_EQ(simulation().model().simulation.integrator, Integrator::runge_kutta_4);
  click("view.draw/shear");
  EXPECT_TRUE(app().editor().scene().view.draw.shear);
  click("view.draw/solid");
  EXPECT_FALSE(app().editor().scene().view.draw.solid);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  EXPECT_TRUE(app().editor().scene().view.draw.solid);
  EXPECT_TRUE(app().editor().scene().view.draw.shear);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  EXPECT_FALSE(app().editor().scene().view.draw.solid);
}

TEST_F(Panels, ADragOfANumberIsOneChangeForUndo) {
  open("cube-plane");
  const Vec3 before = settings().simulation.gravity;
  const auto box = app().gui().widgets().at("simulation.timestep");
  drag(GLFW_MOUSE_BUTTON_LEFT, box.centre_x(), box.centre_y(), 60, 0);
  frames(2);
  EXPECT_GT(settings().simulation.timestep, 0.001);
  EXPECT_EQ(settings().simulation.gravity, before);
  EXPECT_EQ(simulation().model().simulation.timestep, settings().simulation.timestep);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(1);
  EXPECT_EQ(settings().simulation.timestep, 0.001);
  EXPECT_FALSE(app().editor().can_undo());
}

TEST_F(Panels, ConstantsKeepTheStateAndBodiesStartAnew) {
  open("cube-plane", {}, BackendName::reference);
  for (int i = 0; i < 9; ++i) type(U'.');
  const std::string hash = state_hash_text(simulation().snapshot());
  set("cube[].shear.stiffness", 2500.0);
  EXPECT_EQ(simulation().step(), 9u);
  EXPECT_EQ(state_hash_text(simulation().snapshot()), hash);
  EXPECT_FALSE(app().notice().has_value());
  set("cube[].particles-per-edge", std::int64_t{5});
  EXPECT_EQ(simulation().step(), 0u);
  EXPECT_EQ(simulation().model().particle_count(), 125u);
  ASSERT_TRUE(app().notice().has_value());
  EXPECT_THAT(app().notice()->text, testing::HasSubstr("anew"));
}

TEST_F(Panels, RejectedValuesChangeNothingAndSayWhy) {
  open("cube-plane");
  set("simulation.timestep", -1.0);
  ASSERT_TRUE(app().notice().has_value());
  EXPECT_TRUE(app().notice()->is_error);
  EXPECT_THAT(app().notice()->text, testing::HasSubstr("timestep"));
  EXPECT_EQ(settings().simulation.timestep, 0.001);
  EXPECT_FALSE(app().editor().can_undo());
}

TEST_F(Panels, EverySectionOpensAndShowsItsKeys) {
  open("cube-plane");
  // Energy and Performance make room.
  for (const char* section : {"Scene", "Simulation"}) click(std::string("section/") + section);
  click("section/Springs");
  EXPECT_TRUE(has("cube[0].bending.damping"));
  click("springs/together");
  EXPECT_TRUE(has("cube[0].structural.stiffness"));
  EXPECT_FALSE(has("cube[0].bending.damping"));
  click("section/Springs");
  click("section/Contact");
  for (const char* key : {"contact.model", "contact.restitution", "contact.friction", "contact.epsilon"})
    EXPECT_TRUE(has(key)) << key;
  click("contact.model");
  click("contact.model/course");
  EXPECT_EQ(simulation().model().contact.model, ContactModel::course);
  click("section/Contact");
  click("section/Bodies");
  EXPECT_TRUE(has("cube[0].rotation.angle"));
  click("cube[0].pinned/top");
  EXPECT_EQ(count(simulation().model()).pinned, 100u);
}

TEST_F(Panels, DivergencePausesExplainsAndOffersAStableStep) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]", "simulation.timestep=0.02"}, BackendName::reference);
  press(GLFW_KEY_SPACE);
  for (int i = 0; i < 2000 && !simulation().divergence(); ++i) frames(1);
  ASSERT_TRUE(simulation().divergence().has_value());
  frames(1);
  EXPECT_FALSE(simulation().running());
  ASSERT_TRUE(app().notice().has_value());
  EXPECT_THAT(app().notice()->text, testing::HasSubstr("particle"));
  EXPECT_THAT(app().notice()->text, testing::HasSubstr("0.002048"));
  for (const Vec3& x : simulation().snapshot().position) ASSERT_TRUE(std::isfinite(x.x + x.y + x.z));
  press(GLFW_KEY_SPACE);
  EXPECT_FALSE(simulation().running()) << "not on from a diverged state";
  press(GLFW_KEY_ESCAPE);
  press(GLFW_KEY_SPACE);
  frames(2);
  click("diverged/stable");
  frames(2);
  EXPECT_FALSE(simulation().divergence().has_value());
  EXPECT_LT(simulation().model().simulation.timestep, 0.002048);
  EXPECT_GT(simulation().model().simulation.timestep, 0.0018);
  press(GLFW_KEY_R);
  press(GLFW_KEY_SPACE);
  frames_to_step(500);
  EXPECT_FALSE(simulation().divergence().has_value());
}

TEST_F(Panels, StepBackTakesOneStepBack) {
  open("cube-plane", {}, BackendName::reference);
  for (int i = 0; i < 5; ++i) type(U'.');
  click("simulation/back");
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_EQ(simulation().step(), 4u);
  EXPECT_EQ(state_hash_text(simulation().snapshot()), reference_hash(app().editor().scene(), 4));
}

class Files : public Panels {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const std::string path = (directory() / name).string();
    std::ofstream(path) << text;
    // Two writes within the clock's grain have the same time.
    std::filesystem::last_write_time(
        path, std::filesystem::last_write_time(path) + std::chrono::seconds(++writes_));
    return path;
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
  ASSERT_TRUE(app().notice().has_value());
  EXPECT_THAT(app().notice()->text, testing::HasSubstr("broken.toml:3"));
}

TEST_F(Files, ReloadsWhenTheFileChangesAndKeepsTheOldSceneWhileItIsBroken) {
  open(write("mine.toml", scene_text(4)));
  write("mine.toml", scene_text(3));
  frames(40);
  EXPECT_EQ(simulation().model().particle_count(), 27u);
  write("mine.toml", "schema = 1\n[[cube]]\nparticles-per-edge = 1\n");
  frames(40);
  EXPECT_EQ(simulation().model().particle_count(), 27u);
  ASSERT_TRUE(app().notice().has_value());
  EXPECT_THAT(app().notice()->text, testing::HasSubstr("mine.toml:3"));
  write("mine.toml", scene_text(5));
  frames(40);
  EXPECT_EQ(simulation().model().particle_count(), 125u);
}

TEST_F(Files, AFileWithOtherConstantsLetsTheMotionGoOn) {
  open(write("mine.toml", scene_text(4)));
  for (int i = 0; i < 6; ++i) type(U'.');
  const std::string hash = state_hash_text(simulation().snapshot());
  drag(GLFW_MOUSE_BUTTON_LEFT, middle_x(), middle_y(), 90, -30);
  const CameraSettings camera = app().camera().goal();
  write("mine.toml", scene_text(4) + "[contact]\nfriction = 0.9\n");
  frames(40);
  EXPECT_EQ(simulation().model().contact.friction, 0.9);
  EXPECT_EQ(simulation().step(), 6u);
  EXPECT_EQ(state_hash_text(simulation().snapshot()), hash);
  EXPECT_EQ(app().camera().goal(), camera) << "the camera stays where it was put";
}

TEST_F(Files, SavedSceneHoldsChangesAndCamera) {
  open("cube-plane");
  set("cube[].shear.stiffness", 1234.5);
  app().scroll(0, 0);
  drag(GLFW_MOUSE_BUTTON_LEFT, middle_x(), middle_y(), 90, -30);
  app().save_as("saved.toml");
  const auto saved = load_scene((directory() / "saved.toml").string());
  ASSERT_TRUE(saved.ok()) << saved.error().message;
  EXPECT_EQ(saved->model.cubes[0].shear.stiffness, 1234.5);
  EXPECT_EQ(saved->view.camera, app().camera().goal());
  app().save_as("saved.toml");
  EXPECT_TRUE(app().notice() && app().notice()->is_error) << "nothing is overwritten";
}

}  // namespace
}  // namespace aspic::test

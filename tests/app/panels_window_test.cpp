#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "app/parameter_widget.h"
#include "app/stage.h"
#include "aspic/scene.h"
#include "base/memory.h"
#include "model/bodies.h"
#include "model/terrain.h"

namespace aspic::test {
namespace {

using app::Box;

class Panels : public Stage {
 protected:
  std::array<int, 2> window_size() const override { return {1280, 480}; }
  void set(std::string_view path, const Value& value, std::size_t index = 0) {
    app().scene.set_value(*find_parameter(path), index, value, "");
    frames(1);
  }
  /// A change of bodies may wait for the one before it.
  void frames_until_particles(std::size_t count) {
    frames_until([&] { return simulation().model().particle_count() == count; });
  }
  /// One section open, the others closed.
  static app::KeptState only(const std::string& section) {
    app::KeptState kept;
    for (const char* name : {"Scene", "Simulation", "View", "Performance", "Energy"})
      kept.layout.sections[name] = false;
    kept.layout.sections[section] = true;
    return kept;
  }
  const ModelSettings& settings() { return app().scene.editor().scene().model; }
};

TEST_F(Panels, ButtonsRunStepAndReset) {
  open("cube-plane", {}, "reference");
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
  EXPECT_EQ(simulation().present().backend().name, "gpu");
}

TEST_F(Panels, ScenesAreChosenByClick) {
  open("cube-plane");
  click("scene/cube-sphere");
  EXPECT_EQ(app().scene.editor().source(), "cube-sphere");
  EXPECT_EQ(simulation().model().terrain.front().shape, TerrainShape::sphere);
  click("terrain/bowl");
  EXPECT_EQ(simulation().model().terrain.front().shape, TerrainShape::bowl);
  EXPECT_EQ(simulation().model().terrain.front().geometry.vectors[0], (Vec3{2, 7, 1}));
  click("scene/undo");
  EXPECT_EQ(simulation().model().terrain.front().shape, TerrainShape::sphere);
  click("scene/redo");
  EXPECT_EQ(simulation().model().terrain.front().shape, TerrainShape::bowl);
}

TEST_F(Panels, WordsAndFlagsFollowTheTable) {
  open("cube-plane");
  click("simulation.integrator");
  ASSERT_TRUE(widgets().contains("simulation.integrator/midpoint"));
  press(GLFW_KEY_ESCAPE);
  frames(2);
  EXPECT_FALSE(widgets().contains("simulation.integrator/midpoint")) << "Escape closes the list";
  click("simulation.integrator");
  const Integrator before = settings().simulation.integrator;
  for (const int key : {GLFW_KEY_DOWN, GLFW_KEY_ENTER}) {
    press(key);
    frames(2);
  }
  EXPECT_NE(settings().simulation.integrator, before) << "the next one of the list";
  EXPECT_FALSE(widgets().contains("simulation.integrator/midpoint"));
  click("simulation.integrator");
  click("simulation.integrator/runge-kutta-4");
  EXPECT_EQ(settings().simulation.integrator, Integrator::runge_kutta_4);
  EXPECT_EQ(simulation().model().simulation.integrator, Integrator::runge_kutta_4);
  click("view.draw/shear");
  EXPECT_TRUE(app().scene.editor().scene().view.draw.shear);
  click("view.draw/solid");
  EXPECT_FALSE(app().scene.editor().scene().view.draw.solid);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  EXPECT_TRUE(app().scene.editor().scene().view.draw.solid);
  EXPECT_TRUE(app().scene.editor().scene().view.draw.shear);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  EXPECT_FALSE(app().scene.editor().scene().view.draw.solid);
}

// A change at the start empties Energy, which is above View.
TEST_F(Panels, RowsKeepTheirPlacesWhileEnergyHasNoFigures) {
  open("cube-plane", {"cube[0].particles-per-edge=4"}, "reference");
  click("fold/Energy: momentum");
  bring_into_sight("view.draw/solid");
  frames_until([&] { return !simulation().samples().energies().empty(); });
  frames(2);
  const Box full = widgets().at("view.draw/solid");
  int without = 0;
  for (const char* integrator : {"runge-kutta-4", "midpoint", "heun-3", "explicit-euler"}) {
    app().scene.set_value(*find_parameter("simulation.integrator"), 0, std::string(integrator), "");
    for (int i = 0; i < 10; ++i) {
      frame();
      if (simulation().samples().energies().empty()) ++without;
      EXPECT_EQ(widgets().at("view.draw/solid"), full) << integrator << ", image " << i;
    }
  }
  EXPECT_GT(without, 0);
}

TEST_F(Panels, ADragOfANumberIsOneChangeForUndo) {
  open("cube-plane");
  const Vec3 before = settings().simulation.gravity;
  const auto box = widgets().at("simulation.timestep");
  drag(GLFW_MOUSE_BUTTON_LEFT, box.center_x(), box.center_y(), 60, 0);
  frames(2);
  EXPECT_GT(settings().simulation.timestep, 0.001);
  EXPECT_EQ(settings().simulation.gravity, before);
  EXPECT_EQ(simulation().model().simulation.timestep, settings().simulation.timestep);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(1);
  EXPECT_EQ(settings().simulation.timestep, 0.001);
  EXPECT_FALSE(app().scene.editor().can_undo());
}

TEST_F(Panels, NumbersAreTypedAsArithmetic) {
  open("cube-plane", {}, "reference", only("Simulation"));
  // With Ctrl into a number that is dragged; one that stands there as text needs none.
  const auto enter = [&](const std::string& widget, double share, const std::string& text, bool control) {
    bring_into_sight(widget);
    frames(2, 0.4);  // so that two presses are no double click
    const Box box = widgets().at(widget);
    if (control) app().key(GLFW_KEY_LEFT_CONTROL, GLFW_PRESS, 0);
    app().cursor(box.left + share * (box.right - box.left), box.center_y());
    frames(1);
    app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, control ? GLFW_MOD_CONTROL : 0);
    frames(1);
    app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, control ? GLFW_MOD_CONTROL : 0);
    frames(1);
    if (control) app().key(GLFW_KEY_LEFT_CONTROL, GLFW_RELEASE, GLFW_MOD_CONTROL);
    frames(1);
    for (const char c : text) app().character(static_cast<unsigned char>(c));
    frames(3);
    press(GLFW_KEY_ENTER);
    frames(3);
  };
  enter("simulation.timestep", 0.5, "1/(2*600)", true);
  EXPECT_EQ(settings().simulation.timestep, 1.0 / 1200.0);
  enter("simulation.gravity", 0.5, "-2*9.8", true);
  EXPECT_EQ(settings().simulation.gravity, (Vec3{0.0, -2 * 9.8, 0.0}));
  enter("cube[0].particles-per-edge", 0.2, "2*(3+1)", false);
  EXPECT_EQ(settings().cubes[0].particles_per_edge, 8);
  EXPECT_FALSE(app().messages.notice() && app().messages.notice()->is_error);
  enter("simulation.timestep", 0.5, "1/(2*600", true);
  EXPECT_EQ(settings().simulation.timestep, 1.0 / 1200.0) << "unchanged";
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_THAT(app().messages.notice()->text,
              testing::HasSubstr("closing parenthesis is missing here.\n1/(2*600\n        ^"));
  // So does a number that is not allowed, whether it is dragged, slid along or always text.
  const auto refused = [&](const std::string& widget, const std::string& text, bool control,
                           const std::string& why) {
    app().messages.dismiss();
    enter(widget, 0.2, text, control);
    ASSERT_TRUE(app().messages.notice() && app().messages.notice()->is_error) << widget;
    EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr(why));
  };
  refused("simulation.timestep", "0", true, "out of range: 0; allowed: a number > 0 and ≤ 1 s");
  EXPECT_EQ(settings().simulation.timestep, 1.0 / 1200.0);
  refused("simulation.gravity", "1e9", true, "'simulation.gravity' is out of range");
  EXPECT_EQ(settings().simulation.gravity, (Vec3{0.0, -2 * 9.8, 0.0}));
  refused("cube[0].particles-per-edge", "1", false, "'cube.particles-per-edge' is out of range: 1;");
  EXPECT_EQ(settings().cubes[0].particles_per_edge, 8);
  refused("simulation/speed", "0", true, "0 is out of range; allowed: ");
  app().messages.dismiss();
  enter("simulation.timestep", 0.5, "", true);
  EXPECT_EQ(settings().simulation.timestep, 1.0 / 1200.0) << "a number that nobody touched keeps its digits";
}

TEST_F(Panels, LengthsAndAnglesAreDraggedAtAFixedSpeed) {
  open("cube-plane", {}, "reference", only("Simulation"));
  // What a drag of 50 units changes, from where the value is; ImGui takes the first of them to know a drag.
  const auto drag_by = [&](const char* widget, double inwards, const std::function<double()>& value) {
    bring_into_sight(widget);
    frames(40);  // so that two presses are no double click
    const Box box = widgets().at(widget);
    const double before = value();
    drag(GLFW_MOUSE_BUTTON_LEFT, box.left + inwards, box.center_y(), 50, 0);
    frames(2);
    return value() - before;
  };
  const auto angle = [&] { return settings().cubes[0].rotation.angle; };
  const double from_zero = drag_by("cube[0].rotation.angle", 20.0, angle);
  EXPECT_GT(from_zero, 10.0);
  EXPECT_LE(from_zero, 25.0) << "half a degree for each unit";
  EXPECT_EQ(drag_by("cube[0].rotation.angle", 20.0, angle), from_zero) << "from there it goes on as fast";
  const auto x = [&] { return settings().cubes[0].position.x; };
  const double first = drag_by("cube[0].position", 10.0, x);
  EXPECT_GT(first, 0.2);
  EXPECT_LE(first, 0.5) << "a centimeter";
}

// A change of a body restarts the run and says so, in the midst of the drag.
TEST_F(Panels, ANoticeEndsNeitherADragNorTyping) {
  open("cube-plane", {}, "reference", only("Simulation"));
  bring_into_sight("cube[0].rotation.angle");
  frames(40);
  Box box = widgets().at("cube[0].rotation.angle");
  const double before = settings().cubes[0].rotation.angle, x = box.left + 20.0, y = box.center_y();
  app().cursor(x, y);
  frames(1);
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
  frames(1);
  for (int i = 1; i <= 20; ++i) {
    app().cursor(x + 3.5 * i, y);
    frames(1);
  }
  EXPECT_TRUE(has("notice/close"));
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
  frames(2);
  EXPECT_GT(settings().cubes[0].rotation.angle - before, 25.0) << "half a degree for each unit";

  app().messages.dismiss();
  frames(40);
  box = widgets().at("cube[0].particles-per-edge");
  app().cursor(box.left + 0.2 * (box.right - box.left), box.center_y());
  frames(1);
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
  frames(1);
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
  frames(2);
  type(U'1');
  frames(2);
  app().messages.info("The file was reloaded.");
  frames(3);
  EXPECT_TRUE(has("notice/close"));
  type(U'2');
  frames(2);
  press(GLFW_KEY_ENTER);
  frames(2);
  EXPECT_EQ(settings().cubes[0].particles_per_edge, 12);
}

TEST_F(Panels, ConstantsKeepTheStateAndBodiesStartAnew) {
  open("cube-plane", {}, "reference");
  for (int i = 0; i < 9; ++i) type(U'.');
  const std::string hash = state_hash_text(simulation().snapshot());
  set("cube[].shear.stiffness", 2500.0);
  EXPECT_EQ(simulation().step(), 9u);
  EXPECT_EQ(state_hash_text(simulation().snapshot()), hash);
  EXPECT_FALSE(app().messages.notice().has_value());
  set("cube[].particles-per-edge", std::int64_t{5});
  frames_until_particles(125);
  EXPECT_EQ(simulation().step(), 0u);
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("restarted"));
}

TEST_F(Panels, RejectedValuesChangeNothingAndSayWhy) {
  open("cube-plane");
  set("simulation.timestep", -1.0);
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_TRUE(app().messages.notice()->is_error);
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("timestep"));
  EXPECT_EQ(settings().simulation.timestep, 0.001);
  EXPECT_FALSE(app().scene.editor().can_undo());
}

TEST_F(Panels, EverySectionOpensAndShowsItsKeys) {
  open("cube-plane");
  // Energy and Performance make room.
  for (const char* section : {"Scene", "Simulation"}) click(std::string("section/") + section);
  EXPECT_TRUE(has("cube[0].bending.damping"));
  click("fold/Springs: by type");
  EXPECT_TRUE(has("springs/all/stiffness"));
  EXPECT_FALSE(has("cube[0].bending.damping"));
  click("section/Springs");
  click("section/Contact");
  for (const char* key : {"contact.model", "contact.restitution", "contact.friction", "contact.distance"})
    EXPECT_TRUE(has(key)) << key;
  click("contact.model");
  click("contact.model/course");
  EXPECT_EQ(simulation().model().contact.model, ContactModel::course);
  click("section/Contact");
  click("section/Bodies");
  EXPECT_TRUE(has("cube[0].edge-length"));
  click("cube[0].pinned/top");
  EXPECT_EQ(count(simulation().model()).pinned, 100u);
}

TEST_F(Panels, WhatIsSaidOfADivergenceEndsWithIt) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]", "simulation.timestep=0.02"}, "reference");
  press(GLFW_KEY_SPACE);
  for (int i = 0; i < 2000 && !simulation().divergence(); ++i) frames(1);
  frames(60, 0.3);
  ASSERT_TRUE(app().messages.notice().has_value()) << "it asks what to do";
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("last good step"));
  press(GLFW_KEY_R);
  frames(3);
  EXPECT_EQ(simulation().step(), 0u);
  EXPECT_FALSE(app().messages.notice().has_value()) << app().messages.notice()->text;
}

TEST_F(Panels, DivergencePausesExplainsAndOffersAStableStep) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]", "simulation.timestep=0.02"}, "reference");
  press(GLFW_KEY_SPACE);
  for (int i = 0; i < 2000 && !simulation().divergence(); ++i) frames(1);
  ASSERT_TRUE(simulation().divergence().has_value());
  frames(1);
  EXPECT_FALSE(simulation().running());
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("particle"));
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("0.002048"));
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("The time step is 0.02 s"));
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

TEST_F(Panels, LargeButtonsRunResetCompareAndVideo) {
  open("cube-plane", {"cube[0].particles-per-edge=4"}, "reference");
  click("actions/start");
  EXPECT_TRUE(simulation().running());
  frames_to_step(10);
  click("actions/start");
  EXPECT_FALSE(simulation().running());
  click("actions/reset");
  EXPECT_EQ(simulation().step(), 0u);
  click("actions/video");
  EXPECT_NE(app().video.recording(), nullptr);
  click("actions/video");
  EXPECT_EQ(app().video.recording(), nullptr);
  click("actions/compare");
  frames_until([&] { return app().comparison.settled(); });
  EXPECT_EQ(app().comparison.count(), 2u);
  press(GLFW_KEY_TAB);
  frames(2);
  EXPECT_FALSE(has("actions/start")) << "with the panels";
}

TEST_F(Panels, OneStiffnessIsThatOfAllSprings) {
  open("cube-plane", {}, "reference");
  const Box row = widgets().at("springs/all/stiffness");
  drag(GLFW_MOUSE_BUTTON_LEFT, row.center_x(), row.center_y(), 60, 0);
  frames(2);
  const CubeSettings& cube = settings().cubes[0];
  EXPECT_GT(cube.structural.stiffness, 2000.0);
  EXPECT_EQ(cube.shear.stiffness, cube.structural.stiffness);
  EXPECT_EQ(cube.bending.stiffness, cube.structural.stiffness);
}

TEST_F(Panels, StepBackTakesOneStepBack) {
  open("cube-plane", {}, "reference");
  for (int i = 0; i < 5; ++i) type(U'.');
  click("simulation/back");
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_EQ(simulation().step(), 4u);
  EXPECT_EQ(state_hash_text(simulation().snapshot()), reference_hash(app().scene.editor().scene(), 4));
}

TEST_F(Panels, KeysThatMayBeAbsentAreSetAndTakenAway) {
  open("cube-plane", {"simulation.integrator=implicit-euler"}, "reference", only("Contact"));
  EXPECT_FALSE(settings().terrain[0].friction.has_value());
  EXPECT_TRUE(has("terrain[0].friction")) << "what its absence means stands there";
  click("terrain[0].friction/set");
  EXPECT_EQ(settings().terrain[0].friction, settings().contact.friction) << "begins as it was";
  EXPECT_EQ(simulation().model().terrain[0].friction, settings().contact.friction);
  set("terrain[].friction", 0.75);
  click("terrain[0].friction/set");
  EXPECT_FALSE(settings().terrain[0].friction.has_value());
  app().scene.undo();
  EXPECT_EQ(settings().terrain[0].friction, 0.75) << "undone like any change";
  click("terrain[0].mass/set");
  EXPECT_EQ(settings().terrain[0].mass, 10.0);
  click("section/Contact");
  click("section/Simulation");
  click("simulation.implicit.tolerance/set");
  EXPECT_EQ(settings().simulation.implicit.tolerance, 1e-4);
  click("simulation.implicit.tolerance/set");
  EXPECT_FALSE(settings().simulation.implicit.tolerance.has_value());
}

TEST_F(Panels, TerrainsAndCubesComeAndGo) {
  open("cube-plane", {}, "reference", only("Contact"));
  for (int i = 0; i < 5; ++i) type(U'.');
  click("terrain/add");
  ASSERT_EQ(simulation().model().terrain.size(), 2u);
  EXPECT_EQ(simulation().step(), 5u) << "the motion goes on";
  click("terrain[1].shape");
  click("terrain[1].shape/bowl");
  EXPECT_EQ(simulation().model().terrain[1].shape, TerrainShape::bowl);
  click("terrain/0/remove");
  ASSERT_EQ(simulation().model().terrain.size(), 1u);
  EXPECT_EQ(simulation().model().terrain[0].shape, TerrainShape::bowl);
  click("section/Contact");
  click("section/Bodies");
  click("cube/0/remove");
  EXPECT_EQ(settings().cubes.size(), 1u) << "a scene without bodies is no scene";
  click("cube/add");
  ASSERT_EQ(settings().cubes.size(), 2u);
  EXPECT_EQ(simulation().model().particle_count(), 2000u);
  EXPECT_GE(settings().cubes[1].position.y - settings().cubes[0].position.y, settings().cubes[0].edge_length)
      << "not through one another";
  const double second = settings().cubes[1].position.y;
  click("cube/0/remove");
  ASSERT_EQ(settings().cubes.size(), 1u);
  EXPECT_EQ(settings().cubes[0].position.y, second) << "the other one stays";
}

TEST_F(Panels, ShapeMakesABoxOfACubeAndACubeOfABox) {
  open("cube-plane", {"cube[0].particles-per-edge=3"}, "reference", only("Bodies"));
  const auto choose = [&](const std::string& shape) {
    click("bodies/0/shape");
    click("bodies/0/shape/" + shape);
    frames(2);
  };
  EXPECT_FALSE(has("cube[0].particles"));
  choose("box");
  EXPECT_EQ(settings().cubes[0].particles, (std::array{3, 3, 3}));
  EXPECT_TRUE(has("cube[0].particles"));
  EXPECT_FALSE(has("cube[0].particles-per-edge"));
  set("cube[].particles", std::vector<int>{3, 5, 2});
  frames_until_particles(30);
  click("cube/add");
  EXPECT_EQ(settings().cubes[1].lattice(), (std::array{3, 5, 2})) << "a copy is a box as well";
  choose("cube");
  EXPECT_EQ(settings().cubes[0].lattice(), (std::array{5, 5, 5}));
  EXPECT_TRUE(has("cube[0].particles-per-edge"));
  frames_until_particles(125 + 30);
}

TEST_F(Panels, EveryKindOfBodyIsAddedAndRemoved) {
  open("cube-plane", {"cube[0].particles-per-edge=3"}, "reference", only("Bodies"));
  for (const BodyRow& row : body_rows().subspan(1)) {
    const std::string key(row.list.key);
    const std::uint32_t particles = simulation().model().particle_count(),
                        balls = simulation().model().ball_count();
    const auto frames_until_there_are = [&](std::uint64_t of_particles, std::uint64_t of_balls) {
      frames_until([&] {
        const Model& model = simulation().model();
        return model.particle_count() == of_particles && model.ball_count() == of_balls;
      });
    };
    click(key + "/add");
    ASSERT_EQ(row.list.size(settings()), 1u) << key;
    const ModelCounts more = row.counts(settings(), 0);
    frames_until_there_are(particles + more.particles, balls + more.balls);
    click(key + "/0/remove");
    ASSERT_EQ(row.list.size(settings()), 0u) << key;
    frames_until_there_are(particles, balls);
  }
}

TEST_F(Panels, NewBodiesStandBesideOthersAndAboveTheGroundAndAreSaved) {
  open("cube-plane", {"cube[0].particles-per-edge=3", "cube[0].position=[0,0.5,0]"}, "reference",
       only("Bodies"));
  for (int round = 0; round < 2; ++round) {
    for (const BodyRow& row : body_rows()) {
      const Model before = simulation().model();
      const State there = initial_state(before, Precision::double_);
      click(std::string(row.list.key) + "/add");
      const auto size = [](const Model& m) { return m.particle_count() + m.balls.size(); };
      frames_until([&] { return size(simulation().model()) > size(before); });
      const Model& model = simulation().model();
      const State all = initial_state(model, Precision::double_);
      // What came is what was not there: everything else is where it was.
      const auto is_new = [&](const std::vector<Vec3>& known, const Vec3& x) {
        return std::ranges::find(known, x) == known.end();
      };
      const auto above = [&](const Vec3& x) { return signed_distance(model.terrain.front(), x); };
      std::size_t more = 0;
      for (std::size_t i = 0; i < all.position.size(); ++i) {
        EXPECT_TRUE(!is_new(there.position, all.position[i]) || above(all.position[i]) >= 0.0)
            << row.list.key;
        more += is_new(there.position, all.position[i]);
      }
      for (std::size_t b = 0; b < all.ball_position.size(); ++b) {
        if (!is_new(there.ball_position, all.ball_position[b])) continue;
        ++more;
        EXPECT_GE(above(all.ball_position[b]), model.balls[b].radius) << row.list.key;
        for (const Vec3& x : there.position)
          EXPECT_GT(length(x - all.ball_position[b]), model.balls[b].radius) << row.list.key;
      }
      const ModelCounts own = row.counts(settings(), row.list.size(settings()) - 1);
      EXPECT_EQ(more, own.particles + own.balls) << row.list.key << ": in one place with others";
    }
  }
  const LauncherSettings& launcher = settings().launchers.front();
  EXPECT_GT(launcher.from.min.x, launcher.towards.max.x) << "it throws at the bodies from beside";
  const std::string path = (directory() / "bodies.toml").string();
  app().scene.save_as(path);
  const auto saved = load_scene(path);
  ASSERT_TRUE(saved.ok()) << saved.error().message();
  EXPECT_EQ(effect_between(*saved, app().scene.scene()), Effect::none);
  for (std::size_t i = 0; i < 2 * body_rows().size(); ++i) press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  EXPECT_EQ(settings().cubes.size(), 1u);
  for (const BodyRow& row : body_rows().subspan(1)) EXPECT_EQ(row.list.size(settings()), 0u) << row.list.key;
}

TEST_F(Panels, WhatIsAddedSurvivesItsLauncher) {
  open("cube-plane", {}, "cpu");
  for (const auto& row : body_rows().subspan(1)) app::add_body(app().scene, row.list);
  frames(3);
  ASSERT_EQ(settings().launchers.size(), 1u);
  simulation().set_running(true);
  frames_until([&] { return simulation().step() >= 1500 || simulation().divergence(); });
  EXPECT_FALSE(simulation().divergence().has_value()) << "at " << simulation().time() << " s";
}

// What overlaps at the start is named; a run of bodies that do not says nothing.
TEST_F(Panels, BodiesThatOverlapAreNamed) {
  open("cubes-stack", {"cube[1].position=[0,5.8,0]"}, "reference");
  frames(2);
  ASSERT_TRUE(app().messages.notice().has_value());
  EXPECT_THAT(app().messages.notice()->text, testing::AllOf(testing::HasSubstr("overlap at the start"),
                                                            testing::HasSubstr("cube[0] and cube[1]")));
  open("cubes-stack", {}, "reference");
  frames(2);
  EXPECT_TRUE(!app().messages.notice() || app().messages.notice()->text.find("overlap") == std::string::npos);
}

TEST_F(Panels, LoadedStatesStartAnewWithTheirEnergy) {
  open("worm", {}, "reference");
  simulation().set_running(true);
  frames_to_step(120);
  ASSERT_TRUE(simulation().settle().ok());
  State state = simulation().snapshot();
  for (Vec3& v : state.velocity) v.y += 30.0;
  ASSERT_TRUE(simulation().rebuild().start_from(state, {}).ok());
  simulation().set_running(true);
  frames_to_step(state.step + 120);
  EXPECT_TRUE(!app().messages.notice() || app().messages.notice()->text.find("energy") == std::string::npos);
}

TEST_F(Panels, ASecondBodyInABowlStandsAboveTheFirst) {
  open("cube-bowl", {"cube[0].particles-per-edge=3", "cube[0].edge-length=2", "cube[0].position=[6,7.5,1]"},
       "reference", only("Bodies"));
  const Terrain bowl = simulation().model().terrain.front();
  click("cube/add");
  ASSERT_EQ(settings().cubes.size(), 2u);
  const State state = initial_state(simulation().model(), Precision::double_);
  for (std::size_t i = 27; i < 54; ++i) EXPECT_GE(signed_distance(bowl, state.position[i]), 0.0) << i;
  EXPECT_GT(settings().cubes[1].position.y, settings().cubes[0].position.y);
}

TEST_F(Panels, SpringsAreShownAndHiddenByType) {
  open("cube-plane", {}, "reference", only("Springs"));
  for (const auto& [_, key] : resistance_constants) EXPECT_TRUE(has("simulation." + std::string(key))) << key;
  click("springs/show/shear");
  EXPECT_TRUE(app().scene.editor().scene().view.draw.shear);
  EXPECT_TRUE(app().scene.editor().scene().view.draw.solid);
  click("springs/show/structural");
  EXPECT_TRUE(app().scene.editor().scene().view.draw.structural);
  click("springs/show/shear");
  EXPECT_FALSE(app().scene.editor().scene().view.draw.shear);
}

TEST_F(Panels, ACubeBeyondMemoryIsRefusedWithTheFigures) {
  open("cube-plane", {}, "reference", only("Simulation"));
  EXPECT_THAT(explanations().at("cube[0].particles-per-edge"),
              testing::HasSubstr("1000 particles and 12876 springs"));
  EXPECT_THAT(explanations().at("cube[0].particles-per-edge"), testing::HasSubstr("are free"));
  for (int i = 0; i < 3; ++i) type(U'.');
  // As many of the largest cubes as do not fit.
  Scene large = app().scene.editor().scene();
  large.model.cubes[0].particles_per_edge = 512;
  while (run_bytes(predict_counts(large.model)) <= available_memory().value_or(0))
    large.model.cubes.push_back(large.model.cubes[0]);
  const bool too_many = predict_counts(large.model).particles > most_indices;
  app().scene.apply(large, "large cubes", "");
  ASSERT_TRUE(app().messages.notice() && app().messages.notice()->is_error);
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr("particles and"));
  EXPECT_THAT(app().messages.notice()->text, testing::HasSubstr(too_many ? "32-bit" : "of memory and"));
  EXPECT_EQ(settings().cubes.size(), 1u);
  EXPECT_EQ(settings().cubes[0].particles_per_edge, 10);
  EXPECT_EQ(simulation().model().particle_count(), 1000u);
  EXPECT_EQ(simulation().step(), 3u) << "the old scene goes on where it was";
  type(U'.');
  EXPECT_EQ(simulation().step(), 4u);
}

TEST_F(Panels, PassTimesOfASoftwareDeviceAreNotShown) {
  open("cube-plane", {}, "gpu", only("Performance"));
  press(GLFW_KEY_SPACE);
  frames_to_step(20);
  EXPECT_NE(has("performance/not-timed"), has("performance/passes")) << "either it is timed or it says so";
  EXPECT_EQ(has("performance/passes"), !context().info().is_software);
}

TEST_F(Panels, MomentumStandsBesideEnergy) {
  open("cube-plane", {}, "reference", only("Energy"));
  for (int i = 0; i < 5; ++i) type(U'.');
  frames(2);
  EXPECT_TRUE(has("energy/plot"));
  EXPECT_TRUE(has("energy/momentum"));
  const Measures& last = simulation().samples().energies().back().measures;
  // Free fall: p = m·g·t for 1000 particles of 1 kg and 5 ms.
  EXPECT_NEAR(last.momentum.y, -1000.0 * 9.8 * 0.005, 1e-3);
}

}  // namespace
}  // namespace aspic::test

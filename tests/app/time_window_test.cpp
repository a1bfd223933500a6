// History, hands and shadow mode in the real window.
#include <fmt/format.h>

#include <cmath>

#include "app/stage.h"
#include "cpu_reference/reference_solver.h"
#include "playback/endless.h"
#include "support/projection.h"

namespace aspic::test {
namespace {

class Time : public Stage {
 protected:
  std::string hash() { return state_hash_text(simulation().snapshot()); }
  void run_to(std::uint64_t step) {
    simulation().set_running(true);
    frames_to_step(step);
    simulation().set_running(false);
    ASSERT_TRUE(simulation().settle().ok());
  }
  void go_to(const Moment& moment) {
    ASSERT_TRUE(simulation().playback().seek(moment).ok());
    for (int i = 0; simulation().playback().seeking(); ++i) {
      ASSERT_LT(i, 10000);
      frames(1);
    }
  }
  void settle() { ASSERT_TRUE(simulation().settle().ok()); }
};

/// The reference without steps, which refuses other constants and more than 22,000 particles.
class Refusing final : public Endless {
 public:
  using Endless::Endless;

 private:
  Status take_constants(SharedModel, std::uint64_t) override {
    return Error{ErrorCode::no_device, "No other constants."};
  }
};

const BackendRow& refusing_backend() {
  static const BackendRow row = [] {
    BackendRow made = endless_backend();
    made.name = made.title = "refusing";
    made.make = [](SharedModel model, const BackendChoice&, const SolverHost&) -> Result<Backend> {
      if (model->particle_count() > 22000) return Error{ErrorCode::no_device, "Too many particles."};
      ASPIC_TRY(auto reference, make_reference_solver(std::move(model), Precision::single));
      Backend backend;
      backend.solver = std::make_unique<Refusing>(std::move(reference));
      return backend;
    };
    return made;
  }();
  return row;
}

class RefusedChange : public Time {
 protected:
  void open_large() {
    open("cube-plane", {"cube[0].particles-per-edge=28"}, "reference");
    ASSERT_TRUE(simulation().rebuild().set_backend(refusing_backend()).ok());
  }
  void set(std::string_view key, const Value& value) {
    app().scene.set_value(*find_parameter(key), 0, value, "");
  }
  /// The refused one, which is being built after it.
  void ask_for_too_many() {
    set("cube[].particles-per-edge", Value(std::int64_t{29}));
    frames(1);
    ASSERT_TRUE(simulation().rebuild().building());
  }
  void finish() {
    frames_until([&] { return !simulation().rebuild().changing() && !app().scene.pending(); });
  }
  const Scene& scene() { return app().scene.scene(); }
  void expect_in_step() {
    Scene running = scene();
    running.model = simulation().present().setup().settings;
    EXPECT_EQ(effect_between(running, scene()), Effect::none);
  }
  std::string notice() { return app().messages.notice() ? app().messages.notice()->text : ""; }
};

TEST_F(RefusedChange, IsTakenBackAndALaterOneStays) {
  open_large();
  ask_for_too_many();
  set("cube[].position", Value(Vec3{0.0, 3.0, 0.0}));
  finish();
  EXPECT_EQ(simulation().model().particle_count(), 28u * 28u * 28u);
  EXPECT_EQ(scene().model.cubes[0].position.y, 3.0);
  EXPECT_EQ(simulation().present().setup().settings.cubes[0].position.y, 3.0);
  expect_in_step();
  app().scene.undo();
  EXPECT_FALSE(app().scene.editor().changed()) << "the refused one is no entry";
}

TEST_F(RefusedChange, IsTakenBackWithItsError) {
  open_large();
  set("view.terrain", Value(false));
  ask_for_too_many();
  finish();
  EXPECT_EQ(notice(), "Too many particles.");
  EXPECT_EQ(scene().model.cubes[0].particles_per_edge, 28);
  expect_in_step();
  EXPECT_TRUE(app().scene.editor().can_redo());
}

TEST_F(RefusedChange, IsNotAskedForAgainOnceUndone) {
  open_large();
  ask_for_too_many();
  app().scene.undo();
  finish();
  expect_in_step();
  EXPECT_FALSE(app().scene.editor().can_undo());
}

TEST_F(RefusedChange, LeavesAnOpenedSceneOpen) {
  open("cube-plane", {"cube[0].particles-per-edge=3"}, "reference");
  ASSERT_TRUE(simulation().rebuild().set_backend(refusing_backend()).ok());
  app().scene.open("cube-sphere");
  frames(2);
  app().scene.hand_over();
  frames(2);
  EXPECT_EQ(notice(), "No other constants.");
  EXPECT_EQ(app().scene.editor().source(), "cube-sphere");
  expect_in_step();
}

TEST_F(RefusedChange, WithoutAnEntryFollowsTheSimulation) {
  open("cube-plane", {"cube[0].particles-per-edge=3"}, "reference");
  set("contact.friction", Value(0.7));
  frames(2);
  ASSERT_TRUE(simulation().rebuild().set_backend(refusing_backend()).ok());
  app().scene.undo();
  frames(2);
  EXPECT_EQ(notice(), "No other constants.");
  EXPECT_EQ(scene().model.contact.friction, 0.7);
  expect_in_step();
}

class TimeOnBackend : public Time, public testing::WithParamInterface<const char*> {};

TEST_P(TimeOnBackend, EveryStepOfTheRunComesBackWithItsBits) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, GetParam());
  run_to(150);
  const std::uint64_t end = simulation().step();
  const std::string last = hash();
  for (const std::uint64_t step : {end - 1, end / 2, std::uint64_t{1}, std::uint64_t{0}, end - 3}) {
    go_to({simulation().playback().here().stretch, step});
    EXPECT_EQ(simulation().step(), step);
    EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), step));
    EXPECT_FALSE(simulation().running());
  }
  go_to(simulation().playback().history().end_moment());
  EXPECT_EQ(hash(), last);
}

TEST_P(TimeOnBackend, CommaStepsBackAndFullStopForthAgain) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, GetParam());
  for (int i = 0; i < 6; ++i) type(U'.');
  const std::string sixth = hash();
  for (int i = 0; i < 4; ++i) type(U',');
  settle();
  EXPECT_EQ(simulation().step(), 2u);
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), 2));
  for (int i = 0; i < 4; ++i) type(U'.');
  EXPECT_EQ(simulation().step(), 6u);
  EXPECT_EQ(hash(), sixth);
  for (int i = 0; i < 10; ++i) type(U',');
  settle();
  EXPECT_EQ(simulation().step(), 0u) << "not beyond the beginning";
}

TEST_P(TimeOnBackend, APullIsAnInputThatComesBack) {
  open("cube-plane", {"simulation.gravity=[0,0,0]"}, GetParam());
  run_to(20);
  const State before = simulation().snapshot();
  const Pull pull = {999, before.position[999] + Vec3{1.0, 1.0, 0.0}, 2000.0, 40.0};
  simulation().set_hand(pull);
  run_to(simulation().step() + 60);
  const std::uint64_t moved_at = simulation().step();
  EXPECT_GT(length(simulation().snapshot().position[999] - before.position[999]), 0.01);
  Pull further = pull;
  further.anchor = pull.anchor + Vec3{0.0, 1.0, 0.0};
  simulation().set_hand(further);
  run_to(moved_at + 40);
  simulation().set_hand(std::nullopt);
  run_to(simulation().step() + 30);
  const std::uint64_t end = simulation().step();
  const std::string last = hash();
  go_to({simulation().playback().here().stretch, 5});
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), 5));
  go_to({simulation().playback().here().stretch, end});
  EXPECT_EQ(hash(), last) << "the same hand did the same";
  // A run from the past without a hand is another one.
  go_to({simulation().playback().here().stretch, 5});
  run_to(end);
  go_to({simulation().playback().here().stretch, end});
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), end));
  EXPECT_NE(hash(), last);
}

TEST_P(TimeOnBackend, ArrowsOfThePastAreOfTheInputsThen) {
  open("cube-plane", {"simulation.gravity=[0,0,0]", "view.arrows=[\"external\"]"}, GetParam());
  run_to(20);
  const Vec3 place = simulation().snapshot().position[999];
  simulation().set_hand(Pull{999, place + Vec3{1.0, 1.0, 0.0}, 2000.0, 40.0});
  run_to(simulation().step() + 20);
  frames(2);
  EXPECT_NE(app().image.arrow_legend().title, "arrows") << "a force has a scale";
  go_to({simulation().playback().here().stretch, 5});
  frames(2);
  EXPECT_EQ(app().image.arrow_legend().title, "arrows") << "nobody pulled yet";
}

TEST_P(TimeOnBackend, PinsAndThrownBallsComeAndGoWithTime) {
  open("cube-plane", {"cube[0].position=[0,4,0]"}, GetParam());
  run_to(30);
  const Vec3 held = simulation().snapshot().position[0];
  ASSERT_TRUE(simulation().rebuild().toggle_pin(0).ok());
  run_to(simulation().step() + 30);
  EXPECT_EQ(simulation().snapshot().position[0], held) << "a pinned particle stays where it was";
  app().hands.throw_many();
  EXPECT_EQ(simulation().model().ball_count(), 12u);
  const Vec3 thrown = simulation().snapshot().ball_position[0];
  run_to(simulation().step() + 30);
  EXPECT_GT(length(simulation().snapshot().ball_position[0] - thrown), 0.1);
  ASSERT_TRUE(simulation().rebuild().toggle_pin(0).ok());
  run_to(simulation().step() + 30);
  EXPECT_NE(simulation().snapshot().position[0], held) << "freed again";
  const Moment end = simulation().playback().history().end_moment();
  const std::string last = hash();
  ASSERT_EQ(end.stretch - simulation().playback().history().begin_moment().stretch, 3u);

  go_to({end.stretch - 2, simulation().playback().history().stretch(end.stretch - 2).first + 3});
  EXPECT_EQ(simulation().snapshot().position[0], held);
  EXPECT_EQ(simulation().model().ball_count(), 0u);
  go_to({end.stretch - 3, 10});
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), 10));
  go_to(end);
  EXPECT_EQ(hash(), last);
  app().hands.clear_balls();
  EXPECT_EQ(simulation().model().ball_count(), 0u);
  simulation().set_hand(Pull{0, {}, 10.0, 1.0});
  press(GLFW_KEY_R);
  EXPECT_FALSE(simulation().hand().has_value());
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), 0));
  EXPECT_GT(simulation().model().inverse_mass[0], 0.0) << "a reset takes back what hands did";
}

TEST_P(TimeOnBackend, TheSecondBackendRunsAlongsideWithTheSameBits) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, GetParam());
  run_to(10);
  click("section/View");  // which, with the plot of energies, leaves the others no room
  click("section/Energy");
  click("section/Compare backends");
  click("shadow/on");
  ASSERT_TRUE(simulation().present().engines().shadowed());
  run_to(120);
  for (int i = 0; i < 3; ++i) type(U'.');
  simulation().set_hand(Pull{5, {0.0, 5.0, 0.0}, 2000.0, 10.0});
  run_to(simulation().step() + 40);
  simulation().set_hand(std::nullopt);
  app().gui().commands().run("throw a ball");
  press(GLFW_KEY_G);
  run_to(simulation().step() + 40);
  EXPECT_NE(simulation().present().backend().name, GetParam());
  ASSERT_GT(simulation().samples().differences().size(), 5u);
  for (const DifferenceSample& d : simulation().samples().differences()) {
    EXPECT_TRUE(d.identical) << d.time;
    EXPECT_EQ(d.ulp, 0u);
    EXPECT_EQ(d.meters, 0.0);
  }
  EXPECT_FALSE(simulation().samples().ever_differed());
  EXPECT_EQ(simulation().present().engines().shadow().solver.get()->model().ball_count(), 1u);
  click("shadow/on");
  EXPECT_FALSE(simulation().present().engines().shadowed());
}

INSTANTIATE_TEST_SUITE_P(Backends, TimeOnBackend, testing::Values("reference", "gpu"),
                         [](const auto& backend) { return backend.param; });

TEST_F(Time, PausedWithAShadowTheEnergiesOfTheRunStay) {
  open("cube-plane", {}, "gpu");
  ASSERT_TRUE(simulation().rebuild().set_shadow(&reference_backend()).ok());
  for (int i = 0; i < 3; ++i) type(U'.');
  frames_until([&] { return !simulation().busy(); });
  frames(3);
  const auto& energies = simulation().samples().energies();
  EXPECT_GT(energies.size(), 1u);
  // Twice as many steps: the plot has none of the last one, which is measured now.
  Scene scene = app().scene.scene();
  scene.model.simulation.timestep /= 2.0;
  app().scene.apply(std::move(scene), "time step");
  frames_until([&] { return simulation().step() == 6 && energies.back().step == 6; });
  EXPECT_GT(energies.size(), 1u);
}

TEST_F(Time, ADifferenceIsShown) {
  open("cube-plane", {}, "reference");
  ASSERT_TRUE(simulation().rebuild().set_shadow(&next_backend(simulation().present().backend())).ok());
  for (int i = 0; i < 3; ++i) type(U'.');
  EXPECT_FALSE(simulation().samples().ever_differed());
  // The second solver is led astray behind the window's back.
  State other = simulation().snapshot();
  other.position[7].y = static_cast<double>(std::nextafter(static_cast<float>(other.position[7].y), 0.0f));
  ASSERT_TRUE(const_cast<Solver*>(simulation().present().engines().shadow().solver.get())->load(other).ok());
  type(U'.');
  EXPECT_TRUE(simulation().samples().ever_differed());
  EXPECT_FALSE(simulation().samples().differences().back().identical);
  EXPECT_GE(simulation().samples().differences().back().ulp, 1u);
  EXPECT_GT(simulation().samples().differences().back().meters, 0.0);
}

TEST_F(Time, ValuesOfTheSceneGoBackAndForthWithTime) {
  open("cube-plane", {}, "reference");
  run_to(40);
  const std::uint64_t changed_at = simulation().step();
  app().scene.set_value(*find_parameter("simulation.gravity"), 0, Value(Vec3{0.0, 3.0, 0.0}), "");
  frames(2);
  run_to(changed_at + 40);
  const std::string last = hash();
  app().run.go_to(0.010);
  settle();
  EXPECT_EQ(simulation().step(), 10u);
  EXPECT_EQ(app().scene.editor().scene().model.simulation.gravity, (Vec3{0.0, -9.8, 0.0}));
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), 10));
  app().run.go_to(1e9);
  settle();
  EXPECT_EQ(app().scene.editor().scene().model.simulation.gravity, (Vec3{0.0, 3.0, 0.0}));
  EXPECT_EQ(hash(), last);
  frames(3);
  EXPECT_EQ(hash(), last) << "following the history changes nothing anew";
}

TEST_F(Time, AChangeOfTheTimeStepKeepsTheTime) {
  open("cube-plane", {}, "reference");
  run_to(50);
  const double t = simulation().time();
  app().scene.set_value(*find_parameter("simulation.timestep"), 0, Value(0.0005), "");
  frames(2);
  EXPECT_NEAR(simulation().time(), t, 0.00026);
  type(U',');
  settle();
  EXPECT_EQ(app().scene.editor().scene().model.simulation.timestep, 0.001);
  EXPECT_NEAR(simulation().time(), t - 0.001, 1e-9);
}

TEST_P(TimeOnBackend, AStableStepKeepsTheSceneAndThePlot) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]", "simulation.integrator=runge-kutta-4"}, GetParam());
  run_to(300);
  for (const char* type : {"structural", "shear", "bending"})
    app().scene.set_value(*find_parameter(fmt::format("cube[].{}.stiffness", type)), 0, Value(1e6), type);
  app().scene.set_value(*find_parameter("simulation.integrator"), 0, Value("explicit-euler"), "");
  simulation().set_running(true);
  frames_until([&] { return simulation().divergence().has_value(); });
  frames(2);
  const double end = simulation().time();
  const Moment before = simulation().playback().before_trouble();
  const double back = simulation().playback().history().time(before);
  click("diverged/stable");
  frames_until([&] {
    return !simulation().playback().seeking() && !simulation().rebuild().changing() && !app().scene.pending();
  });
  frames(3);
  EXPECT_FALSE(simulation().divergence().has_value());
  const ModelSettings& now = app().scene.scene().model;
  EXPECT_EQ(now.cubes[0].structural.stiffness, 1e6) << "what the user set";
  EXPECT_EQ(now.simulation.integrator, Integrator::explicit_euler);
  EXPECT_LT(now.simulation.timestep, 1e-3);
  EXPECT_EQ(simulation().model().simulation.timestep, now.simulation.timestep);
  EXPECT_EQ(simulation().present().setup().settings.cubes[0].structural.stiffness, 1e6);
  EXPECT_NEAR(simulation().time(), back, now.simulation.timestep) << "the state of shortly before";
  EXPECT_LT(back, end) << "when all was well";
  const auto& energies = simulation().samples().energies();
  EXPECT_NEAR(energies.back().time, simulation().time(), 1e-9);
  EXPECT_GE(energies.size(), static_cast<std::size_t>(back / 0.1)) << "the curve up to here is still there";
  for (std::size_t i = 1; i < energies.size(); ++i) EXPECT_LT(energies[i - 1].time, energies[i].time);
  for (const auto& sample : energies) EXPECT_LT(sample.measures.kinetic, 1e5) << sample.time;
  simulation().set_running(true);
  frames_to_step(simulation().step() + 200);
  EXPECT_FALSE(simulation().divergence().has_value());
}

TEST_P(TimeOnBackend, InThePastFiguresAreThoseOfThatMoment) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, GetParam());
  run_to(400);
  frames(4);
  const auto kinetic = [&] {
    const State state = simulation().snapshot();
    return measure(simulation().model(), state).kinetic;
  };
  for (const std::uint64_t step : {137u, 3u, 255u}) {
    go_to({simulation().playback().here().stretch, step});
    const EnergySample* shown = nullptr;
    frames_until([&] {  // a thread measures
      shown = simulation().samples().nearest(simulation().time());
      return shown && shown->step == step;
    });
    ASSERT_TRUE(shown);
    EXPECT_EQ(shown->step, step);
    EXPECT_EQ(shown->measures.kinetic, kinetic());
  }
}

TEST_F(Time, ALargeModelIsBuiltAsideAndNothingThatHandsDoIsLost) {
  open("cube-plane", {"cube[0].particles-per-edge=30", "cube[0].position=[0,2,0]"}, "reference");
  simulation().set_running(true);
  frames_to_step(5);
  app().scene.set_value(*find_parameter("simulation.gravity"), 0, Value(Vec3{0.0, -3.0, 0.0}), "");
  frames(1);
  // In the midst of it: a pin, a ball, another value.
  ASSERT_TRUE(simulation().rebuild().toggle_pin(7).ok());
  app().gui().commands().run("throw a ball");
  app().scene.set_value(*find_parameter("contact.friction"), 0, Value(0.7), "");
  frames_until(
      [&] { return !simulation().rebuild().changing() && simulation().model().contact.friction == 0.7; });
  EXPECT_EQ(simulation().model().simulation.gravity, (Vec3{0.0, -3.0, 0.0}));
  EXPECT_EQ(simulation().model().ball_count(), 1u);
  EXPECT_EQ(simulation().model().inverse_mass[7], 0.0);
  EXPECT_GE(simulation().step(), 5u);
  EXPECT_TRUE(simulation().running());
  // A scene opened meanwhile is not overtaken by an older value.
  app().scene.set_value(*find_parameter("contact.friction"), 0, Value(0.1), "");
  frames(1);
  app().scene.open("cube-bowl");
  frames(20);
  EXPECT_EQ(simulation().model().particle_count(), 1000u);
  EXPECT_EQ(simulation().model().terrain[0].friction, app().scene.editor().scene().model.contact.friction);
  EXPECT_EQ(simulation().model().terrain[0].shape, TerrainShape::bowl);
}

TEST_F(Time, TheBarGoesToAnyTime) {
  open("cube-plane", {"cube[0].position=[0,1.2,0]"}, "reference");
  run_to(200);
  const double last = simulation().time();
  frames(2);
  const app::Box bar = widgets().at("timeline");
  app().cursor(bar.right - 8.0, bar.center_y());
  frames(1);
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, 0);
  for (const double share : {0.9, 0.3, 0.5}) {
    app().cursor(bar.left + share * (bar.right - bar.left), bar.center_y());
    frames(2);
  }
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, 0);
  frames(1);
  settle();
  EXPECT_NEAR(simulation().time(), 0.5 * last, 0.05 * last);
  EXPECT_EQ(hash(), reference_hash(app().scene.editor().scene(), simulation().step()));
  EXPECT_FALSE(simulation().running());
}

TEST_F(Time, BThrowsABallAtWhatIsUnderTheMouse) {
  open("cube-plane", {"simulation.gravity=[0,0,0]", "cube[0].position=[0,2,0]"}, "reference");
  app().view.camera.jump_to({{0.0, 2.0, 14.0}, {0.0, 2.0, 0.0}, 45.0});
  frames(2);
  app().cursor(middle_x(), middle_y());
  frames(1);
  press(GLFW_KEY_B);
  ASSERT_EQ(simulation().model().ball_count(), 1u);
  const Vec3 v = simulation().snapshot().ball_velocity[0];
  EXPECT_LT(v.z, -14.0);
  EXPECT_NEAR(v.x, 0.0, 0.1);
  const double momentum = -v.z * simulation().model().balls[0].mass;
  run_to(1200);
  double cube = 0.0;
  for (const Vec3& u : simulation().snapshot().velocity) cube -= u.z;
  EXPECT_GT(cube, 0.5 * momentum) << "it hit the cube";
}

TEST_F(Time, CtrlDragPullsAndCtrlRightClickPins) {
  open("cube-plane", {"simulation.gravity=[0,0,0]", "cube[0].position=[0,3,0]", "view.draw=[\"particles\"]"},
       "reference");
  frames(3);
  const auto& view = app().view.box;
  const Camera camera = app().view.lens();
  const Vec3 corner = simulation().snapshot().position[999];
  const auto seen = test::project(camera, corner);
  ASSERT_TRUE(seen.has_value());
  const double x = view.left + seen->x, y = view.top + seen->y;
  app().cursor(x, y);
  frames(4);
  ASSERT_TRUE(app().pointer.hovered().has_value());
  ASSERT_EQ(app().pointer.hovered()->particle, 999u);
  const CameraSettings still = app().view.camera.goal();
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_PRESS, GLFW_MOD_CONTROL);
  app().cursor(x + 80.0, y - 40.0);
  ASSERT_TRUE(simulation().hand().has_value());
  EXPECT_EQ(simulation().hand()->particle, 999u);
  const auto anchor = test::project(camera, simulation().hand()->anchor);
  ASSERT_TRUE(anchor.has_value());
  EXPECT_NEAR(anchor->x, seen->x + 80.0, 0.5) << "the anchor is under the mouse";
  EXPECT_NEAR(anchor->y, seen->y - 40.0, 0.5);
  run_to(200);
  EXPECT_GT(length(simulation().snapshot().position[999] - corner), 0.05);
  app().mouse_button(GLFW_MOUSE_BUTTON_LEFT, GLFW_RELEASE, GLFW_MOD_CONTROL);
  EXPECT_FALSE(simulation().hand().has_value());
  EXPECT_EQ(app().view.camera.goal(), still) << "pulling does not turn the camera";

  press(GLFW_KEY_R);
  frames(2);
  app().cursor(x, y);
  frames(4);
  ASSERT_TRUE(app().pointer.hovered().has_value());
  const std::uint32_t particle = app().pointer.hovered()->particle;
  app().mouse_button(GLFW_MOUSE_BUTTON_RIGHT, GLFW_PRESS, GLFW_MOD_CONTROL);
  app().mouse_button(GLFW_MOUSE_BUTTON_RIGHT, GLFW_RELEASE, GLFW_MOD_CONTROL);
  EXPECT_EQ(simulation().model().inverse_mass[particle], 0.0);
}

}  // namespace
}  // namespace aspic::test

// States, series and checkpoints written from the window.
#include <gmock/gmock.h>

#include <fstream>

#include "app/stage.h"
#include "aspic/scene.h"
#include "cpu_reference/reference_solver.h"
#include "io/atomic_file.h"
#include "io/checkpoint.h"
#include "io/series_csv.h"
#include "support/state_csv_reader.h"

namespace aspic::test {
namespace {

using testing::HasSubstr;

class Output : public Stage {
 protected:
  /// A small cube in the middle of its fall, paused; the section is open.
  void open_falling(const char* backend) {
    open("cube-plane", {"cube[0].particles-per-edge=4", "view.draw=[\"particles\"]"}, backend);
    for (const char* section : {"View", "Performance", "Energy"}) click(std::string("section/") + section);
    click("section/Recording");
    press(GLFW_KEY_SPACE);
    frames_to_step(40);
    press(GLFW_KEY_SPACE);
    ASSERT_TRUE(simulation().settle().ok());
  }
  void save(const std::string& widget) {
    click("save/" + widget);
    click("files/accept");
    ASSERT_TRUE(app().messages.notice());
  }
  std::string path(const std::string& name) const { return (directory() / name).string(); }
};

class OutputOn : public Output, public testing::WithParamInterface<const char*> {};

TEST_P(OutputOn, AStateReadsBackToItsHash) {
  open_falling(GetParam());
  save("state.csv");
  EXPECT_FALSE(app().messages.notice()->is_error) << app().messages.notice()->text;
  const auto state = test::read_state_csv(path("aspic-cube-plane-0001.csv"), Precision::single);
  ASSERT_TRUE(state.ok()) << state.error().message();
  EXPECT_EQ(state_hash_text(*state), state_hash_text(simulation().snapshot()));
  EXPECT_EQ(state_hash_text(*state), reference_hash(app().scene.editor().scene(), simulation().step()));
}

TEST_P(OutputOn, ACheckpointGoesOnAsTheWindowDoes) {
  open_falling(GetParam());
  save("checkpoint.aspic");
  const auto checkpoint = read_checkpoint(path("aspic-cube-plane-0001.aspic"));
  ASSERT_TRUE(checkpoint.ok()) << checkpoint.error().message();
  EXPECT_EQ(checkpoint->state.step, simulation().step());
  const auto scene = parse_scene(checkpoint->scene, "checkpoint");
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  const auto model = build_model(scene->model);
  ASSERT_TRUE(model.ok());
  const auto solver = make_reference_solver(*model, Precision::single);
  ASSERT_TRUE(solver.ok());
  ASSERT_TRUE((*solver)->load(checkpoint->state).ok());
  for (int i = 0; i < 10; ++i) type(U'.');
  ASSERT_TRUE((*solver)->advance(10).ok());
  EXPECT_EQ(state_hash_text(*(*solver)->state()), state_hash_text(simulation().snapshot()));
}

/// What a hand does in a pause: it pulls, pins a particle, lets go.
TEST_P(OutputOn, InputsRepeatTheRun) {
  open_falling(GetParam());
  const Vec3 at = simulation().snapshot().position[63];
  const auto steps = [&](int count) {
    for (int i = 0; i < count; ++i) type(U'.');
    ASSERT_TRUE(simulation().settle().ok());
  };
  simulation().set_hand(Pull{63, at + Vec3{0.5, 1.0, 0.0}, 900.0, 20.0});
  steps(8);
  simulation().set_hand(Pull{63, at + Vec3{1.5, 1.0, 0.0}, 900.0, 20.0});
  steps(8);
  ASSERT_TRUE(simulation().rebuild().toggle_pin(5).ok());
  steps(8);
  const std::uint64_t between = simulation().step();
  save("checkpoint.aspic");
  EXPECT_FALSE(app().messages.notice()->is_error) << app().messages.notice()->text;
  simulation().set_hand(std::nullopt);
  steps(8);
  save("inputs.toml");
  EXPECT_FALSE(app().messages.notice()->is_error) << app().messages.notice()->text;
  const std::string hash = state_hash_text(simulation().snapshot());
  const std::uint64_t end = simulation().step();

  const Scene& scene = app().scene.editor().scene();
  const SharedModel model = shared(std::move(build_model(scene.model)).value());
  const auto log = read_inputs(path("aspic-cube-plane-0001-inputs.toml"), {scene.model, *model});
  ASSERT_TRUE(log.ok()) << log.error().message();
  EXPECT_EQ(log->entries().size(), 4u);
  const auto solver = std::move(make_reference_solver(model, Precision::single)).value();
  ASSERT_FALSE((*advance(*solver, *log, 0, end)).divergence.has_value());
  EXPECT_EQ(state_hash_text(*solver->state()), hash);

  // The checkpoint has the inputs up to its step, and the pull and the pin go on.
  const auto checkpoint = read_checkpoint(path("aspic-cube-plane-0001.aspic"));
  ASSERT_TRUE(checkpoint.ok()) << checkpoint.error().message();
  const auto kept = parse_inputs(checkpoint->inputs, "checkpoint", {scene.model, *model});
  ASSERT_TRUE(kept.ok()) << kept.error().message();
  InputLog so_far = *log;
  so_far.forget_from(between);
  EXPECT_EQ(*kept, so_far);
  EXPECT_EQ(kept->at(between).pinned, std::vector<std::uint32_t>{5});
  EXPECT_EQ(kept->at(between).pulls.size(), 1u);
  // Opened in the window, both go on there too.
  const auto on = std::move(make_reference_solver(model, Precision::single)).value();
  ASSERT_FALSE((*advance(*on, *kept, 0, between + 8)).divergence.has_value());
  app().scene.open("cube-sphere");
  app().scene.open(path("aspic-cube-plane-0001.aspic"));
  EXPECT_EQ(simulation().step(), between);
  steps(8);
  EXPECT_EQ(state_hash_text(simulation().snapshot()), state_hash_text(*on->state()));
  // Inputs that are dropped on the scene repeat the run from its start on.
  app().drop({path("aspic-cube-plane-0001-inputs.toml")});
  EXPECT_THAT(app().messages.notice()->text, HasSubstr("repeats the inputs of"));
  EXPECT_FALSE(app().messages.notice()->is_error);
  EXPECT_EQ(simulation().step(), 0u);
  steps(static_cast<int>(end));
  EXPECT_EQ(state_hash_text(simulation().snapshot()), hash);
  press(GLFW_KEY_R);
  steps(static_cast<int>(end));
  EXPECT_EQ(state_hash_text(simulation().snapshot()), hash);
  // The scene alone again.
  app().scene.open("cube-sphere");
  EXPECT_TRUE(simulation().stepper().log().empty());
}

TEST_F(Output, InputsOfAnotherSceneAreRefusedWithAWord) {
  open_falling("reference");
  const std::uint64_t step = simulation().step();
  const std::string other = path("other.toml");
  std::ofstream(other) << "timestep = 0.001\n[[inputs]]\nstep = 3\npinned = [64]\n";
  app().drop({other});
  ASSERT_TRUE(app().messages.notice());
  EXPECT_TRUE(app().messages.notice()->is_error);
  EXPECT_THAT(app().messages.notice()->text,
              testing::AllOf(HasSubstr("do not fit the scene"), HasSubstr("other.toml:4:"),
                             HasSubstr("there is no particle 64")));
  EXPECT_EQ(simulation().step(), step) << "all stays as it was";
  EXPECT_TRUE(simulation().stepper().log().empty());
}

TEST_P(OutputOn, ACheckpointIsOpenedWhereTheRunWas) {
  open_falling(GetParam());
  const std::uint64_t step = simulation().step();
  const std::string hash = state_hash_text(simulation().snapshot());
  save("checkpoint.aspic");
  app().scene.open("cube-sphere");
  app().scene.open(path("aspic-cube-plane-0001.aspic"));
  EXPECT_FALSE(app().messages.notice()) << app().messages.notice()->text;
  EXPECT_EQ(simulation().step(), step);
  EXPECT_EQ(state_hash_text(simulation().snapshot()), hash);
  for (int i = 0; i < 10; ++i) type(U'.');
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_EQ(state_hash_text(simulation().snapshot()),
            reference_hash(app().scene.editor().scene(), simulation().step()));
  for (int i = 0; i < 20; ++i) type(U',');
  ASSERT_TRUE(simulation().settle().ok());
  EXPECT_EQ(simulation().step(), step) << "the history begins there";
  press(GLFW_KEY_R);
  EXPECT_EQ(simulation().step(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Output, OutputOn, testing::Values("reference", "gpu"),
                         [](const auto& backend) { return std::string(backend.param); });

TEST_F(Output, ASeriesHasARowForEachPointOfThePlot) {
  open_falling("reference");
  save("series.csv");
  const auto text = read_file(path("aspic-cube-plane-0001.csv"));
  ASSERT_TRUE(text.ok()) << text.error().message();
  EXPECT_THAT(*text, testing::StartsWith(std::string(series_csv_header) + "\n0,0,"));
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(*text, '\n')),
            simulation().samples().energies().size() + 1);
  EXPECT_GT(simulation().samples().energies().size(), 1u);
}

TEST_F(Output, WhatExistsIsKeptAndTheNextNameIsFree) {
  open_falling("reference");
  std::ofstream(directory() / "aspic-cube-plane-0001.csv") << "precious";
  save("state.csv");
  EXPECT_EQ(*read_file(path("aspic-cube-plane-0001.csv")), "precious");
  EXPECT_TRUE(test::read_state_csv(path("aspic-cube-plane-0002.csv"), Precision::single).ok());
  click("save/state.csv");
  click("files/entry/aspic-cube-plane-0001.csv");
  click("files/name");
  press(GLFW_KEY_ENTER);
  frames(3);
  EXPECT_EQ(*read_file(path("aspic-cube-plane-0001.csv")), "precious") << "Enter alone asks";
  click("files/cancel");
  EXPECT_EQ(*read_file(path("aspic-cube-plane-0001.csv")), "precious");
  click("save/state.csv");
  click("files/entry/aspic-cube-plane-0001.csv");
  click("files/accept");
  EXPECT_NE(*read_file(path("aspic-cube-plane-0001.csv")), "precious") << "the button said Replace";
}

TEST_F(Output, ACheckpointIsRefusedWhereHandsAddedBodies) {
  open_falling("reference");
  app().gui().commands().run("throw a ball");
  frames(2);
  save("checkpoint.aspic");
  EXPECT_TRUE(app().messages.notice()->is_error);
  EXPECT_THAT(app().messages.notice()->text, HasSubstr("thrown"));
  save("inputs.toml");
  EXPECT_TRUE(app().messages.notice()->is_error);
  EXPECT_THAT(app().messages.notice()->text, HasSubstr("thrown"));
  EXPECT_FALSE(std::filesystem::exists(directory() / "aspic-cube-plane-0001.aspic"));
  save("state.csv");
  EXPECT_FALSE(app().messages.notice()->is_error) << app().messages.notice()->text;
}

}  // namespace
}  // namespace aspic::test

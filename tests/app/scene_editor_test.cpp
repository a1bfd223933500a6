#include "app/scene_editor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "aspic/scene.h"
#include "scene/write.h"

namespace aspic::app {
namespace {

SceneEditor editor_of(const std::string& scene) {
  auto editor = SceneEditor::open(scene, {});
  EXPECT_TRUE(editor.ok());
  return std::move(*editor);
}

const Parameter& key(std::string_view path) {
  return *find_parameter(path);
}

TEST(SceneEditor, EffectsFollowTheTable) {
  for (const Parameter& p : parameters()) {
    if (p.path != "simulation.timestep" && p.path != "cube[].edge-length" && p.path != "view.camera.fov")
      continue;
    SceneEditor editor = editor_of("cube-plane");
    const auto effect = editor.set(p, 0, Value(0.5 * std::get<double>(*p.get(editor.scene(), 0))), "");
    ASSERT_TRUE(effect.ok());
    const Effect expected = p.path.starts_with("view.") ? Effect::view
                            : p.live                    ? Effect::constants
                                                        : Effect::restart;
    EXPECT_EQ(*effect, expected) << p.path;
  }
}

TEST(SceneEditor, TheSameValueIsNoChange) {
  SceneEditor editor = editor_of("cube-plane");
  const Parameter& step = key("simulation.timestep");
  const auto effect = editor.set(step, 0, *step.get(editor.scene(), 0), "");
  ASSERT_TRUE(effect.ok());
  EXPECT_EQ(*effect, Effect::none);
  EXPECT_FALSE(editor.can_undo());
}

TEST(SceneEditor, AGestureIsOneEntryAndItsEndBeginsAnother) {
  SceneEditor editor = editor_of("cube-plane");
  const Parameter& step = key("simulation.timestep");
  for (const double h : {0.0011, 0.0012, 0.0013}) ASSERT_TRUE(editor.set(step, 0, Value(h), "drag").ok());
  editor.end_gesture();
  ASSERT_TRUE(editor.set(step, 0, Value(0.0014), "drag").ok());
  editor.undo();
  EXPECT_EQ(editor.scene().model.simulation.timestep, 0.0013);
  editor.undo();
  EXPECT_EQ(editor.scene().model.simulation.timestep, 0.001);
  EXPECT_FALSE(editor.can_undo());
  editor.redo();
  editor.redo();
  EXPECT_EQ(editor.scene().model.simulation.timestep, 0.0014);
  EXPECT_FALSE(editor.can_redo());
}

TEST(SceneEditor, AChangeAfterUndoForgetsWhatWasUndone) {
  SceneEditor editor = editor_of("cube-plane");
  const Parameter& step = key("simulation.timestep");
  ASSERT_TRUE(editor.set(step, 0, Value(0.002), "").ok());
  EXPECT_EQ(editor.undo(), Effect::constants);
  ASSERT_TRUE(editor.set(key("contact.friction"), 0, Value(0.7), "").ok());
  EXPECT_FALSE(editor.can_redo());
}

TEST(SceneEditor, WhatTheWholeSceneForbidsChangesNothing) {
  SceneEditor editor = editor_of("cube-plane");
  // Legal by itself, but in the camera's target.
  const auto refused =
      editor.set(key("view.camera.position"), 0, Value(editor.scene().view.camera.target), "");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::scene_rejected);
  EXPECT_FALSE(editor.can_undo());
  Scene empty = editor.scene();
  empty.model.cubes.clear();
  empty.model.terrain.clear();
  EXPECT_FALSE(editor.apply(empty, "nothing", "").ok());
  EXPECT_EQ(editor.scene().model.cubes.size(), 1u);
}

// A name that is no UTF-8 cannot be written as TOML and read back.
TEST(SceneEditor, EditsGoThroughNoText) {
  SceneEditor editor = editor_of("cube-plane");
  Scene named = editor.scene();
  named.name = std::string(1, static_cast<char>(0xff));
  const auto by_text = parse_scene(to_toml(named), "named.toml");
  ASSERT_TRUE(by_text.ok());
  ASSERT_NE(by_text->name, named.name);  // text cannot hold it, and is written with an escape instead
  ASSERT_TRUE(editor.apply(named, "name", "").ok());
  const auto effect = editor.set(key("simulation.timestep"), 0, Value(0.002), "");
  ASSERT_TRUE(effect.ok()) << effect.error().message();
  EXPECT_EQ(*effect, Effect::constants);
  EXPECT_EQ(editor.scene().name, named.name);
}

TEST(SceneEditor, ComparesValuesNotTheirText) {
  SceneEditor editor = editor_of("cube-plane");
  const Parameter& gravity = key("simulation.gravity");
  Vec3 value = std::get<Vec3>(*gravity.get(editor.scene(), 0));
  value.x = -0.0;  // written as -0.0, but equal to the scene's 0.0
  EXPECT_EQ(*editor.set(gravity, 0, Value(value), ""), Effect::none);
  value.y = std::nextafter(value.y, 0.0);
  EXPECT_EQ(*editor.set(gravity, 0, Value(value), ""), Effect::constants);
}

TEST(SceneEditor, RefusesInASentencePerComplaint) {
  SceneEditor editor = editor_of("cube-plane");
  Scene wrong = editor.scene();
  wrong.model.cubes[0].edge_length = -1.0;
  wrong.model.cubes[0].pinned.indices = {1000};
  const auto refused = editor.apply(wrong, "wrong", "");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message(),
            "'cube.edge-length' is out of range: -1; allowed: a number > 0 and ≤ 1e6 m\n"
            "'cube.pinned' index 1000 is not in the cube; allowed: 0 … 999");
}

TEST(SceneEditor, OpeningIsAnEntryThatComesBackToTheChanges) {
  SceneEditor editor = editor_of("cube-plane");
  const Parameter& step = key("simulation.timestep");
  ASSERT_TRUE(editor.set(step, 0, Value(0.002), "").ok());
  editor.open(editor_of("cube-sphere"));
  EXPECT_EQ(editor.source(), "cube-sphere");
  EXPECT_FALSE(editor.changed());
  ASSERT_TRUE(editor.set(step, 0, Value(0.0005), "").ok());
  EXPECT_TRUE(editor.changed());
  EXPECT_EQ(editor.undo(), Effect::constants);
  EXPECT_FALSE(editor.changed());
  EXPECT_EQ(editor.undo_name(), "open cube-sphere");
  EXPECT_EQ(editor.undo(), Effect::opening);
  EXPECT_EQ(editor.source(), "cube-plane");
  EXPECT_EQ(editor.scene().model.simulation.timestep, 0.002);
  EXPECT_TRUE(editor.changed()) << "from the last session";
  EXPECT_EQ(editor.undo(), Effect::constants);
  EXPECT_FALSE(editor.changed());
  editor.redo();
  EXPECT_EQ(editor.redo(), Effect::opening);
  EXPECT_EQ(editor.source(), "cube-sphere");
  EXPECT_FALSE(editor.changed());
  // The same scene once more, as it is: nothing to come back to.
  editor.open(editor_of("cube-sphere"));
  EXPECT_EQ(editor.undo_name(), "open cube-sphere");
  EXPECT_EQ(editor.undo(), Effect::opening);
}

TEST(SceneEditor, WithdrawsAChangeAndKeepsLaterOnes) {
  SceneEditor editor = editor_of("cube-plane");
  const Parameter& step = key("simulation.timestep");
  const Parameter& friction = key("contact.friction");
  const Value friction_before = *friction.get(editor.scene(), 0);
  ASSERT_TRUE(editor.set(friction, 0, Value(0.25), "").ok());
  const std::uint64_t taken = editor.last_change();
  ASSERT_TRUE(editor.set(step, 0, Value(0.002), "").ok());
  const std::uint64_t last = editor.last_change();
  ASSERT_TRUE(editor.set(friction, 0, Value(0.7), "").ok());
  ASSERT_TRUE(editor.set(friction, 0, Value(0.8), "").ok());
  EXPECT_TRUE(editor.withdraw(taken, last));
  EXPECT_EQ(editor.scene().model.simulation.timestep, 0.001);
  EXPECT_EQ(editor.scene().model.contact.friction, 0.8);
  EXPECT_FALSE(editor.withdraw(taken, last)) << "it is gone";
  for (const double before : {0.7, 0.25, std::get<double>(friction_before)}) {
    editor.undo();
    EXPECT_EQ(editor.scene().model.contact.friction, before);
    EXPECT_EQ(editor.scene().model.simulation.timestep, 0.001);
  }
  EXPECT_FALSE(editor.can_undo());
  EXPECT_FALSE(editor.changed());
}

TEST(SceneEditor, WithdrawsLaterChangesThatDependOnIt) {
  SceneEditor editor = editor_of("cube-plane");
  Scene two = editor.scene();
  two.model.cubes.push_back(two.model.cubes[0]);
  two.model.cubes[1].position.x += 8.0;
  ASSERT_TRUE(editor.apply(two, "another cube", "").ok());
  const std::uint64_t last = editor.last_change();
  ASSERT_TRUE(editor.set(key("cube[].edge-length"), 1, Value(2.0), "").ok());
  EXPECT_TRUE(editor.withdraw(0, last));
  EXPECT_EQ(editor.scene().model.cubes.size(), 1u);
  EXPECT_FALSE(editor.can_undo());
  editor.redo();
  editor.redo();
  EXPECT_EQ(editor.scene().model.cubes[1].edge_length, 2.0);
}

TEST(SceneEditor, WithdrawsNoOpening) {
  SceneEditor editor = editor_of("cube-plane");
  editor.open(editor_of("cube-sphere"));
  EXPECT_FALSE(editor.withdraw(0, editor.last_change()));
  EXPECT_EQ(editor.source(), "cube-sphere");
}

TEST(SceneEditor, TheOldestEntriesAreForgottenOfEverySource) {
  SceneEditor editor = editor_of("cube-plane");
  editor.open(editor_of("cube-sphere"));
  const Parameter& step = key("simulation.timestep");
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(editor.set(step, 0, Value(0.0001 * (i + 11)), "").ok());
  while (editor.can_undo()) editor.undo();
  EXPECT_EQ(editor.source(), "cube-sphere");
  EXPECT_TRUE(editor.changed()) << "the file's own scene is beyond what is remembered";
}

TEST(SceneEditor, OverridesSurviveAReloadAndGoWithTheirScene) {
  auto editor = SceneEditor::open("cube-plane", {"simulation.timestep=0.0005"});
  ASSERT_TRUE(editor.ok());
  ASSERT_TRUE(editor->set(key("simulation.timestep"), 0, Value(0.002), "").ok());
  const auto reloaded = editor->other("cube-plane");
  ASSERT_TRUE(reloaded.ok());
  EXPECT_EQ(reloaded->scene().model.simulation.timestep, 0.0005);
  EXPECT_FALSE(reloaded->changed());
  const auto sphere = editor->other("cube-sphere");
  ASSERT_TRUE(sphere.ok());
  EXPECT_EQ(sphere->source(), "cube-sphere");
  EXPECT_EQ(sphere->scene().model.simulation.timestep, load_scene("cube-sphere")->model.simulation.timestep);
  EXPECT_FALSE(editor->other("no-such-scene").ok());
}

}  // namespace
}  // namespace aspic::app

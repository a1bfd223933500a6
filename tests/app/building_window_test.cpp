// Bodies that are made in the window: added, painted cell by cell, of materials, from meshes; and what is
// saved of them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <fstream>

#include "app/stage.h"
#include "base/files.h"
#include "cpu_reference/reference_solver.h"
#include "model/bodies.h"
#include "model/voxels.h"
#include "scene/scene_checks.h"

namespace aspic::test {
namespace {

using app::Box;
using app::CellPlace;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::StartsWith;

class Building : public Stage {
 protected:
  std::array<int, 2> window_size() const override { return {1280, 480}; }
  /// Opens a scene with these sections open alone.
  void open_with(const std::string& scene, const std::vector<std::string>& sections,
                 std::vector<std::string> overrides = {}) {
    app::KeptState kept;
    kept.greeted = true;
    for (const char* name : {"Scene", "Simulation", "Springs", "View", "Energy"})
      kept.layout.sections[name] = false;
    for (const std::string& section : sections) kept.layout.sections[section] = true;
    open(scene, std::move(overrides), "reference", kept);
  }
  const ModelSettings& settings() { return app().scene.scene().model; }
  const VoxelsSettings& body() { return settings().voxels[app().cells.body()]; }
  std::array<double, 2> middle_of(const CellPlace& place) {
    const Box grid = widgets().at("cells/grid");
    const auto [columns, high, rows] = app::size_of(app().cells.voxels().layers);
    return {grid.left + (place.column + 0.5) * (grid.right - grid.left) / columns,
            grid.top + (place.row + 0.5) * (grid.bottom - grid.top) / rows};
  }
  /// Presses a button on a cell and lets go of it on another.
  void stroke(int button, const CellPlace& from, const CellPlace& to) {
    bring_into_sight("cells/layer");  // what is above the grid
    const auto a = middle_of(from), b = middle_of(to);
    drag(button, a[0], a[1], b[0] - a[0], b[1] - a[1]);
    frames(3);
  }
  void paint(const CellPlace& from, const CellPlace& to) { stroke(GLFW_MOUSE_BUTTON_LEFT, from, to); }
  void erase(const CellPlace& from, const CellPlace& to) { stroke(GLFW_MOUSE_BUTTON_RIGHT, from, to); }
  std::string file(const std::string& name, const std::string& text) {
    const std::string path = (directory() / name).string();
    std::ofstream(path) << text;
    return path;
  }
  std::string notice() { return app().messages.notice() ? app().messages.notice()->text : ""; }
};

constexpr const char* beam = R"(schema = 1
name = "beam"

[material]
rubber = { density = 20.0, youngs-modulus = 30000.0, damping-ratio = 0.5 }
stone = { density = 40.0, youngs-modulus = 90000.0, damping-ratio = 0.5 }

[[terrain]]

[[voxels]]
size = 0.25                              # m
position = [0.0, 1.0, 0.0]               # m
palette = { 1 = "rubber", 2 = "stone" }
layers = [
  ["1111",
   "1111"],
]
)";

TEST_F(Building, ButtonsStayUnderTheMouseWhileRowsAreAddedAbove) {
  open_with("cube-plane", {"Springs", "Bodies"});
  bring_into_sight("cube/add");
  const Box before = widgets().at("cube/add");
  for (const std::size_t cubes : {2u, 3u}) {
    click("cube/add");
    frames(4);
    EXPECT_EQ(settings().cubes.size(), cubes);
    EXPECT_NEAR(widgets().at("cube/add").top, before.top, 1.5);
  }
}

TEST_F(Building, CellsArePaintedByMouseAndSavedAsAPersonWouldWriteThem) {
  open_with(file("beam.toml", beam), {"Cells"});
  const std::uint32_t particles = simulation().model().particle_count();
  click("cells/palette/2");
  paint({1, 1}, {1, 3});
  EXPECT_EQ(body().layers, (CellLayers{{"1111", "1222"}})) << "up to where the button came up";
  erase({1, 0}, {1, 0});
  EXPECT_EQ(body().layers, (CellLayers{{"1111", ".222"}}));
  EXPECT_EQ(simulation().model().particle_count(), particles - 2) << "what is painted is simulated";
  click("cells/copy");
  EXPECT_EQ(app().cells.layer(), 1) << "the copy is shown";
  erase({0, 1}, {0, 3});
  EXPECT_EQ(body().layers, (CellLayers{{"1111", ".222"}, {"1...", ".222"}}));
  click("cells/grow/right");
  EXPECT_EQ(body().layers, (CellLayers{{"1111.", ".222."}, {"1....", ".222."}}));
  EXPECT_EQ(simulation().model().particle_count(), voxel_counts(body()).particles);

  const std::string path = (directory() / "mine.toml").string();
  app().scene.save_as(path);
  const auto saved = read_file(path);
  ASSERT_TRUE(saved.ok());
  EXPECT_THAT(*saved, StartsWith(R"(schema = 1
name = "beam"

[[terrain]]

[material]
rubber = { density = 20.0, youngs-modulus = 30000.0, damping-ratio = 0.5 }
stone = { density = 40.0, youngs-modulus = 90000.0, damping-ratio = 0.5 }

[[voxels]]
size = 0.25                     # m
position = [0.125, 1.125, 0.0]  # m
palette = { 1 = "rubber", 2 = "stone" }
layers = [
  ["1111.",
   ".222."],
  ["1....",
   ".222."],
]
)"));
  const auto again = load_scene(path);
  ASSERT_TRUE(again.ok()) << again.error().message();
  EXPECT_EQ(effect_between(*again, app().scene.scene()), Effect::none);

  // Each stroke and button is one step back.
  for (const CellLayers& before :
       {CellLayers{{"1111", ".222"}, {"1...", ".222"}}, CellLayers{{"1111", ".222"}, {"1111", ".222"}},
        CellLayers{{"1111", ".222"}}, CellLayers{{"1111", "1222"}}, CellLayers{{"1111", "1111"}}}) {
    press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
    frames(1);
    EXPECT_EQ(body().layers, before);
  }
  for (int i = 0; i < 5; ++i) press(GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  frames(3);
  EXPECT_EQ(effect_between(*again, app().scene.scene()), Effect::none) << "and forth again";
}

TEST_F(Building, AStrokePaintsOnlyFromItsBeginningToItsEnd) {
  open_with(file("beam.toml", beam), {"Cells"});
  app::CellEditor& cells = app().cells;
  cells.stroke({1, 3});
  EXPECT_EQ(body().layers, (CellLayers{{"1111", "1111"}}));
  cells.begin_stroke({0, 0}, '2');
  cells.stroke({0, 1});
  cells.end_stroke();
  cells.stroke({1, 3});
  EXPECT_EQ(body().layers, (CellLayers{{"2211", "1111"}}));
}

TEST_F(Building, RefusedCellsWaitAndNothingIsLost) {
  open_with(file("beam.toml", beam), {"Cells"});
  erase({0, 2}, {1, 2});
  EXPECT_EQ(body().layers, (CellLayers{{"11.1", "1111"}})) << "the scene has as much as is one piece";
  EXPECT_EQ(app().cells.voxels().layers, (CellLayers{{"11.1", "11.1"}})) << "and what was painted is shown";
  EXPECT_THAT(app().cells.refusal(), HasSubstr("2 pieces"));
  ASSERT_TRUE(has("cells/refusal"));
  erase({1, 3}, {1, 3});
  EXPECT_EQ(app().cells.voxels().layers, (CellLayers{{"11.1", "11.."}}));
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(1);
  EXPECT_EQ(app().cells.voxels().layers, (CellLayers{{"11.1", "11.1"}})) << "what waits is undone first";
  EXPECT_EQ(body().layers, (CellLayers{{"11.1", "1111"}}));
  // A stroke that joins the pieces is taken with all that waits, as one change.
  click("cells/palette/2");
  paint({1, 2}, {1, 2});
  EXPECT_EQ(body().layers, (CellLayers{{"11.1", "1121"}}));
  EXPECT_FALSE(has("cells/refusal"));
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(2);
  EXPECT_EQ(body().layers, (CellLayers{{"11.1", "1111"}}));
  // Or the body may be several.
  erase({1, 2}, {1, 2});
  click("cells/all");
  EXPECT_EQ(body().layers, (CellLayers{{"11.1", "11.1"}}));
  EXPECT_EQ(body().pieces, Pieces::all);
  // No cell is left: that waits as well.
  click("cells/clear");
  EXPECT_EQ(body().layers, (CellLayers{{"11.1", "11.1"}}));
  EXPECT_THAT(app().cells.refusal(), HasSubstr("all its cells are empty"));
  EXPECT_FALSE(has("cells/all"));
  click("cells/back");
  EXPECT_EQ(app().cells.voxels().layers, (CellLayers{{"11.1", "11.1"}}));
  EXPECT_FALSE(app().messages.notice() && app().messages.notice()->is_error) << notice();
}

TEST_F(Building, DigitsPagesAndTheMiddleButtonChoose) {
  open_with(file("beam.toml", beam), {"Cells"});
  const auto brush = [&] { return app().cells.brush(); };
  EXPECT_EQ(brush(), '1');
  type(U'2');
  EXPECT_EQ(brush(), '2');
  type(U'9');
  EXPECT_EQ(brush(), '2') << "there is no ninth";
  type(U'0');
  EXPECT_EQ(brush(), app::empty_cell);
  stroke(GLFW_MOUSE_BUTTON_MIDDLE, {0, 0}, {0, 0});
  EXPECT_EQ(brush(), '1');
  EXPECT_EQ(body().layers, (CellLayers{{"1111", "1111"}})) << "it does not paint";
  click("cells/copy");
  press(GLFW_KEY_PAGE_DOWN);
  EXPECT_EQ(app().cells.layer(), 0);
  press(GLFW_KEY_PAGE_DOWN);
  EXPECT_EQ(app().cells.layer(), 0);
  press(GLFW_KEY_PAGE_UP);
  EXPECT_EQ(app().cells.layer(), 1);
}

TEST_F(Building, MaterialsComeAndGoAndBodiesFollow) {
  open_with("cube-plane", {"Materials", "Bodies"}, {"cube[0].particles-per-edge=3"});
  click("material/add");
  ASSERT_EQ(settings().materials.size(), 1u);
  const std::string name = settings().materials[0].name;
  click("cube/0/made-of");
  click("cube/0/made-of/" + name);
  frames(2);
  ASSERT_TRUE(settings().cubes[0].material.has_value());
  EXPECT_EQ(settings().cubes[0].material->name, name);
  // A name is typed.
  click("material/0/name");
  for (const char c : std::string("cork")) app().character(static_cast<unsigned char>(c));
  frames(8);
  press(GLFW_KEY_ENTER);
  frames(3);
  EXPECT_EQ(settings().materials[0].name, "cork");
  EXPECT_EQ(settings().cubes[0].material->name, "cork");
  click("material/0/remove");
  EXPECT_TRUE(settings().materials.empty());
  EXPECT_EQ(settings().cubes[0].material->name, "");
  EXPECT_THAT(notice(), HasSubstr("cube[0] keeps its density"));
  click("cube/0/made-of");
  click("cube/0/made-of/springs by type");
  EXPECT_FALSE(settings().cubes[0].material.has_value());
  for (int i = 0; i < 5; ++i) press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(2);
  EXPECT_TRUE(settings().materials.empty());
  EXPECT_FALSE(app().scene.editor().can_undo());
}

TEST_F(Building, ActuatorsAreAddedSteeredAndRemoved) {
  open_with("worm", {"Bodies"}, {"actuator[0].signal=input", "actuator[0].ramp=0"});
  simulation().set_running(false);
  // A slider of the input; no change of the scene.
  bring_into_sight("actuator/0/input");
  frames(2);
  const Box slider = widgets().at("actuator/0/input");
  const double middle = 0.5 * (slider.left + slider.right);
  drag(GLFW_MOUSE_BUTTON_LEFT, middle, slider.center_y(), slider.right - middle, 0.0);
  frames(3);
  const std::vector<double> channels = simulation().inputs().channels;
  ASSERT_EQ(channels.size(), 1u);
  EXPECT_GT(channels[0], 0.3);
  EXPECT_FALSE(app().scene.editor().can_undo());
  for (int n = 0; n < 3; ++n) EXPECT_TRUE(simulation().single_step().ok());
  EXPECT_TRUE(simulation().playback().settle().ok());
  const auto reference = make_reference_solver(build_model(settings()).value(), Precision::single).value();
  ASSERT_TRUE(reference->set_inputs({.channels = channels}).ok());
  ASSERT_FALSE(reference->advance(3)->divergence.has_value());
  EXPECT_TRUE(simulation().refresh_snapshot().ok());
  EXPECT_EQ(simulation().snapshot(), reference->state().value());
  // The log of the run knows it, a reset takes it back.
  EXPECT_EQ(simulation().playback().history().inputs_at(simulation().playback().here()).channels.size(), 1u);
  EXPECT_TRUE(simulation().rebuild().reset().ok());
  EXPECT_TRUE(simulation().inputs().channels.empty());
  // Another one, for the same body.
  bring_into_sight("voxels/0/actuator");
  click("voxels/0/actuator");
  frames(2);
  ASSERT_EQ(settings().actuators.size(), 2u);
  EXPECT_THAT(settings().actuators[1].bodies, ElementsAre("worm"));
  EXPECT_FALSE(has("actuator/1/input")) << "a sine has none";
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(2);
  EXPECT_EQ(settings().actuators.size(), 1u);
  bring_into_sight("actuator/0/remove");
  click("actuator/0/remove");
  frames(2);
  EXPECT_TRUE(settings().actuators.empty());
  EXPECT_FALSE(has("actuator/0/input"));
}

TEST_F(Building, APaletteGrowsAndCellsKeepTheirMaterial) {
  open_with("cube-plane", {"Bodies", "Cells"}, {"cube[0].particles-per-edge=3"});
  click("voxels/add");
  ASSERT_EQ(settings().voxels.size(), 1u);
  EXPECT_TRUE(body().palette.empty());
  click("section/Bodies");
  click("cells/palette/add");
  EXPECT_THAT(body().palette, ElementsAre(Pair("1", "material"), Pair("2", "material-2")));
  EXPECT_EQ(app().cells.brush(), '2');
  paint({0, 0}, {0, 0});
  EXPECT_EQ(body().layers.front().front().front(), '2');
  click("cells/palette/1/material");
  click("cells/palette/1/material/material-2");
  EXPECT_EQ(body().palette.at("1"), "material-2");
  frames(2);
  EXPECT_THAT(explanations().at("cells/palette/2/remove"), HasSubstr("Erase its cells"));
  click("cells/palette/2/remove");
  EXPECT_EQ(body().palette.size(), 2u) << "cells are of it";
  erase({0, 0}, {0, 0});
  frames(2);
  click("cells/palette/2/remove");
  EXPECT_THAT(body().palette, ElementsAre(Pair("1", "material-2")));
  click("section/Bodies");
  click("voxels/0/made-of");
  click("voxels/0/made-of/a material of its own");
  EXPECT_TRUE(body().palette.empty());
}

/// A tetrahedron, closed, and sized as asked.
std::string tetrahedron(double size) {
  return fmt::format("v 0 0 0\nv {0} 0 0\nv 0 {0} 0\nv 0 0 {0}\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", size);
}

TEST_F(Building, AMeshThatIsDroppedIsABodyAboveWhatIsThere) {
  open_with("cube-plane", {"Bodies", "Cells"}, {"cube[0].particles-per-edge=3"});
  const std::string source = app().scene.editor().source();
  app().drop({file("pyramid.obj", tetrahedron(3.0))});
  frames(3);
  ASSERT_EQ(settings().voxels.size(), 1u);
  EXPECT_EQ(app().scene.editor().source(), source) << "the scene that was open";
  EXPECT_FALSE(settings().voxels[0].skin.empty());
  EXPECT_THAT(notice(), HasSubstr("pyramid.obj is now a body"));
  EXPECT_THAT(notice(), HasSubstr("cells"));
  EXPECT_FALSE(app().messages.notice()->is_error);
  EXPECT_EQ(simulation().model().particle_count(), 27 + voxel_counts(settings().voxels[0]).particles);
  EXPECT_TRUE(check_scene(app().scene.scene()).empty());
  // Its cells are painted once the skin is off.
  EXPECT_FALSE(has("cells/grid"));
  click("cells/without-skin");
  EXPECT_TRUE(settings().voxels[0].skin.empty());
  EXPECT_TRUE(has("cells/grid"));
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  press(GLFW_KEY_Z, GLFW_MOD_CONTROL);
  frames(2);
  EXPECT_TRUE(settings().voxels.empty());
  // In millimeters it would be a thousand times as large.
  app().drop({file("millimeters.obj", tetrahedron(3000.0))});
  frames(3);
  ASSERT_EQ(settings().voxels.size(), 1u);
  EXPECT_THAT(notice(), HasSubstr("scaled"));
  EXPECT_LT(settings().voxels[0].size * 24, 8.0);
}

TEST_F(Building, AHopelessMeshIsRefusedWithItsFiguresAndScenesAreOpenedAsBefore) {
  open_with("cube-plane", {"Bodies"}, {"cube[0].particles-per-edge=3"});
  app().drop({file("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n")});
  frames(2);
  EXPECT_TRUE(settings().voxels.empty());
  ASSERT_TRUE(app().messages.notice() && app().messages.notice()->is_error);
  EXPECT_THAT(notice(), HasSubstr("sheet.obj"));
  EXPECT_FALSE(app().scene.editor().can_undo());
  const std::string scene = file("beam.toml", beam);
  app().drop({scene});
  frames(2);
  EXPECT_EQ(app().scene.editor().source(), scene);
  app().drop({file("pyramid.obj", tetrahedron(0.5))});
  frames(3);
  EXPECT_EQ(settings().voxels.size(), 2u) << "a body of the scene that was dropped";
}

}  // namespace
}  // namespace aspic::test

// Bodies of cells that scenes make of meshes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "model/model.h"
#include "model/skin.h"
#include "model/skin_text.h"
#include "scene/import_mesh.h"
#include "scene/scene_support.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// A box of 2 × 1 × 0.5 m.
constexpr std::string_view box =
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 0 0 0.5\nv 2 0 0.5\nv 2 1 0.5\nv 0 1 0.5\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

const std::string voxels_table = "schema = 1\n[[voxels]]\n";

std::string box_file(const test::TemporaryDirectory& dir) {
  dir.write("box.obj", std::string(box));
  return dir.file("box.obj");
}

TEST(MeshScene, BecomesLayersSizeAndSkin) {
  const test::TemporaryDirectory dir;
  const Scene scene = test::parsed(voxels_table + fmt::format("mesh = \"{}\"\ncells = 8\n", box_file(dir)));
  const VoxelsSettings& voxels = scene.model.voxels.at(0);
  EXPECT_EQ(voxels.layers, CellLayers(4, std::vector<std::string>(2, "11111111")));
  EXPECT_EQ(voxels.size, 0.25);
  const auto skin = mesh_of_skin_text(voxels.skin);
  ASSERT_TRUE(skin);
  EXPECT_EQ(skin->triangles.size(), 12u);
  EXPECT_THAT(skin->vertices, Contains(Vec3{8.0, 4.0, 2.0}));
  EXPECT_THAT(skin->vertices, Contains(Vec3{0.0, 0.0, 0.0}));
  const Scene tall = test::parsed(
      voxels_table + fmt::format("mesh = \"{}\"\ncells = 8\nheight = 0.1\nup = \"z\"\n", box_file(dir)));
  EXPECT_EQ(tall.model.voxels[0].layers, CellLayers(2, std::vector<std::string>(4, "11111111")));
  EXPECT_NEAR(tall.model.voxels[0].size, 0.05, 1e-15);
}

TEST(MeshScene, TakesTheEndsOfItsRanges) {
  const test::TemporaryDirectory dir;
  const std::string mesh = voxels_table + fmt::format("mesh = \"{}\"\n", box_file(dir));
  EXPECT_EQ(test::parsed(mesh + "cells = 1\n").model.voxels[0].layers, (CellLayers{{"1"}}));
  EXPECT_EQ(test::parsed(mesh + "cells = 256\n").model.voxels[0].layers.size(), 128u);
  EXPECT_NEAR(test::parsed(mesh + "cells = 2\nheight = 1e6\n").model.voxels[0].size, 1e6, 1e-3);
  EXPECT_NEAR(test::parsed(mesh + "cells = 2\nheight = 1e-6\nup = \"y\"\n").model.voxels[0].size, 1e-6,
              1e-15);
}

TEST(MeshScene, SceneThatIsWrittenNeedsNoFile) {
  const Scene scene = test::parsed(voxels_table + "mesh = \"rabbit\"\ncells = 12\n");
  EXPECT_GT(scene.model.voxels[0].skin.size(), 10'000u);
  const std::string text = to_toml(scene);
  EXPECT_THAT(text, testing::Not(HasSubstr("\nmesh =")));
  test::expect_same_scene(scene, test::parsed(text));
}

TEST(MeshScene, FilesAreRelativeToTheScene) {
  const test::TemporaryDirectory dir;
  box_file(dir);
  dir.write("scene.toml", voxels_table + "mesh = \"box.obj\"\ncells = 4\n");
  const auto scene = load_scene(dir.file("scene.toml"));
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  EXPECT_EQ(scene->model.voxels[0].layers.size(), 2u);
  const std::vector<std::string> finer = {"voxels[0].cells=8"};
  const auto argued = load_scene(dir.file("scene.toml"), finer);
  ASSERT_TRUE(argued.ok()) << argued.error().message();
  EXPECT_EQ(argued->model.voxels[0].layers.size(), 4u);
}

TEST(MeshScene, ArgumentTakesThePlaceOfLayers) {
  const Scene scene = test::parsed(voxels_table + "size = 0.1\nlayers = [[\"111\"]]\n",
                                   {"voxels[0].mesh=rabbit", "voxels[0].cells=10"});
  EXPECT_EQ(scene.model.voxels[0].layers.size(), 10u);
  EXPECT_NEAR(scene.model.voxels[0].size, 0.211, 1e-12);
}

TEST(MeshScene, CellsAreOfTheBodysMaterial) {
  const std::string named =
      "schema = 1\n[material]\nfat = { density = 900.0 }\n[[voxels]]\nmesh = \"rabbit\"\ncells = 10\n";
  const Scene palette = test::parsed(named + "palette = { f = \"fat\" }\n");
  EXPECT_THAT(palette.model.voxels[0].layers[3], Contains(HasSubstr("f")));
  EXPECT_TRUE(build_model(palette.model).ok());
  EXPECT_TRUE(build_model(test::parsed(named + "material = \"fat\"\n").model).ok());
}

TEST(MeshScene, SaysWhatItDid) {
  std::vector<std::string> notes;
  const auto scene =
      parse_scene(voxels_table + "mesh = \"rabbit\"\ncells = 24\n", "s.toml", {}, {.notes = &notes});
  ASSERT_TRUE(scene.ok());
  EXPECT_THAT(notes, Each(StartsWith("rabbit: ")));
  EXPECT_THAT(notes, Contains(HasSubstr("1489 of 14 × 24 × 18 cells")));
}

TEST(MeshScene, ErrorsPointAtTheirPlace) {
  const test::TemporaryDirectory dir;
  dir.write("points.obj", "v 0 0 0\nv 1 0 0\n");
  dir.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
  const std::string points = dir.file("points.obj"), sheet = dir.file("sheet.obj");
  const std::tuple<std::string, std::string, std::string> cases[] = {
      {fmt::format("mesh = \"{}\"\n", points),
       "scene.toml:3:8: ", "points.obj:2: there are 2 vertices and no face"},
      {fmt::format("mesh = \"{}\"\n", sheet), "scene.toml:3:8: ", "fills none of"},
      {"mesh = \"nowhere.obj\"\n", "scene.toml:3:8: ", "Cannot read nowhere.obj"},
      {"mesh = \"rabit\"\n", "scene.toml:3:8: ", "Cannot read rabit"},
      {"mesh = \"rabbit\"\ncells = 999\n", "scene.toml:4:9: ", "allowed: an integer, 1 … 256"},
      {"mesh = \"rabbit\"\nup = \"x\"\n", "scene.toml:4:6: ", "allowed: \"y\" or \"z\""},
      {"mesh = \"rabbit\"\nlayers = [[\"1\"]]\n", "scene.toml:4:1: ", "'layers' follows from the mesh"},
      {"size = 0.1\nmesh = \"rabbit\"\n", "scene.toml:4:1: ", "'size' follows from the mesh"},
      {"cells = 4\n", "scene.toml:3:9: ", "'cells' applies to a mesh"},
      {"skin = \"AAAA\"\n", "scene.toml:3:8: ", "this skin is not one"},
  };
  for (const auto& [keys, place, message] : cases) {
    const std::string said = test::rejection(voxels_table + keys);
    EXPECT_THAT(said, StartsWith(place)) << keys;
    EXPECT_THAT(said, HasSubstr(message)) << keys;
  }
}

TEST(MeshScene, ImportMakesASceneThatLoads) {
  const auto made = import_mesh({.file = "rabbit", .cells = 16, .height = 0.5});
  ASSERT_TRUE(made.ok()) << made.error().message();
  const std::string text = imported_toml(*made, "rabbit");
  EXPECT_THAT(text, StartsWith("# Imported from rabbit.\n# "));
  const Scene scene = test::parsed(text);
  test::expect_same_scene(scene, made->scene);
  const auto model = build_model(scene.model);
  ASSERT_TRUE(model.ok()) << model.error().message();
  double low = 1e9;
  for (const Vec3& x : model->initial_position) low = std::min(low, x.y);
  EXPECT_NEAR(low, 0.25, 0.01) << "half its height above the ground";
  const auto wrong = import_mesh({.file = "rabbit", .cells = 9999});
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().what, HasSubstr("voxels.cells"));
}

TEST(MeshScene, ModelBindsTheSkinToItsParticles) {
  const test::TemporaryDirectory dir;
  const Scene scene = test::parsed(
      voxels_table + fmt::format("mesh = \"{}\"\ncells = 8\nposition = [1.0, 5.0, 2.0]\nrotation = {{ axis = "
                                 "[0, 0, 1], angle = 90.0 }}\n[[cube]]\n",
                                 box_file(dir)));
  const auto model = build_model(scene.model);
  ASSERT_TRUE(model.ok());
  ASSERT_EQ(model->bodies.size(), 2u);
  EXPECT_TRUE(model->bodies[0].skin.empty());
  const BodySkin& skin = model->bodies[1].skin;
  ASSERT_EQ(skin.corners.size(), 8u);
  const State state = initial_state(*model, Precision::double_);
  Vec3 low = {1e9, 1e9, 1e9}, high = -low;
  for (const Vec3& x : skin_positions(skin.binding, skin.corners, state.position)) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], x[axis]);
      high[axis] = std::max(high[axis], x[axis]);
    }
  }
  // On its side: 1 m wide, 2 m high, around its position.
  EXPECT_LT(length(low - Vec3{0.5, 4.0, 1.75}), 1e-9);
  EXPECT_LT(length(high - Vec3{1.5, 6.0, 2.25}), 1e-9);
}

}  // namespace
}  // namespace aspic

#include "scene/materials.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene_checks.h"
#include "scene/scene_support.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Every kind of body that may have a material, all of "fat" but for cells of both.
Scene of_fat() {
  return test::parsed(
      "schema = 1\n[material]\nbone = { density = 1800.0 }\nfat = { density = 900.0, youngs-modulus = 2e4 }\n"
      "[[cube]]\nmaterial = \"fat\"\n[[cube]]\nmaterial = \"bone\"\n[[cloth]]\nmaterial = \"fat\"\n"
      "[[goal-net]]\nmaterial = \"fat\"\n[[voxels]]\nmaterial = \"fat\"\n"
      "[[voxels]]\npalette = { 1 = \"fat\", 2 = \"bone\" }\nlayers = [[\"112\"]]\n");
}

std::vector<std::string> names(const ModelSettings& settings) {
  std::vector<std::string> names;
  for (const MaterialSettings& m : settings.materials) names.push_back(m.name);
  return names;
}

TEST(Materials, BodiesFollowARename) {
  Scene scene = of_fat();
  EXPECT_THAT(users_of_material(scene, "fat"),
              ElementsAre("cube[0]", "voxels[0]", "goal-net[0]", "cloth[0]", "voxels[1]"));
  ASSERT_TRUE(rename_material(scene, 1, "a blubber").ok());
  EXPECT_THAT(names(scene.model), ElementsAre("a blubber", "bone")) << "in the order of names, as before";
  EXPECT_THAT(users_of_material(scene, "fat"), IsEmpty());
  EXPECT_EQ(users_of_material(scene, "a blubber").size(), 5u);
  EXPECT_EQ(scene.model.materials[0].density, 900.0);
  EXPECT_THAT(check_scene(scene), IsEmpty());
}

TEST(Materials, NamesAreUniqueAndNotEmpty) {
  Scene scene = of_fat();
  const Status taken = rename_material(scene, 1, "bone"), none = rename_material(scene, 1, "");
  ASSERT_FALSE(taken.ok());
  EXPECT_THAT(taken.error().message(), HasSubstr("\"bone\""));
  EXPECT_FALSE(none.ok());
  EXPECT_THAT(names(scene.model), ElementsAre("bone", "fat"));
  EXPECT_TRUE(rename_material(scene, 1, "fat").ok()) << "its own";
}

TEST(Materials, ANewOneHasANameOfItsOwn) {
  Scene scene = of_fat();
  EXPECT_EQ(add_material(scene.model, scene.model.materials[0], "material"), "material");
  EXPECT_EQ(add_material(scene.model, {}, "material"), "material-2");
  EXPECT_EQ(add_material(scene.model, {}, "cork"), "cork");
  EXPECT_THAT(names(scene.model), ElementsAre("bone", "cork", "fat", "material", "material-2"));
  EXPECT_EQ(scene.model.materials[3].density, 1800.0);
  scene.model.materials = {{.name = "z"}, {.name = "a"}};
  add_material(scene.model, {}, "m");
  EXPECT_THAT(names(scene.model), ElementsAre("z", "a", "m")) << "an order of a person stays";
}

TEST(Materials, RemovedOnesLeaveTheirNumbers) {
  Scene scene = of_fat();
  const auto refused = remove_material(scene, 1);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message(), HasSubstr("cells '1' of voxels[1] use it"));
  EXPECT_EQ(scene.model.materials.size(), 2u);
  scene.model.voxels[1].layers = {{"222"}};
  const auto removed = remove_material(scene, 1);
  ASSERT_TRUE(removed.ok()) << removed.error().message();
  EXPECT_EQ(
      *removed,
      "cube[0], voxels[0], goal-net[0], cloth[0] keep its density, Young's modulus and damping ratio as "
      "their own.");
  EXPECT_EQ(scene.model.voxels[1].palette, (CellPalette{{"2", "bone"}}));
  for (const MaterialSettings& m : {*scene.model.cubes[0].material, scene.model.voxels[0].material,
                                    *scene.model.goal_nets[0].material, *scene.model.cloths[0].material}) {
    EXPECT_EQ(m.name, "");
    EXPECT_EQ(m.density, 900.0);
    EXPECT_EQ(m.youngs_modulus, 2e4);
  }
  EXPECT_EQ(scene.model.cubes[1].material->name, "bone");
  EXPECT_THAT(check_scene(scene), IsEmpty());
}

TEST(Materials, APaletteBeginsWithTheBodysOwnMaterial) {
  Scene scene = test::parsed("schema = 1\n[[voxels]]\nmaterial = { density = 7.0 }\nlayers = [[\"1a.\"]]\n");
  VoxelsSettings& voxels = scene.model.voxels[0];
  make_palette(scene.model, voxels);
  EXPECT_EQ(voxels.palette, (CellPalette{{"1", "material"}, {"a", "material"}}));
  ASSERT_THAT(names(scene.model), ElementsAre("material"));
  EXPECT_EQ(scene.model.materials[0].density, 7.0);
  EXPECT_EQ(free_cell(voxels), '2');
  EXPECT_TRUE(has_cell(voxels, 'a'));
  EXPECT_FALSE(has_cell(voxels, 'b'));
  EXPECT_THAT(check_scene(scene), IsEmpty());
  make_palette(scene.model, voxels);
  EXPECT_EQ(scene.model.materials.size(), 1u) << "it has one already";
}

}  // namespace
}  // namespace aspic

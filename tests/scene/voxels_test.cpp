// Bodies of cells, files of cells and materials as scenes have them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "aspic/parameters.h"
#include "model/model.h"
#include "scene/scene_support.h"
#include "scene/write.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string materials =
    "schema = 1\n[material]\nmuscle = { density = 1000.0, youngs-modulus = 1e5, damping-ratio = 0.1 }\n"
    "fat = { density = 900.0 }\n";
const std::string worm =
    materials +
    "[[voxels]]\nname = \"worm\"\nsize = 0.01\npalette = { 1 = \"muscle\", 2 = \"fat\" }\n"
    "layers = [[\"11.11\", \"11.11\"], [\"22222\", \"22222\"]]\n";

TEST(VoxelScene, RefusesPinnedCornersWithoutACell) {
  const auto read = [](std::string_view corner) {
    return parse_scene(fmt::format("schema = 1\n[[voxels]]\nsize = 0.1\nlayers = [[\"11\", \"11\"], [\"11\", "
                                   "\".1\"]]\npinned = [\"top\", \"{}\"]\n",
                                   corner),
                       "s.toml");
  };
  EXPECT_TRUE(read("right-top-front").ok());
  const auto refused = read("left-top-front");
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message(),
              StartsWith("s.toml:5:18: 'voxels.pinned' \"left-top-front\" names no particle"));
}

TEST(VoxelScene, ReadsMaterialsByNameAndLayers) {
  const Scene scene = test::parsed(worm);
  ASSERT_EQ(scene.model.materials.size(), 2u);
  // TOML keeps the keys of a table sorted.
  EXPECT_EQ(scene.model.materials[0].name, "fat");
  EXPECT_EQ(scene.model.materials[1].youngs_modulus, 1e5);
  const VoxelsSettings& voxels = scene.model.voxels.at(0);
  EXPECT_EQ(voxels.layers, (CellLayers{{"11.11", "11.11"}, {"22222", "22222"}}));
  EXPECT_EQ(voxels.palette, (CellPalette{{"1", "muscle"}, {"2", "fat"}}));
  const auto model = build_model(scene.model);
  ASSERT_TRUE(model.ok()) << model.error().what;
  EXPECT_EQ(model->bodies.size(), 1u);
  // As a list of tables it is the same.
  const Scene listed = test::parsed(
      "schema = 1\n[[material]]\nname = \"fat\"\ndensity = 900.0\n[[material]]\nname = \"muscle\"\ndensity = "
      "1000.0\n"
      "youngs-modulus = 1e5\ndamping-ratio = 0.1\n" +
      worm.substr(materials.size()));
  test::expect_same_scene(scene, listed);
}

TEST(VoxelScene, WrittenAndReadAgainItIsTheSame) {
  const Scene scene = test::parsed(worm + "[[voxels]]\nmaterial = \"fat\"\nlayers = [[\"1#\"]]\n");
  test::expect_same_scene(scene, test::parsed(to_toml(scene)));
}

TEST(VoxelScene, ArgumentsNameElements) {
  const Scene scene = test::parsed(worm, {"material[fat].density=800", "voxels[worm].pinned=[\"left\"]"});
  EXPECT_EQ(scene.model.materials[0].density, 800.0);
  EXPECT_EQ(scene.model.voxels[0].pinned.names.size(), 1u);
  EXPECT_EQ(std::get<double>(**value_of(scene, "material[fat].density")), 800.0);
  EXPECT_THAT(test::rejection(worm, {"material[fet].density=800"}),
              HasSubstr("the scene has no material of that name; it has fat or muscle; did you mean 'fat'?"));
  EXPECT_THAT(test::rejection(worm + "[[cube]]\n", {"cube[fat].edge-length=1"}),
              HasSubstr("an index is an integer from 0 in brackets"));
}

TEST(VoxelScene, ArgumentsAddElements) {
  const Scene scene = test::parsed(
      worm, {"material[+]={ name = \"bone\", youngs-modulus = 1e6 }",
             "voxels[+]={ name = \"limb\", material = \"bone\", layers = [[\"11\"]], position = [9, 9, 9] }",
             "voxels[limb].size=0.25", "cube[+].edge-length=3", "cube[0].position=[20, 0, 0]"});
  ASSERT_EQ(scene.model.voxels.size(), 2u);
  EXPECT_EQ(scene.model.voxels[1].material.name, "bone");
  EXPECT_EQ(scene.model.voxels[1].size, 0.25);
  ASSERT_EQ(scene.model.cubes.size(), 1u);
  EXPECT_EQ(scene.model.cubes[0].edge_length, 3.0);
  const auto further = with_overrides(scene, std::vector<std::string>{"voxels[+]={ name = \"worm\" }"});
  ASSERT_FALSE(further.ok());
  EXPECT_THAT(further.error().what, StartsWith("voxels[+]={ name = \"worm\" }: "));
  EXPECT_THAT(further.error().what, HasSubstr("\"worm\" is taken"));
  EXPECT_THAT(test::rejection(worm, {"cub[+]={}"}), HasSubstr("did you mean 'cube'?"));
  EXPECT_THAT(test::rejection(worm, {"cube[+]=3"}), HasSubstr("give { key = value }"));
  EXPECT_THAT(test::rejection(worm, {"cube[+]={ edge-length = -1 }"}), HasSubstr("out of range"));
  EXPECT_THAT(test::rejection(worm, {"simulation[+]={}"}), HasSubstr("takes no index"));
}

TEST(VoxelScene, ErrorsPointAtTheirPlaceAndSayTheWayOut) {
  const auto body = [](const std::string& keys) { return materials + "[[voxels]]\n" + keys; };
  const std::tuple<std::string, std::string, std::string> cases[] = {
      {body("layers = [[\"11\"], [\"11\", \"1.\"]]\n"),
       "scene.toml:6:19: ", "layer 1 has 2 rows and layer 0 has 1"},
      {body("layers = [[\"1.1\"]]\n"), "scene.toml:6:10: ", "write pieces = \"largest\""},
      {body("layers = [[\"...\"]]\n"), "scene.toml:6:10: ", "the body is empty"},
      {body("palette = { 1 = \"mussle\" }\n"),
       "scene.toml:6:11: ", "it has fat, muscle; did you mean 'muscle'?"},
      {body("palette = { 1 = \"fat\" }\nlayers = [[\"12\"]]\n"),
       "scene.toml:7:11: ", "a cell '2', which 'palette'"},
      {body("material = \"wood\"\n"), "scene.toml:6:12: ", "\"wood\", which the scene does not have"},
      {body("file = \"missing.npy\"\n"), "scene.toml:6:8: ", "missing.npy"},
      {body("file = \"missing.npy\"\nlayers = [[\"1\"]]\n"),
       "scene.toml:6:8: ", "either 'layers' or a 'file'"},
      {"schema = 1\n[[cube]]\nmaterial = \"wood\"\n",
       "scene.toml:3:12: ", "add a [[material]] with name = \"wood\""},
      {materials + "[[cube]]\nmaterial = \"fat\"\nparticle-mass = 1.0\n",
       "scene.toml:6:1: ", "a cube has either 'material' or the masses"},
      {materials + "[[cloth]]\nmaterial = \"fat\"\nparticle-mass = 1.0\n",
       "scene.toml:6:1: ", "a cloth has either 'material' or the masses"},
      {materials + "[[cube]]\nmaterial = { name = \"fat\", density = 3.0 }\n",
       "scene.toml:6:28: ", "set 'material[fat].density'"},
      {materials + "[[cloth]]\nmaterial = \"fat\"\nsize = [9.0, 1.0]\n",
       "scene.toml:6:12: ", "too long one way"},
      {worm + "[[voxels]]\nname = \"worm\"\n", "scene.toml:11:8: ", "'voxels.name' \"worm\" is taken"},
      {"schema = 1\n[[cloth]]\nthickness = 0.1\n",
       "scene.toml:3:1: ", "'cloth.thickness' applies to a cloth with a"},
      {worm + "material = \"fat\"\n",
       "scene.toml:10:1: ", "either 'material', for all cells, or a 'palette'"},
      {"schema = 1\n[material]\nfat = 3\n[[cube]]\n", "scene.toml:3:7: ", "'material.fat' must be a table"}};
  for (const auto& [text, place, message] : cases) {
    const std::string refusal = test::rejection(text);
    EXPECT_THAT(refusal, StartsWith(place)) << text;
    EXPECT_THAT(refusal, HasSubstr(message)) << text;
  }
}

/// np.save() of an array of uint8.
void write_npy(const std::filesystem::path& path, const std::string& shape, const std::string& data) {
  std::string header = fmt::format("{{'descr': '|u1', 'fortran_order': False, 'shape': {}, }}", shape);
  header += std::string(117 - header.size(), ' ') + '\n';
  std::ofstream(path, std::ios::binary)
      << std::string("\x93NUMPY\x01\x00", 8) << static_cast<char>(header.size()) << '\0' << header << data;
}

TEST(VoxelScene, TakesCellsOfAFileNextToIt) {
  const test::TemporaryDirectory folder;
  // By x, y and z: x runs slowest. 12 is a material with a letter of its own.
  write_npy(folder.path() / "body.npy", "(3, 2, 1)", std::string("\1\14\1\0\14\14", 6));
  const auto scene_with = [&](const std::string& keys) { return materials + "[[voxels]]\n" + keys; };
  const std::string text = scene_with("palette = { 1 = \"muscle\", 12 = \"fat\" }\nfile = \"body.npy\"\n");
  const std::string file = (folder.path() / "scene.toml").string();
  std::ofstream(file) << text;
  const auto scene = load_scene(file);
  ASSERT_TRUE(scene.ok()) << scene.error().what;
  const VoxelsSettings& voxels = scene->model.voxels.at(0);
  ASSERT_EQ(voxels.palette.size(), 2u);
  EXPECT_EQ(voxels.palette.at("1"), "muscle");
  const std::string letter = voxels.palette.rbegin()->first;
  EXPECT_EQ(voxels.palette.at(letter), "fat");
  EXPECT_EQ(voxels.layers, (CellLayers{{"11" + letter}, {letter + "." + letter}}));
  // The scene holds its cells: it needs the file no more.
  std::filesystem::remove(folder.path() / "body.npy");
  test::expect_same_scene(test::parsed(to_toml(*scene)), *scene);

  write_npy(folder.path() / "body.npy", "(1, 1, 2)", std::string("\1\7", 2));
  const auto unknown = load_scene(file);
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(unknown.error().what,
              HasSubstr("scene.toml:7:8: 'voxels.file' \"body.npy\": it has the number 7 at "
                        "[0, 0, 1], which 'palette' does not name; add 7 = \"…\" to 'palette'"));
  write_npy(folder.path() / "body.npy", "(2,)", "\1\1");
  const auto flat = load_scene(file);
  ASSERT_FALSE(flat.ok());
  EXPECT_THAT(flat.error().what, HasSubstr("three axes"));
  // Of an argument, relative to the working directory; without a palette every number is full.
  write_npy(folder.path() / "other.npy", "(2, 1, 1)", "\3\5");
  const Scene set = test::parsed(
      scene_with(""), {fmt::format("voxels[0].file=\"{}\"", (folder.path() / "other.npy").string())});
  EXPECT_EQ(set.model.voxels[0].layers, (CellLayers{{"11"}}));
}

}  // namespace
}  // namespace aspic

// Checks of scenes that were never text.
#include "scene/scene_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "aspic/run.h"
#include "model/bodies.h"
#include "model/integrator.h"
#include "scene/reader.h"
#include "scene/scene_support.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// One element in every list, all of them legal.
Scene full_scene() {
  Scene scene;
  for (const SettingsList& list : settings_lists()) list.append(scene.model);
  return scene;
}

std::vector<std::string> paths_of(const std::vector<SceneComplaint>& complaints) {
  std::vector<std::string> paths;
  for (const SceneComplaint& complaint : complaints) paths.push_back(complaint.path);
  return paths;
}

TEST(CheckScene, FindsNothingWrongWithDefaultsAndBuiltins) {
  EXPECT_TRUE(check_scene(full_scene()).empty());
  for (const BuiltinScene& builtin : list_builtin_scenes())
    EXPECT_TRUE(check_scene(*load_scene(std::string(builtin.name))).empty()) << builtin.name;
}

/// Values that every key of the type refuses.
std::vector<Value> wrong_values(const Parameter& p) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), huge = 1e300;
  switch (p.type) {
    case ParameterType::integer:
      return {Value(static_cast<std::int64_t>(p.range.min) - 1)};
    case ParameterType::number:
      return {Value(nan), Value(huge), Value(-huge)};
    case ParameterType::vector:
      return {Value(Vec3{1.0, nan, 1.0}), Value(Vec3{1.0, -huge, 1.0})};
    case ParameterType::counts:
      return {p.components == 2 ? Value(std::vector<int>{2, 1}) : Value(std::vector<int>{2, 1, 2})};
    case ParameterType::numbers: {
      std::vector<double> not_a_number(p.components, 1.0), too_small = not_a_number;
      not_a_number[1] = nan;
      too_small[1] = -huge;
      return {Value(not_a_number), Value(too_small)};
    }
    case ParameterType::pinned:
      return {Value(PinnedSettings{{"top", "lid"}, {}}), Value(PinnedSettings{{"top"}, {1000}}),
              Value(PinnedSettings{{"top"}, {-1}})};
    default:
      return {};  // a field of these types cannot hold a wrong value
  }
}

/// A scene in which a key has a value, and the index it has it at.
std::pair<Scene, std::size_t> scene_with(const Parameter& p, const Value& value) {
  Scene scene = full_scene();
  const std::size_t last = index_count(p, scene);
  if (p.path.find("[]") != std::string_view::npos) {
    for (const SettingsList& list : settings_lists()) list.append(scene.model);
  }
  const std::size_t index = index_count(p, scene) == last ? 0 : last;
  if (p.belonging == Belonging::geometry) {
    for (const TerrainShapeRow& row : terrain_shapes) {
      if (belongs_to_shape(p, row.value)) scene.model.terrain[index].shape = row.value;
    }
  }
  if (p.belonging == Belonging::wave) scene.model.actuators[index].phase.along = BodyAxis::x;
  if (p.belonging == Belonging::material) material_place(scene.model, p.section(), index)->emplace();
  p.set(scene, index, value);
  return {std::move(scene), index};
}

TEST(CheckScene, NamesThePathOfEveryWrongValue) {
  for (const Parameter& p : parameters()) {
    if (p.path == "schema" || reader::is_cell_source(p.path) || reader::is_actuator_source(p.path))
      continue;  // no field of a scene
    for (const Value& wrong : wrong_values(p)) {
      const auto [scene, index] = scene_with(p, wrong);
      const auto complaints = check_scene(scene);
      ASSERT_EQ(complaints.size(), 1u) << p.path;
      EXPECT_EQ(complaints[0].path, path_text(p.path, index));
      EXPECT_THAT(complaints[0].message, HasSubstr(fmt::format("'{}'", key_text(p))));
      const bool one_of_many = p.type != ParameterType::integer && p.type != ParameterType::number;
      EXPECT_EQ(complaints[0].element, one_of_many ? std::optional<std::size_t>(1) : std::nullopt) << p.path;
    }
  }
}

// Scenes that code makes are not checked key by key: what reaches a solver is. What is taken has no part in
// it: a material that nothing is made of, the axis of no rotation.
TEST(MakeModel, RefusesNumbersOfEveryKeyThatASolverWouldGetNotFinite) {
  std::size_t refused = 0, taken = 0;
  for (const Parameter& p : parameters()) {
    if (p.only_shown() || reader::is_cell_source(p.path) || reader::is_actuator_source(p.path)) continue;
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, 1e300}) {
      std::optional<Value> value;
      if (p.type == ParameterType::number) value = bad;
      if (p.type == ParameterType::vector) value = Vec3{1.0, bad, 1.0};
      if (p.type == ParameterType::numbers) value = std::vector<double>(p.components, bad);
      if (!value) continue;
      const auto model = make_model(scene_with(p, *value).first.model);
      ++(model.ok() ? taken : refused);
      if (!model) continue;
      const auto backend = make_backend(*parse_backend("reference"), *model);
      ASSERT_TRUE(backend.ok());
      const auto made = backend->solver->advance(2);
      ASSERT_TRUE(made.ok());
      EXPECT_TRUE(!made->divergence || made->divergence->finite) << p.path << " = " << bad;
    }
  }
  EXPECT_GT(refused, 3 * taken);
}

TEST(CheckScene, FindsWhatOnlyTheWholeShows) {
  Scene scene = full_scene();
  scene.model.terrain[0].shape = TerrainShape::bowl;
  scene.model.terrain[0].geometry["normal"] = Vec3{0.0, 1.0, 0.0};
  scene.model.launchers[0].towards.min.y = 7.0;
  scene.view.camera.position = scene.view.camera.target;
  const auto complaints = check_scene(scene);
  EXPECT_THAT(paths_of(complaints),
              ElementsAre("terrain[0].normal", "launcher[0].towards", "view.camera.target"));
  EXPECT_EQ(complaints[0].message, "a bowl has no 'normal'; its geometry is center or radius");
}

TEST(CheckScene, FindsASceneInWhichNothingMoves) {
  Scene scene;
  scene.model.terrain.emplace_back();
  const auto complaints = check_scene(scene);
  ASSERT_THAT(paths_of(complaints), ElementsAre(""));
  EXPECT_THAT(complaints[0].message,
              HasSubstr("add a [[cube]], [[voxels]], [[goal-net]], [[cloth]], [[ball]] or [[launcher]]"));
}

TEST(CheckScene, BlamesTheLargestBodyForTheMemory) {
  Scene scene = full_scene();
  scene.model.cubes.emplace_back().particles_per_edge = 40;
  const std::uint64_t needed = run_bytes(predict_counts(scene.model));
  EXPECT_TRUE(check_scene(scene, needed).empty());
  EXPECT_THAT(paths_of(check_scene(scene, needed - 1)), ElementsAre("cube[1].particles-per-edge"));
  scene.model.launchers[0].count = 1000000;
  EXPECT_THAT(paths_of(check_scene(scene, needed)), ElementsAre("launcher[0].count"));
}

TEST(WithOverrides, ChangesASceneWithoutText) {
  const auto scene = with_overrides(
      full_scene(), std::vector<std::string>{"cube[0].material.density=20", "terrain[0].shape=bowl",
                                             "view.camera={ fov = 30.0 }"});
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  EXPECT_EQ(scene->model.cubes[0].material->density, 20.0);
  EXPECT_EQ(scene->model.terrain[0].shape, TerrainShape::bowl);
  EXPECT_EQ(scene->view.camera.fov, 30.0);
  EXPECT_EQ(scene->view.camera.target, CameraSettings().target);
}

TEST(WithOverrides, TreatsTheScenesValuesAsTheFiles) {
  Scene scene = full_scene();
  scene.name = "made";
  scene.model.terrain[0].geometry["point"] = Vec3{0.0, 5.0, 0.0};
  scene.model.cubes[0].material.emplace();
  const auto round = with_overrides(scene, std::vector<std::string>{"terrain[0].shape=sphere"});
  ASSERT_TRUE(round.ok()) << round.error().message();
  EXPECT_TRUE(round->model.terrain[0].geometry.empty());
  const auto springs = with_overrides(scene, std::vector<std::string>{"cube[0].shear.stiffness=1"});
  ASSERT_FALSE(springs.ok());
  EXPECT_THAT(springs.error().message(), StartsWith("cube[0].shear.stiffness=1: this cube has a "));
}

TEST(WithOverrides, NamesAKeyThatNoArgumentWrote) {
  Scene scene = full_scene();
  scene.name = "made";
  scene.model.cubes[0].pinned.indices = {999};
  const auto smaller = with_overrides(scene, std::vector<std::string>{"cube[0].particles-per-edge=3"});
  ASSERT_FALSE(smaller.ok());
  EXPECT_EQ(smaller.error().message(),
            "cube[0].particles-per-edge=3: 'cube.pinned' index 999 is not in the cube; allowed: 0 … 26\n"
            "  cube[0].particles-per-edge=3\n"
            "                             ^");
  scene.model.cubes[0].pinned.indices = {1000};
  const auto wrong = with_overrides(scene, {});
  ASSERT_FALSE(wrong.ok());
  EXPECT_EQ(wrong.error().message(),
            "made: cube[0].pinned: 'cube.pinned' index 1000 is not in the cube; allowed: 0 … 999");
}

TEST(CheckScene, NamesWhatCanBeFollowed) {
  Scene scene = full_scene();
  scene.view.follow = "cube[7]";
  const auto complaints = check_scene(scene);
  ASSERT_THAT(paths_of(complaints), ElementsAre("view.follow"));
  EXPECT_THAT(complaints[0].message, HasSubstr("cube[7]"));
  EXPECT_THAT(complaints[0].message,
              HasSubstr("cube[0], voxels[0], goal-net[0], cloth[0], ball[0] … ball[10]"));
  scene.view.follow = "ball[10]";
  EXPECT_TRUE(check_scene(scene).empty());
}

}  // namespace
}  // namespace aspic

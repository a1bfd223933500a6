// The default view of every built-in scene at a stated step, 640 × 360, on Mesa's software rasterizers. To
// take new images as golden: ASPIC_UPDATE_GOLDEN=1 build/release/tests/render/render_tests
// --gtest_filter='*Golden*', then look at tests/golden/*.png before committing them.
#include <gtest/gtest.h>

#include "aspic/scene.h"
#include "render/overlay_text.h"
#include "render/studio.h"
#include "scene/follow.h"

namespace aspic {
namespace {

struct Shot {
  std::string scene;
  std::uint64_t step;
  std::vector<std::string> overrides = {};
  std::string name = {};
};

void PrintTo(const Shot& shot, std::ostream* out) {
  *out << shot.scene << " at step " << shot.step;
}

class Golden : public test::Studio, public ::testing::WithParamInterface<Shot> {};

TEST_P(Golden, Image) {
  const Shot& shot = GetParam();
  const auto scene = load_scene(shot.scene, shot.overrides);
  ASSERT_TRUE(scene.ok()) << scene.error().message();
  const Model model = test::build(scene->model);
  const State state = shot.step > 0 ? test::after(model, shot.step) : initial_state(model, Precision::single);
  ImageOptions options;
  options.view = scene->view;
  options.view.camera =
      moved(scene->view.camera, Following(*scene, model, Precision::single).offset(model, state));
  options.text = overlay_lines(*scene, static_cast<double>(state.step) * model.simulation.timestep);
  test::expect_golden(draw(model, state, options), shot.name.empty() ? shot.scene : shot.name);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Golden,
    ::testing::Values(
        Shot{"cube-plane", 1500}, Shot{"cube-tilted-plane", 1300}, Shot{"cube-sphere", 1000},
        Shot{"cube-bowl", 1300}, Shot{"cube-torus", 1200}, Shot{"cube-hole", 1500}, Shot{"elevator", 2600},
        Shot{"cubes-stack", 1000}, Shot{"cubes-tower", 150}, Shot{"heap", 1300}, Shot{"squeeze", 1900},
        Shot{"jelly-in-net", 1000}, Shot{"knot", 6250}, Shot{"large-cube", 0}, Shot{"goal-net", 300},
        Shot{"penalty", 1080}, Shot{"cube-and-balls", 700}, Shot{"ball-pit", 4000}, Shot{"flag", 2400},
        Shot{"curtain", 1000}, Shot{"bridge", 700}, Shot{"swing", 900}, Shot{"jelly-figure", 1500},
        Shot{"worm", 1100}, Shot{"walker", 2100}, Shot{"worm", 1100, {"view.color=actuation"}, "actuation"},
        Shot{"bridge",
             700,
             {"view.color=strain", "view.cut.inside=section", "view.cut.normal=[0.0, 0.0, 1.0]"},
             "section-voxels"},
        Shot{"course-2021-plane", 1250}, Shot{"course-2021-tilted-plane", 1050},
        Shot{"course-2021-sphere", 900}, Shot{"course-2021-bowl", 1200}, Shot{"course-2018", 1080},
        Shot{"flag",
             2400,
             {"view.color=strain", "view.draw=[\"solid\", \"structural\", \"shear\"]"},
             "flag-strain"},
        Shot{"cube-plane", 1500, {"view.color=strain"}, "strain"},
        Shot{"cube-sphere",
             1050,
             {"view.color=strain", "view.cut.inside=section", "view.cut.normal=[0.2, 0.0, 1.0]",
              "view.camera={position=[5.0, 5.0, 9.0], target=[0.2, 2.4, 0.0], fov=45.0}", "view.follow=none"},
             "section"},
        Shot{"cube-sphere",
             1050,
             {"view.color=strain", "view.cut.inside=springs",
              "view.camera={position=[5.0, 5.0, 9.0], target=[0.2, 2.4, 0.0], fov=45.0}", "view.follow=none"},
             "section-springs"},
        Shot{"penalty", 1080, {"view.camera.projection=orthographic", "view.axes=true"}, "orthographic"},
        Shot{"flag", 2250, {"view.color=signed-strain", "view.scale.range=symmetric"}, "signed-strain"},
        // Without structural springs, on which bending springs lie: rounding decides which are in front. Few
        // particles, seen from where none covers another: what shows through a disc's rim is by rounding too.
        Shot{"cube-plane",
             1500,
             {"view.draw=[\"solid\", \"particles\", \"shear\", \"bending\"]", "cube[0].pinned=[\"top\"]",
              "cube[0].particles-per-edge=5", "cube[0].position=[0.0, 2.0, 0.0]",
              "view.camera={position=[5.6, 9.6, 8.0], target=[-0.7, 2.0, 0.5], fov=45.0}"},
             "springs"}),
    [](const ::testing::TestParamInfo<Shot>& shot) {
      std::string name = shot.param.name.empty() ? shot.param.scene : shot.param.name;
      std::erase(name, '-');
      return name;
    });

}  // namespace
}  // namespace aspic

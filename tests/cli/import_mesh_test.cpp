// aspic scene import of a mesh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/process.h"

namespace aspic {
namespace {

using test::aspic;
using testing::HasSubstr;

TEST(ImportMesh, ASceneThatRunsAsItIs) {
  const test::TemporaryDirectory dir;
  const auto imported = aspic({"scene", "import", "rabbit", "--cells", "12", "--height", "0.2"});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_THAT(imported.err, HasSubstr("aspic: rabbit: "));
  EXPECT_THAT(imported.err, HasSubstr("cells of 0.0167 m are full"));
  dir.write("rabbit.toml", imported.out);
  const std::string scene = dir.file("rabbit.toml");
  const auto check = aspic({"scene", "check", scene});
  EXPECT_EQ(check.exit_code, 0);
  EXPECT_EQ(check.err, "") << "the time step is stable, and there is nothing left to repair";
  const auto run =
      aspic({"run", scene, "--steps", "200", "--backend", "cpu", "--checkpoint", dir.file("half.aspic")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto resumed =
      aspic({"run", "--resume", dir.file("half.aspic"), "--steps", "300", "--backend", "cpu"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
}

TEST(ImportMesh, SaysWhatIsWrong) {
  const test::TemporaryDirectory dir;
  dir.write("bad.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n");
  dir.write("Configuration.txt", "*DeltaT\n0.005\n");
  const auto bad = aspic({"scene", "import", dir.file("bad.stl")});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_THAT(bad.err, HasSubstr("bad.stl:6: this facet has 2 corners"));
  EXPECT_EQ(aspic({"scene", "import", dir.file("none.obj")}).exit_code, 6);
  const auto other = aspic({"scene", "import", "body.GLB"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, HasSubstr("supported: .obj, .stl and .ply"));
  const auto cells = aspic({"scene", "import", dir.file("Configuration.txt"), "--cells", "3"});
  EXPECT_EQ(cells.exit_code, 2);
  EXPECT_THAT(cells.err, HasSubstr("apply to mesh files only"));
  EXPECT_EQ(aspic({"scene", "import", "rabbit", "--cells", "0"}).exit_code, 2);
  const auto up = aspic({"scene", "import", "rabbit", "--up", "x"});
  EXPECT_EQ(up.exit_code, 2);
  EXPECT_EQ(up.err, "aspic: --up has the unknown value \"x\"; allowed: \"y\" or \"z\"; did you mean 'y'?.\n");
  const auto pieces = aspic({"scene", "import", "rabbit", "--pieces", "some"});
  EXPECT_EQ(pieces.exit_code, 2);
  EXPECT_THAT(pieces.err, HasSubstr("--pieces has the unknown value \"some\""));
  const auto height = aspic({"scene", "import", "rabbit", "--height", "-1"});
  EXPECT_EQ(height.exit_code, 2);
  EXPECT_THAT(height.err, HasSubstr("--height is out of range: -1"));
}

TEST(ImportMesh, PrintsSceneWithinRangesOrRefusesItsHeight) {
  const test::TemporaryDirectory dir;
  for (const char* height : {"1e-6", "3e5", "1e6"}) {
    const auto imported = aspic({"scene", "import", "rabbit", "--cells", "4", "--height", height});
    if (imported.exit_code != 0) {
      EXPECT_EQ(imported.exit_code, 3);
      EXPECT_THAT(imported.err, HasSubstr("Give another --height."));
      continue;
    }
    dir.write("rabbit.toml", imported.out);
    const auto check = aspic({"scene", "check", dir.file("rabbit.toml")});
    EXPECT_EQ(check.exit_code, 0) << height << ": " << check.err;
  }
}

}  // namespace
}  // namespace aspic

#include "app/palette.h"

#include <gtest/gtest.h>

#include <optional>

namespace aspic::app {
namespace {

TEST(PaletteFit, NamesComeBeforeWhatIsSaidOfThem) {
  EXPECT_EQ(fit_of("simulation.gravity", "Gravity", "grav"), 0);
  EXPECT_EQ(fit_of("cube[0].structural.stiffness", "", "Structural stiff"), 1);
  EXPECT_EQ(fit_of("cube[0].particles-per-edge", "", "particles edge"), 0);
  EXPECT_EQ(fit_of("open cube-plane", "", "lane"), 2);
  EXPECT_EQ(fit_of("section Springs", "Stiffness and damping", "damping"), 3);
  EXPECT_EQ(fit_of("open flag", "", "gravity"), std::nullopt);
}

}  // namespace
}  // namespace aspic::app

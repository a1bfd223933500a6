#include "scene/diagnostics.h"

#include <gtest/gtest.h>

namespace aspic::diagnostics {
namespace {

TEST(EditDistance, CountsTheFourEdits) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("stifness", "stiffness"), 1u);    // insertion
  EXPECT_EQ(edit_distance("stiffnesss", "stiffness"), 1u);  // deletion
  EXPECT_EQ(edit_distance("stiffmess", "stiffness"), 1u);   // substitution
  EXPECT_EQ(edit_distance("cetner", "center"), 1u);         // swap of neighbors
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);        // Levenshtein's classical pair
  EXPECT_EQ(edit_distance("ca", "abc"), 3u);                // the restricted form edits no part twice
}

TEST(Nearest, IsSilentWhenNothingIsNear) {
  const std::string_view words[] = {"timestep", "fov", "duration"};
  EXPECT_EQ(nearest("timstep", words), "timestep");
  EXPECT_EQ(nearest("fv", words), "fov");
  EXPECT_EQ(nearest("gravity", words), "");
  EXPECT_EQ(nearest("", words), "");
  EXPECT_EQ(nearest(std::string(100000, 'x'), words), "");
}

// A word that is cut short is not mistyped: of its letters all are right.
TEST(Nearest, PrefersWhatTheWordShortens) {
  const std::string_view keys[] = {"particle-mass", "particles-per-edge", "position"};
  EXPECT_EQ(nearest("particles", keys), "particles-per-edge");
  EXPECT_EQ(nearest("particle-mas", keys), "particle-mass");
  const std::string_view methods[] = {"explicit-euler", "midpoint", "velocity-verlet", "runge-kutta-4",
                                      "implicit-euler"};
  EXPECT_EQ(nearest("rk4", methods), "runge-kutta-4");
  EXPECT_EQ(nearest("verlet", methods), "velocity-verlet");
  EXPECT_EQ(nearest("implicit", methods), "implicit-euler");
  EXPECT_EQ(nearest("euler", methods), "");  // of two
  EXPECT_EQ(nearest("mid", methods), "midpoint");
  EXPECT_EQ(nearest("mi", methods), "");
}

}  // namespace
}  // namespace aspic::diagnostics

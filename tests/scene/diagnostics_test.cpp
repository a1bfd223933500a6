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
  EXPECT_EQ(edit_distance("center", "centre"), 1u);         // swap of neighbours
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

}  // namespace
}  // namespace aspic::diagnostics

#include "app/resolution.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace aspic::test {
namespace {

using app::Resolution;

/// A rasteriser that takes so long for a picture: a fixed part, and one by pixels [s].
struct Machine {
  double fixed, full;
  double time(double share) const { return fixed + full * share * share; }
};

/// Draws pictures until the choice settles; returns the longest one.
double draw(Resolution& r, const Machine& machine, bool still, int pictures = 40) {
  double longest = 0.0;
  for (int i = 0; i < pictures; ++i) {
    const double share = r.share(still), t = machine.time(share);
    longest = std::max(longest, t);
    r.took(share, t);
  }
  return longest;
}

TEST(Resolution, AQuickMachineDrawsInFull) {
  Resolution r;
  r.reset(false);
  draw(r, {0.004, 0.02}, false);
  EXPECT_EQ(r.share(false), 1.0);
  EXPECT_EQ(r.share(true), 1.0);
}

TEST(Resolution, ALargeSceneBeginsCoarselyAndNoPictureTakesTooLong) {
  for (const double fixed : {0.0, 0.01, 0.03}) {
    for (const double full : {0.02, 0.1, 0.3, 0.5}) {
      Resolution r;
      r.reset(true);
      EXPECT_EQ(r.share(false), Resolution::coarsest);
      const Machine machine = {fixed, full};
      const double least = machine.time(Resolution::coarsest);
      EXPECT_LE(draw(r, machine, false), std::max(Resolution::in_motion, least)) << fixed << " " << full;
      EXPECT_LE(draw(r, machine, true), std::max(Resolution::at_rest, least)) << fixed << " " << full;
      EXPECT_GE(r.share(true), r.share(false));
    }
  }
}

TEST(Resolution, AtRestItComesCloserToFullPictureByPicture) {
  Resolution r;
  r.reset(true);
  const Machine machine = {0.02, 0.05};
  draw(r, machine, false, 3);
  draw(r, machine, true, 10);
  EXPECT_EQ(r.share(true), 1.0) << "0.07 s is time enough at rest";
  EXPECT_LT(r.share(false), 1.0);
}

TEST(Resolution, DoesNotSwing) {
  Resolution r;
  r.reset(true);
  const Machine machine = {0.01, 0.14};
  draw(r, machine, false);
  const double settled = r.share(false);
  for (int i = 0; i < 50; ++i) {
    // A tenth more or less is noise.
    r.took(r.share(false), machine.time(r.share(false)) * (i % 2 == 0 ? 0.9 : 1.1));
    EXPECT_EQ(r.share(false), settled);
  }
}

TEST(Resolution, ABusyMomentIsForgotten) {
  Resolution r;
  r.reset(false);
  const Machine quick = {0.004, 0.03};
  for (int i = 0; i < 12; ++i) r.took(r.share(false), 10.0 * quick.time(r.share(false)));
  EXPECT_LT(r.share(false), 0.5);
  const double longest = draw(r, quick, false, 400);
  EXPECT_EQ(r.share(false), 1.0);
  EXPECT_LE(longest, Resolution::in_motion);
}

TEST(Resolution, BecomesCoarserWhenTheMachineGetsBusy) {
  Resolution r;
  r.reset(false);
  draw(r, {0.005, 0.03}, false);
  EXPECT_EQ(r.share(false), 1.0);
  draw(r, {0.02, 0.12}, false);
  EXPECT_LT(r.share(false), 0.6);
}

}  // namespace
}  // namespace aspic::test

#include "render/resolution.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace aspic::test {
namespace {

/// A rasterizer that takes so long for an image: a fixed part, and one by pixels [s].
struct Machine {
  double fixed, full;
  double time(double share) const { return fixed + full * share * share; }
};

/// Draws images until the choice settles; returns the longest one.
double draw(Resolution& r, const Machine& machine, int images = 40) {
  double longest = 0.0;
  for (int i = 0; i < images; ++i) {
    const double share = r.share(), t = machine.time(share);
    longest = std::max(longest, t);
    r.took(share, t);
  }
  return longest;
}

TEST(Resolution, AQuickMachineDrawsInFull) {
  Resolution r;
  r.reset(false);
  draw(r, {0.004, 0.02});
  EXPECT_EQ(r.share(), 1.0);
}

TEST(Resolution, ALargeSceneBeginsCoarselyAndNoImageTakesTooLong) {
  for (const double fixed : {0.0, 0.01, 0.03}) {
    for (const double full : {0.02, 0.1, 0.3, 0.5}) {
      Resolution r;
      r.reset(true);
      EXPECT_EQ(r.share(), Resolution::coarsest);
      const Machine machine = {fixed, full};
      const double least = machine.time(Resolution::coarsest);
      EXPECT_LE(draw(r, machine), std::max(Resolution::in_motion, least)) << fixed << " " << full;
    }
  }
}

TEST(Resolution, DoesNotSwing) {
  Resolution r;
  r.reset(true);
  const Machine machine = {0.01, 0.14};
  draw(r, machine);
  const double settled = r.share();
  for (int i = 0; i < 50; ++i) {
    // A tenth more or less is noise.
    r.took(r.share(), machine.time(r.share()) * (i % 2 == 0 ? 0.9 : 1.1));
    EXPECT_EQ(r.share(), settled);
  }
}

TEST(Resolution, OneSlowImageIsNoReason) {
  Resolution r;
  r.reset(false);
  const Machine quick = {0.004, 0.03};
  draw(r, quick);
  r.took(r.share(), 0.4);
  EXPECT_EQ(r.share(), 1.0);
  draw(r, quick);
  EXPECT_EQ(r.share(), 1.0);
}

TEST(Resolution, DoesNotPumpWhereLoadComesAndGoes) {
  Resolution r;
  r.reset(false);
  int changes = 0;
  for (int i = 0; i < 300; ++i) {
    const double before = r.share(), slow = i / 10 % 2 == 0 ? 3.0 : 1.0;
    r.took(before, slow * Machine{0.004, 0.03}.time(before));
    changes += r.share() != before ? 1 : 0;
  }
  EXPECT_LE(changes, 6) << "in some ten seconds of load every second";
}

TEST(Resolution, ABusyMomentIsForgotten) {
  Resolution r;
  r.reset(false);
  const Machine quick = {0.004, 0.03};
  for (int i = 0; i < 12; ++i) r.took(r.share(), 10.0 * quick.time(r.share()));
  EXPECT_LT(r.share(), 0.5);
  const double longest = draw(r, quick, 400);
  EXPECT_EQ(r.share(), 1.0);
  EXPECT_LE(longest, Resolution::in_motion);
}

TEST(Resolution, BecomesCoarserWhenTheMachineGetsBusy) {
  Resolution r;
  r.reset(false);
  draw(r, {0.005, 0.03});
  EXPECT_EQ(r.share(), 1.0);
  draw(r, {0.02, 0.12});
  EXPECT_LT(r.share(), 0.6);
}

}  // namespace
}  // namespace aspic::test

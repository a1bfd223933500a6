#include "io/state_csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "support/random_state.h"
#include "support/state_csv_reader.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using testing::HasSubstr;

class StateCsv : public testing::TestWithParam<Precision> {};

TEST_P(StateCsv, ReadsBackToTheSameBits) {
  const test::TemporaryDirectory dir;
  const State state = test::random_bits_state(2000, GetParam());
  auto file = AtomicFile::create(dir.file("s.csv"), Overwrite::refuse);
  ASSERT_TRUE(file.ok());
  ASSERT_TRUE(write_state_csv(*file, state).ok());
  ASSERT_TRUE(file->commit().ok());
  const auto back = test::read_state_csv(dir.file("s.csv"), GetParam());
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(state_hash(*back), state_hash(state));
}

INSTANTIATE_TEST_SUITE_P(Precisions, StateCsv, testing::Values(Precision::single, Precision::double_));

TEST(StateCsvFormat, IsTheSpecifiedTable) {
  const test::TemporaryDirectory dir;
  State state;
  state.position = {{0.1f, -2.0, 3.5}};
  state.velocity = {{0.0, 1e-10f, 4.0}};
  auto file = AtomicFile::create(dir.file("s.csv"), Overwrite::refuse);
  ASSERT_TRUE(file.ok() && write_state_csv(*file, state).ok() && file->commit().ok());
  EXPECT_EQ(dir.read("s.csv"), "kind,index,x,y,z,vx,vy,vz,wx,wy,wz\nparticle,0,0.1,-2,3.5,0,1e-10,4,0,0,0\n");
}

TEST(StateCsvFormat, BallsFollowTheParticles) {
  const test::TemporaryDirectory dir;
  State state;
  state.ball_position = {{1.0, 2.0, 3.0}};
  state.ball_velocity = {{4.0, 5.0, 6.0}};
  state.ball_angular_velocity = {{7.0, 8.0, -9.5}};
  auto file = AtomicFile::create(dir.file("s.csv"), Overwrite::refuse);
  ASSERT_TRUE(file.ok() && write_state_csv(*file, state).ok() && file->commit().ok());
  EXPECT_EQ(dir.read("s.csv"), "kind,index,x,y,z,vx,vy,vz,wx,wy,wz\nball,0,1,2,3,4,5,6,7,8,-9.5\n");
  state.ball_angular_velocity[0].y = std::numeric_limits<double>::infinity();
  auto other = AtomicFile::create(dir.file("t.csv"), Overwrite::refuse);
  ASSERT_TRUE(other.ok());
  const Status written = write_state_csv(*other, state);
  ASSERT_FALSE(written.ok());
  EXPECT_THAT(written.error().message(), HasSubstr("ball 0"));
}

TEST(StateCsvFormat, NotANumberIsNeverWritten) {
  const test::TemporaryDirectory dir;
  State state;
  state.position = {{0.0, 0.0, 0.0}, {0.0, std::numeric_limits<double>::quiet_NaN(), 0.0}};
  state.velocity = {{}, {}};
  {
    auto file = AtomicFile::create(dir.file("s.csv"), Overwrite::refuse);
    ASSERT_TRUE(file.ok());
    const Status written = write_state_csv(*file, state);
    ASSERT_FALSE(written.ok());
    EXPECT_EQ(written.error().code, ErrorCode::diverged);
    EXPECT_THAT(written.error().message(), HasSubstr("particle 1"));
  }
  EXPECT_EQ(dir.entries(), 0u);
}

struct BadTable {
  const char* text;
  const char* message;
};

void PrintTo(const BadTable& table, std::ostream* os) {
  *os << table.message;
}

class StateCsvErrors : public testing::TestWithParam<BadTable> {};

TEST_P(StateCsvErrors, NameTheLine) {
  const auto state = test::parse_state_csv(GetParam().text, "s.csv", Precision::single);
  ASSERT_FALSE(state.ok());
  EXPECT_EQ(state.error().code, ErrorCode::io);
  EXPECT_THAT(state.error().message(), HasSubstr(GetParam().message));
}

#define HEADER "kind,index,x,y,z,vx,vy,vz,wx,wy,wz\n"
INSTANTIATE_TEST_SUITE_P(
    Tables, StateCsvErrors,
    testing::Values(BadTable{"", "s.csv: empty"}, BadTable{"x,y\n", "s.csv:1: the header"},
                    BadTable{HEADER "particle,0,1,2,3\n", "s.csv:2: expected 11 fields"},
                    BadTable{HEADER "particle,0,1,2,3,4,5,6,7,8,9,10\n", "s.csv:2: expected 11 fields"},
                    BadTable{HEADER "cloud,0,1,2,3,4,5,6,0,0,0\n", "s.csv:2: unknown kind \"cloud\""},
                    BadTable{HEADER "particle,0,1,2,3,4,5,6,0,0,0\nparticle,2,1,2,3,4,5,6,0,0,0\n",
                             "s.csv:3: expected index 1"},
                    BadTable{HEADER "ball,0,1,2,3,4,5,6,0,0,0\nparticle,0,1,2,3,4,5,6,0,0,0\n",
                             "s.csv:3: particles come before balls"},
                    BadTable{HEADER "ball,1,1,2,3,4,5,6,0,0,0\n", "s.csv:2: expected index 0"},
                    BadTable{HEADER "particle,0,1,2,nan,4,5,6,0,0,0\n", "\"nan\" is not a finite number"},
                    BadTable{HEADER "particle,0,1,2,3x,4,5,6,0,0,0\n", "\"3x\" is not a finite number"},
                    BadTable{HEADER "particle,0,1,2,1e39,4,5,6,0,0,0\n", "of single precision"}));

TEST(StateCsvErrors, MissingFileSaysSo) {
  const auto state = test::read_state_csv("/nonexistent/s.csv", Precision::single);
  ASSERT_FALSE(state.ok());
  EXPECT_THAT(state.error().message(), HasSubstr("/nonexistent/s.csv"));
}

}  // namespace
}  // namespace aspic

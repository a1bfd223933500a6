#include "io/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/random_state.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

Checkpoint example(Precision precision) {
  Checkpoint checkpoint;
  checkpoint.program_version = "1.2.3";
  checkpoint.scene = "schema = 1\nname = \"jelly\"\n";
  checkpoint.timestep = 0.001;
  checkpoint.state = test::random_bits_state(37, precision);
  checkpoint.state.step = 123456789012345ull;
  return checkpoint;
}

class CheckpointOf : public testing::TestWithParam<Precision> {};

TEST_P(CheckpointOf, ReadsBackWhole) {
  const test::TemporaryDirectory dir;
  const Checkpoint checkpoint = example(GetParam());
  auto file = AtomicFile::create(dir.file("c"), Overwrite::refuse);
  ASSERT_TRUE(file.ok() && write_checkpoint(*file, checkpoint).ok() && file->commit().ok());
  const auto back = read_checkpoint(dir.file("c"));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->program_version, checkpoint.program_version);
  EXPECT_EQ(back->scene, checkpoint.scene);
  EXPECT_EQ(back->timestep, checkpoint.timestep);
  EXPECT_EQ(back->state.step, checkpoint.state.step);
  EXPECT_EQ(back->state.precision, GetParam());
  EXPECT_EQ(state_hash(back->state), state_hash(checkpoint.state));
}

TEST_P(CheckpointOf, EveryTruncationIsRefused) {
  const std::string bytes = encode_checkpoint(example(GetParam()));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto back = decode_checkpoint(std::string_view(bytes).substr(0, size), "c");
    ASSERT_FALSE(back.ok()) << size;
    EXPECT_EQ(back.error().code, ErrorCode::io);
  }
}

TEST_P(CheckpointOf, EveryFlippedBitIsRefused) {
  std::string bytes = encode_checkpoint(example(GetParam()));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<char>(bytes[i] ^ (1 << (i % 8)));
    EXPECT_FALSE(decode_checkpoint(bytes, "c").ok()) << i;
    bytes[i] = static_cast<char>(bytes[i] ^ (1 << (i % 8)));
  }
  EXPECT_TRUE(decode_checkpoint(bytes, "c").ok());
}

INSTANTIATE_TEST_SUITE_P(Precisions, CheckpointOf, testing::Values(Precision::single, Precision::double_));

TEST(Checkpoint, SaysWhatIsWrong) {
  EXPECT_THAT(decode_checkpoint("", "c").error().message, HasSubstr("empty"));
  EXPECT_THAT(decode_checkpoint("schema = 1\n", "c").error().message, HasSubstr("not a checkpoint"));
  std::string bytes = encode_checkpoint(example(Precision::single));
  EXPECT_THAT(decode_checkpoint(bytes.substr(0, bytes.size() / 2), "c").error().message,
              HasSubstr("cut short"));
  bytes[10] = 3;  // the format version follows the ten bytes of the mark
  const auto newer = decode_checkpoint(bytes, "c");
  ASSERT_FALSE(newer.ok());
  EXPECT_THAT(newer.error().message, HasSubstr("format version 3"));
  EXPECT_THAT(newer.error().message, HasSubstr("newer aspic"));
  EXPECT_FALSE(read_checkpoint("/nonexistent/c").ok());
}

TEST(Checkpoint, NotANumberIsNeverWritten) {
  const test::TemporaryDirectory dir;
  Checkpoint checkpoint = example(Precision::double_);
  checkpoint.state.velocity[3].y = std::numeric_limits<double>::infinity();
  auto file = AtomicFile::create(dir.file("c"), Overwrite::refuse);
  ASSERT_TRUE(file.ok());
  const Status written = write_checkpoint(*file, checkpoint);
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code, ErrorCode::diverged);
}

}  // namespace
}  // namespace aspic

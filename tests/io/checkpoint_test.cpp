#include "io/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "base/fnv.h"
#include "support/random_state.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using testing::HasSubstr;

Checkpoint example(Precision precision) {
  Checkpoint checkpoint;
  checkpoint.program_version = "1.2.3";
  checkpoint.scene = "schema = 1\nname = \"jelly\"\n";
  checkpoint.inputs = "timestep = 0.001\n";
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
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back->program_version, checkpoint.program_version);
  EXPECT_EQ(back->scene, checkpoint.scene);
  EXPECT_EQ(back->inputs, checkpoint.inputs);
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

/// As aspic 0.2 wrote it: without inputs.
std::string of_version_2(Checkpoint checkpoint) {
  checkpoint.inputs.clear();
  std::string bytes = encode_checkpoint(checkpoint);
  bytes[10] = 2;
  const std::size_t texts = 42 + 8 + checkpoint.program_version.size() + 8 + checkpoint.scene.size();
  std::size_t fields = 8 + 4;  // and the length of the inputs
  for (const StateField& field : state_fields) fields += 8 + field.name.size() + 8;
  bytes.erase(texts, fields);
  bytes.resize(bytes.size() - 8);
  Fnv1a sum;
  sum.add_bytes(std::as_bytes(std::span(bytes)));
  for (int i = 0; i < 8; ++i) bytes.push_back(static_cast<char>(sum.value() >> (8 * i)));
  return bytes;
}

TEST_P(CheckpointOf, TheVersionBeforeIsRead) {
  const test::TemporaryDirectory dir;
  const Checkpoint checkpoint = example(GetParam());
  const std::string bytes = of_version_2(checkpoint);
  std::ofstream(dir.file("old"), std::ios::binary) << bytes;
  const auto back = read_checkpoint(dir.file("old"));
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back->scene, checkpoint.scene);
  EXPECT_EQ(back->inputs, "");
  EXPECT_EQ(back->state, checkpoint.state);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_checkpoint(std::string_view(bytes).substr(0, size), "c").ok()) << size;
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
  EXPECT_THAT(decode_checkpoint("", "c").error().message(), HasSubstr("empty"));
  EXPECT_THAT(decode_checkpoint("schema = 1\n", "c").error().message(), HasSubstr("not a checkpoint"));
  std::string bytes = encode_checkpoint(example(Precision::single));
  EXPECT_THAT(decode_checkpoint(bytes.substr(0, bytes.size() / 2), "c").error().message(),
              HasSubstr("truncated"));
  bytes[10] = 4;  // the format version follows the ten bytes of the mark
  const auto newer = decode_checkpoint(bytes, "c");
  ASSERT_FALSE(newer.ok());
  EXPECT_THAT(newer.error().message(), HasSubstr("format version 4"));
  EXPECT_THAT(newer.error().message(), HasSubstr("newer version"));
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

TEST(Checkpoint, NumbersOutOfTheirBoundsAreDamage) {
  const auto refused = [](const Checkpoint& checkpoint) {
    const auto back = decode_checkpoint(encode_checkpoint(checkpoint), "c");
    return !back.ok() && back.error().message().find("damaged") != std::string::npos;
  };
  Checkpoint checkpoint = example(Precision::single);
  EXPECT_FALSE(refused(checkpoint));
  for (const double timestep :
       {std::numeric_limits<double>::quiet_NaN(), 0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    checkpoint = example(Precision::single);
    checkpoint.timestep = timestep;
    EXPECT_TRUE(refused(checkpoint)) << timestep;
  }
  for (const std::string& version : {std::string(longest_program_version + 1, '1'), std::string("1\x1b"),
                                     std::string("1\n"), std::string("1\0", 2), std::string("\xc2\x9b")}) {
    checkpoint = example(Precision::single);
    checkpoint.program_version = version;
    EXPECT_TRUE(refused(checkpoint)) << version;
  }
  checkpoint = example(Precision::single);
  checkpoint.program_version = std::string(longest_program_version, '1');
  EXPECT_FALSE(refused(checkpoint));
  checkpoint.state.step = last_checkpoint_step;
  EXPECT_FALSE(refused(checkpoint));
  ++checkpoint.state.step;
  EXPECT_TRUE(refused(checkpoint));
}

TEST(Checkpoint, BelongsToItsScene) {
  ModelSettings settings;
  settings.cubes.resize(1);
  settings.cubes[0].particles_per_edge = 3;
  settings.simulation.timestep = 0.002;
  Checkpoint checkpoint;
  checkpoint.timestep = 0.002;
  checkpoint.state = test::random_bits_state(27, Precision::single);
  const std::size_t balls = checkpoint.state.ball_position.size();
  settings.balls.resize(balls);
  EXPECT_TRUE(check_against_scene(checkpoint, settings, "c").ok());
  settings.balls.resize(balls + 1);
  EXPECT_THAT(check_against_scene(checkpoint, settings, "c").error().message(),
              HasSubstr("balls, but the scene"));
  settings.balls.resize(balls);
  settings.cubes[0].particles_per_edge = 400;
  EXPECT_THAT(check_against_scene(checkpoint, settings, "c").error().message(), HasSubstr("64000000"));
  settings.cubes[0].particles_per_edge = 3;
  settings.simulation.timestep = std::nextafter(0.002, 1.0);
  EXPECT_THAT(check_against_scene(checkpoint, settings, "c").error().message(), HasSubstr("time step"));
}

TEST(Checkpoint, FilesOfTheWrongSizeAreNotRead) {
  const test::TemporaryDirectory dir;
  Checkpoint checkpoint;
  checkpoint.program_version = "1";
  checkpoint.scene = "schema = 1\n";
  checkpoint.timestep = 0.001;
  checkpoint.state = test::random_bits_state(4, Precision::single);
  const std::string whole = encode_checkpoint(checkpoint);
  dir.write("c", whole);
  EXPECT_TRUE(read_checkpoint(dir.file("c")).ok());
  for (const std::size_t size : {whole.size() - 1, whole.size() + 1, std::size_t{60}, std::size_t{100}}) {
    std::filesystem::resize_file(dir.file("c"), size);
    const auto read = read_checkpoint(dir.file("c"));
    ASSERT_FALSE(read.ok()) << size;
    EXPECT_THAT(read.error().message(), HasSubstr("damaged or truncated")) << size;
  }
}

TEST(Checkpoint, OnlyRegularFilesAreRead) {
  const test::TemporaryDirectory dir;
  const std::string pipe = dir.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {std::string("/dev/zero"), std::string("/dev/full"), pipe}) {
    const auto read = read_checkpoint(path);
    ASSERT_FALSE(read.ok());
    EXPECT_EQ(read.error().code, ErrorCode::io);
    EXPECT_THAT(read.error().message(), testing::AllOf(HasSubstr(path), HasSubstr("device or a pipe")));
  }
  EXPECT_THAT(read_checkpoint("/").error().message(), HasSubstr("directory"));
}

}  // namespace
}  // namespace aspic

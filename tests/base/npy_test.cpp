#include "base/npy.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// As np.save() writes it, version 1.
std::string npy(const std::string& header, const std::string& data) {
  const std::string text = header + std::string(63 - (header.size() + 10) % 64, ' ') + '\n';
  std::string file = "\x93NUMPY\x01";
  file += '\0';
  file += static_cast<char>(text.size() & 255);
  file += static_cast<char>(text.size() >> 8);
  return file + text + data;
}

std::string header(const std::string& type, const std::string& shape, const char* fortran = "False") {
  return fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': {}, }}", type, fortran, shape);
}

std::vector<std::int64_t> wholes(const NpyArray& array) {
  std::vector<std::int64_t> all;
  for (std::size_t i = 0; i < array.size(); ++i) all.push_back(array.whole(i));
  return all;
}

TEST(Npy, ReadsWholeNumbersOfEverySizeAndOrder) {
  const auto bytes = NpyArray::read(npy(header("|u1", "(2, 3)"), std::string("\0\1\2\3\xfe\xff", 6)));
  ASSERT_TRUE(bytes.ok()) << bytes.error().what;
  EXPECT_THAT(bytes->shape(), ElementsAre(2u, 3u));
  EXPECT_THAT(wholes(*bytes), ElementsAre(0, 1, 2, 3, 254, 255));
  const auto truths = NpyArray::read(npy(header("|b1", "(2,)"), std::string("\1\0", 2)));
  ASSERT_TRUE(truths.ok());
  EXPECT_THAT(wholes(*truths), ElementsAre(1, 0));
  const auto wide = NpyArray::read(npy(header("<i8", "(1,)"), "\xfe\xff\xff\xff\xff\xff\xff\xff"));
  ASSERT_TRUE(wide.ok());
  EXPECT_THAT(wholes(*wide), ElementsAre(-2));
  const auto other_end = NpyArray::read(npy(header(">i2", "(2,)"), std::string("\xff\x80\0\3", 4)));
  ASSERT_TRUE(other_end.ok());
  EXPECT_THAT(wholes(*other_end), ElementsAre(-128, 3));
  const auto large = NpyArray::read(npy(header("<u8", "()"), std::string(8, '\xff')));
  ASSERT_TRUE(large.ok());
  EXPECT_THAT(wholes(*large), ElementsAre(INT64_MAX)) << "one element without axes";
}

TEST(Npy, ReadsFloatsAndFortransOrder) {
  const auto floats = NpyArray::read(npy(header("<f4", "(2,)"), std::string("\0\0\xc0\x3f\0\0\x20\xc1", 8)));
  ASSERT_TRUE(floats.ok());
  EXPECT_FALSE(floats->whole_numbers());
  EXPECT_EQ(floats->number(0), 1.5);
  EXPECT_EQ(floats->number(1), -10.0);
  // [[0, 1, 2], [3, 4, 5]] by columns.
  const auto columns = NpyArray::read(npy(header("|i1", "(2, 3)", "True"), std::string("\0\3\1\4\2\5", 6)));
  ASSERT_TRUE(columns.ok());
  EXPECT_THAT(wholes(*columns), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(Npy, RefusesWhatItCannotTrust) {
  const std::string good = npy(header("|u1", "(4,)"), "1234");
  ASSERT_TRUE(NpyArray::read(good).ok());
  const std::pair<std::string, const char*> cases[] = {
      {"", "not those of a .npy file"},
      {"PK\3\4 an archive", "not those of a .npy file"},
      {good.substr(0, 9), "not those of a .npy file"},
      {good.substr(0, 40), "truncated"},
      {good.substr(0, good.size() - 1), "does not match its shape"},
      {good + "5", "does not match its shape"},
      {npy("{'descr': '|u1', 'shape': (4,), }", "1234"), "lacks a key"},
      {npy(header("|O8", "(4,)"), "1234"), "neither integers nor floats"},
      {npy(header("<U4", "(1,)"), "1234"), "neither integers nor floats"},
      {npy(header("<f2", "(2,)"), "1234"), "neither integers nor floats"},
      {npy("{'descr': [('a', '|u1')], 'fortran_order': False, 'shape': (4,), }", "1234"), "not numbers"},
      {npy(header("|u1", "4"), "1234"), "shape is unknown"},
      {npy(header("|u1", "(-4,)"), "1234"), "shape is unknown"},
      {npy(header("|u1", "(1,1,1,1,1,1,1,1,4)"), "1234"), "shape is unknown"},
      {npy(header("|u1", "(65536, 65536)"), "1234"), "too many elements"},
      {npy(header("|u1", "(18446744073709551615,)"), "1234"), "too many elements"},
      {npy(header("|u1", "(99999999999999999999,)"), "1234"), "shape is unknown"},
      {npy(header("|u1", "(4,)", "Perhaps"), "1234"), "order is unknown"}};
  for (const auto& [content, why] : cases) {
    const auto array = NpyArray::read(content);
    ASSERT_FALSE(array.ok()) << why;
    EXPECT_EQ(array.error().code, ErrorCode::scene_rejected);
    EXPECT_THAT(array.error().what, HasSubstr(why));
  }
}

TEST(Npy, SurvivesAnyChangeOfItsBytes) {
  const std::string good = npy(header("<u2", "(2, 2)"), "12345678");
  std::mt19937 random(30);
  for (int trial = 0; trial < 20000; ++trial) {
    std::string content = good;
    const int changes = 1 + trial % 4;
    for (int n = 0; n < changes; ++n) content[random() % content.size()] = static_cast<char>(random());
    if (trial % 3 == 0) content.resize(random() % content.size());
    const auto array = NpyArray::read(content);
    if (!array) continue;
    for (std::size_t i = 0; i < array->size() && array->whole_numbers(); ++i)
      EXPECT_EQ(static_cast<double>(array->whole(i)), array->number(i));
  }
}

}  // namespace
}  // namespace aspic

#include "base/fnv.h"

#include <gtest/gtest.h>

#include <cstring>

namespace aspic {
namespace {

std::uint64_t hash_of(const char* text) {
  Fnv1a hash;
  hash.add_bytes(std::as_bytes(std::span(text, std::strlen(text))));
  return hash.value();
}

// Test vectors of draft-eastlake-fnv, appendix C.
TEST(Fnv1a, PublishedVectors) {
  EXPECT_EQ(hash_of(""), 0xcbf29ce484222325ull);
  EXPECT_EQ(hash_of("a"), 0xaf63dc4c8601ec8cull);
  EXPECT_EQ(hash_of("foobar"), 0x85944171f73967e8ull);
}

std::string digits_of(const char* text) {
  Fnv1a128 hash;
  hash.add_bytes(std::as_bytes(std::span(text, std::strlen(text))));
  return hash.digits();
}

// Those of hash/fnv in Go.
TEST(Fnv1a128, PublishedVectors) {
  EXPECT_EQ(digits_of(""), "6c62272e07bb014262b821756295c58d");
  EXPECT_EQ(digits_of("a"), "d228cb696f1a8caf78912b704e4a8964");
  EXPECT_EQ(digits_of("abc"), "a68d622cec8b5822836dbc7977af7f3b");
}

TEST(Fnv1a, NumbersAreLittleEndianBytes) {
  Fnv1a by_number, by_bytes;
  by_number.add(1.0f);  // 0x3f800000
  const std::byte bytes[] = {std::byte{0}, std::byte{0}, std::byte{0x80}, std::byte{0x3f}};
  by_bytes.add_bytes(bytes);
  EXPECT_EQ(by_number.value(), by_bytes.value());
}

}  // namespace
}  // namespace aspic

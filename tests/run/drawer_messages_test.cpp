// What processes that draw are told, there and back, and cut short.

#include "run/drawer_messages.h"

#include <gtest/gtest.h>

namespace aspic {
namespace {

std::string_view body(const std::string& message) {
  return std::string_view(message).substr(8);
}

DrawerRequest request() {
  DrawerRequest r = {2, {17, 34}, {}};
  r.shown.resize(2);
  r.shown[0].camera.fov = 33.5;
  r.shown[0].text = {{"time", "0.1 s"}, {"", "diverged", true, Colour{0.1f, 0.2f, 0.3f}}};
  r.shown[0].text_height = 12;
  r.shown[0].legend = false;
  r.shown[0].tint = Colour{0.4f, 0.5f, 0.6f};
  r.shown[0].framed = true;
  r.shown[1].arrows = {{{{1, 2, 3}, {4, 5, 6}, ArrowKind::contact}}, 0.5, 1e-9};
  r.shown[1].ball_turns = {{0, 0, 0, 1}, {1, 0, 0, 0}};
  return r;
}

TEST(DrawerMessages, ARequestComesAsItWasSent) {
  const DrawerRequest sent = request();
  const auto got = read_request(body(message_of(sent)));
  ASSERT_TRUE(got.ok());
  EXPECT_EQ(got->slot, 2u);
  EXPECT_EQ(got->steps, sent.steps);
  ASSERT_EQ(got->shown.size(), 2u);
  EXPECT_EQ(got->shown[0].camera, sent.shown[0].camera);
  EXPECT_EQ(got->shown[0].text, sent.shown[0].text);
  EXPECT_EQ(got->shown[0].text_height, 12);
  EXPECT_FALSE(got->shown[0].legend);
  EXPECT_EQ(got->shown[0].tint, sent.shown[0].tint);
  EXPECT_TRUE(got->shown[0].framed);
  EXPECT_TRUE(got->shown[1].legend);
  EXPECT_FALSE(got->shown[1].tint.has_value());
  EXPECT_FALSE(got->shown[1].framed);
  EXPECT_EQ(got->shown[1].arrows, sent.shown[1].arrows);
  EXPECT_EQ(got->shown[1].ball_turns, sent.shown[1].ball_turns);
}

TEST(DrawerMessages, AGreetingComesAsItWasSent) {
  const auto got = read_greeting(body(message_of(DrawerGreeting{{64, 48}, 3, "llvmpipe", {"a = 1", ""}})));
  ASSERT_TRUE(got.ok());
  EXPECT_EQ(got->size, (PictureSize{64, 48}));
  EXPECT_EQ(got->slots, 3u);
  EXPECT_EQ(got->device, "llvmpipe");
  EXPECT_EQ(got->scenes, (std::vector<std::string>{"a = 1", ""}));
}

TEST(DrawerMessages, DamagedOnesAreRefused) {
  const std::string message = message_of(request());
  const std::string_view whole = body(message);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(read_request(whole.substr(0, size)).ok()) << size;
  EXPECT_FALSE(read_request(std::string(whole) + "x").ok());
  EXPECT_FALSE(read_greeting(std::string(64, '\xff')).ok());
}

TEST(DrawerMessages, SlotsLieApart) {
  Model model;
  const SlotLayout layout({33, 17}, {{nullptr, &model}});
  std::vector<std::byte> memory(3 * layout.bytes());
  EXPECT_EQ(layout.bytes() % 64, 0u);
  for (std::uint64_t slot = 0; slot < 3; ++slot) {
    const auto pixels = layout.pixels(memory, slot);
    EXPECT_EQ(pixels.size(), std::size_t{3} * 33 * 17);
    EXPECT_GE(pixels.data(), memory.data() + slot * layout.bytes());
    EXPECT_LE(pixels.data() + pixels.size(), memory.data() + (slot + 1) * layout.bytes());
    EXPECT_EQ(layout.particles(memory, slot, 0).size(), model.particle_count());
  }
}

}  // namespace
}  // namespace aspic

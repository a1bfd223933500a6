#include "app/messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace aspic::app {
namespace {

using testing::ElementsAre;

std::vector<std::string> texts(const Messages& messages) {
  std::vector<std::string> all;
  for (const Notice& notice : messages.notices()) all.push_back(notice.text);
  return all;
}

TEST(Messages, NewsNeverReplacesAnError) {
  Messages messages;
  messages.error("no page");
  messages.info("recording");
  EXPECT_THAT(texts(messages), ElementsAre("no page", "recording"));
  messages.update(6.0);
  EXPECT_THAT(texts(messages), ElementsAre("no page"));
  EXPECT_FALSE(messages.fades());
  for (const char* const news : {"a", "b", "c"}) messages.info(news);
  EXPECT_THAT(texts(messages), ElementsAre("no page", "b", "c"));
}

TEST(Messages, NewsReplacesOlderNewsAndStandsBesideFresh) {
  Messages messages;
  messages.info("old");
  messages.update(1.5);
  messages.info("video");
  messages.update(0.4);
  messages.info("page");
  messages.update(0.4);
  messages.info("states");
  EXPECT_THAT(texts(messages), ElementsAre("video", "page", "states"));
  messages.info("page");
  EXPECT_THAT(texts(messages), ElementsAre("video", "states", "page"));
  messages.update(4.5);
  EXPECT_THAT(texts(messages), ElementsAre("states", "page"));
}

TEST(Messages, OldestErrorMakesRoomForTheFourth) {
  Messages messages;
  for (const char* const text : {"1", "2", "3", "4"}) messages.error(text);
  EXPECT_THAT(texts(messages), ElementsAre("2", "3", "4"));
  messages.dismiss("3");
  EXPECT_THAT(texts(messages), ElementsAre("2", "4"));
  messages.dismiss();
  EXPECT_FALSE(messages.notice());
}

TEST(Messages, EndWithTheirReason) {
  Messages messages;
  messages.error("diverged", Until::divergence_is_over);
  messages.refuse("not so");
  messages.divergence_is_over();
  EXPECT_THAT(texts(messages), ElementsAre("not so"));
  messages.dismiss_refusal();
  messages.greet("welcome", 15.0);
  messages.greeting_is_over();
  EXPECT_TRUE(messages.notices().empty());
}

}  // namespace
}  // namespace aspic::app

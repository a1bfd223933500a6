#include "io/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include "base/end_request.h"
#include "io/program.h"

namespace aspic {
namespace {

std::span<const std::byte> bytes(const std::string& text) {
  return std::as_bytes(std::span(text));
}

TEST(ChildProcess, FeedsAndKeepsTheLastLines) {
  auto child = ChildProcess::start({"sh", "-c", "cat >&2; exit 3"});
  ASSERT_TRUE(child.ok()) << child.error().message();
  EXPECT_TRUE(child->write(bytes("one\ntwo\nthree\n")));
  EXPECT_EQ(child->finish().exit_code, 3);
  EXPECT_EQ(child->last_lines(2), "two\nthree\n");
  EXPECT_EQ(child->last_lines(9), "one\ntwo\nthree\n");
}

TEST(ChildProcess, AnswersLineByLine) {
  auto child = ChildProcess::start({"sh", "-c", "echo ready; read word; echo \"$word\"; printf 'no end'"},
                                   ChildProcess::Output::answers);
  ASSERT_TRUE(child.ok()) << child.error().message();
  EXPECT_EQ(child->line(), "ready");
  ASSERT_TRUE(child->write(bytes("hello\n")));
  EXPECT_EQ(child->line(), "hello");
  EXPECT_EQ(child->line(), std::nullopt);
  EXPECT_EQ(child->finish().exit_code, 0);
}

TEST(ChildProcess, ArgumentsPassNoShell) {
  auto child = ChildProcess::start({"sh", "-c", "printf %s \"$1\" >&2", "sh", "a b; $(exit 1) 'c'"});
  ASSERT_TRUE(child.ok());
  EXPECT_TRUE(child->finish().ok());
  EXPECT_EQ(child->last_lines(1), "a b; $(exit 1) 'c'\n");
}

TEST(ChildProcess, AReaderThatEndsRaisesNoSignal) {
  auto child = ChildProcess::start({"sh", "-c", "echo enough >&2; exit 1"});
  ASSERT_TRUE(child.ok());
  const std::string block(1 << 16, 'x');
  bool open = true;
  for (int i = 0; i < 1000 && open; ++i) open = child->write(bytes(block));
  EXPECT_FALSE(open);
  EXPECT_EQ(child->finish().exit_code, 1);
  EXPECT_EQ(child->last_lines(5), "enough\n");
}

TEST(ChildProcess, ReportsSignals) {
  auto child = ChildProcess::start({"sh", "-c", "kill -TERM $$"});
  ASSERT_TRUE(child.ok());
  const ChildProcess::End end = child->finish();
  EXPECT_EQ(end.signal, SIGTERM);
  EXPECT_FALSE(end.ok());
  EXPECT_EQ(child->last_lines(3), "");
}

TEST(ChildProcess, TellsWhetherAllWasRead) {
  const std::string block(1 << 14, 'x');
  auto all = ChildProcess::start({"sh", "-c", "cat > /dev/null"});
  ASSERT_TRUE(all.ok() && all->write(bytes(block)));
  EXPECT_TRUE(all->finish().ok());
  // It reports success, and all that was written had room on the way to it.
  auto some = ChildProcess::start({"sh", "-c", "head -c 1000 > /dev/null"});
  ASSERT_TRUE(some.ok() && some->write(bytes(block)));
  const ChildProcess::End end = some->finish();
  EXPECT_EQ(end.exit_code, 0);
  EXPECT_TRUE(end.unread);
  EXPECT_FALSE(end.ok());
}

TEST(ChildProcess, HasAsLongAsItIsGiven) {
  auto child = ChildProcess::start({"sh", "-c", "sleep 600; exit 0"});
  ASSERT_TRUE(child.ok());
  const ChildProcess::End end = child->finish(std::chrono::seconds(0));
  EXPECT_TRUE(end.stalled);
  EXPECT_EQ(end.signal, SIGKILL);
}

TEST(ChildProcess, OneThatHaltsDoesNotHoldUpTheEnd) {
  const InterruptGuard guard;
  end_requested = true;
  auto silent = ChildProcess::start({"sh", "-c", "sleep 600"}, ChildProcess::Output::answers);
  auto idle = ChildProcess::start({"sh", "-c", "sleep 600"});
  ASSERT_TRUE(silent.ok() && idle.ok());
  EXPECT_EQ(silent->line(), std::nullopt);
  EXPECT_FALSE(idle->write(bytes(std::string(1 << 24, 'x'))));
  EXPECT_TRUE(idle->finish().stalled);
}

TEST(ChildProcess, OneThatWorksIsWaitedForAtTheEnd) {
  const InterruptGuard guard;
  end_requested = true;
  // Longer at work than one that does nothing is given.
  auto child = ChildProcess::start(
      {"sh", "-c", "for i in 1 2 3 4 5 6; do timeout 1 sh -c 'while :; do :; done'; done; exit 0"});
  ASSERT_TRUE(child.ok());
  const ChildProcess::End end = child->finish();
  EXPECT_TRUE(end.ok()) << end.exit_code << ' ' << end.signal;
}

TEST(ChildProcess, AllEndWhereTheProcessIsAboutTo) {
  auto first = ChildProcess::start({"sleep", "600"});
  auto second = ChildProcess::start({"sleep", "600"});
  ASSERT_TRUE(first.ok() && second.ok());
  end_child_processes();
  // They are waited for already: what finish() could still learn is gone, but it does not wait for the sleep.
  EXPECT_EQ(first->finish().exit_code, -1);
  EXPECT_EQ(second->finish().exit_code, -1);
  end_child_processes();
}

TEST(ChildProcess, MissingProgramIsAnError) {
  const auto child = ChildProcess::start({"no-such-program-anywhere"});
  ASSERT_FALSE(child.ok());
  EXPECT_THAT(child.error().message(), testing::HasSubstr("Cannot start no-such-program-anywhere"));
}

}  // namespace
}  // namespace aspic

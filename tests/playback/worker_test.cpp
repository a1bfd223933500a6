#include "playback/worker.h"

#include <gtest/gtest.h>

#include <new>
#include <string>
#include <thread>

namespace aspic::test {
namespace {

TEST(Worker, RunsOneJobAfterTheOther) {
  Worker worker;
  int sum = 0;
  for (int i = 1; i <= 100; ++i) {
    worker.start([&sum, i](const std::atomic<bool>&) { sum += i; });
    worker.wait();
    EXPECT_FALSE(worker.busy());
  }
  EXPECT_EQ(sum, 5050);
}

TEST(Worker, FinishCancelsAJobThatWouldNeverEnd) {
  Worker worker;
  bool ended = false;
  worker.start([&ended](const std::atomic<bool>& cancelled) {
    while (!cancelled) std::this_thread::yield();
    ended = true;
  });
  EXPECT_TRUE(worker.busy());
  worker.finish();
  EXPECT_TRUE(ended);
  // Cancelling was for that job's alone.
  bool was_cancelled = true;
  worker.start([&was_cancelled](const std::atomic<bool>& cancelled) { was_cancelled = cancelled; });
  worker.wait();
  EXPECT_FALSE(was_cancelled);
}

TEST(Worker, JobsWaitForOneAnotherAndCancellingForgetsThoseThatWait) {
  Worker worker;
  std::string order;
  std::atomic<bool> begun = false;
  worker.start([&](const std::atomic<bool>& cancelled) {
    begun = true;
    while (!cancelled) std::this_thread::yield();
    order += "a";
  });
  worker.start([&](const std::atomic<bool>&) { order += "b"; });
  EXPECT_EQ(worker.jobs(), 2u);
  while (!begun) std::this_thread::yield();
  worker.cancel();
  worker.start([&](const std::atomic<bool>& cancelled) { order += cancelled ? "cancelled" : "c"; });
  worker.wait();
  EXPECT_EQ(order, "ac");
}

TEST(Worker, HandsOnWhatAJobThrows) {
  Worker worker;
  const auto fail = [](const std::atomic<bool>&) { throw std::bad_alloc(); };
  worker.start(fail);
  EXPECT_THROW(worker.wait(), std::bad_alloc);
  EXPECT_FALSE(worker.busy());
  worker.start(fail);
  worker.abandon();
  EXPECT_THROW(worker.start(fail), std::bad_alloc);
  // Once is enough, and nothing is left behind.
  bool ran = false;
  worker.start([&ran](const std::atomic<bool>&) { ran = true; });
  worker.finish();
  EXPECT_TRUE(ran);
  worker.start(fail);
}

TEST(Worker, EndsWithAJobUnderWay) {
  std::atomic<bool> ended = false;
  {
    Worker worker;
    worker.start([&ended](const std::atomic<bool>& cancelled) {
      while (!cancelled) std::this_thread::yield();
      ended = true;
    });
  }
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace aspic::test

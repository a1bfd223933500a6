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
  worker.start([&ended](const std::atomic<bool>& canceled) {
    while (!canceled) std::this_thread::yield();
    ended = true;
  });
  EXPECT_TRUE(worker.busy());
  worker.finish();
  EXPECT_TRUE(ended);
  // Canceling was for that job's alone.
  bool was_canceled = true;
  worker.start([&was_canceled](const std::atomic<bool>& canceled) { was_canceled = canceled; });
  worker.wait();
  EXPECT_FALSE(was_canceled);
}

TEST(Worker, JobsWaitForOneAnotherAndCancelingForgetsThoseThatWait) {
  Worker worker;
  std::string order;
  std::atomic<bool> begun = false;
  worker.start([&](const std::atomic<bool>& canceled) {
    begun = true;
    while (!canceled) std::this_thread::yield();
    order += "a";
  });
  worker.start([&](const std::atomic<bool>&) { order += "b"; });
  EXPECT_EQ(worker.jobs(), 2u);
  while (!begun) std::this_thread::yield();
  worker.cancel();
  worker.start([&](const std::atomic<bool>& canceled) { order += canceled ? "canceled" : "c"; });
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
    worker.start([&ended](const std::atomic<bool>& canceled) {
      while (!canceled) std::this_thread::yield();
      ended = true;
    });
  }
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace aspic::test

#include "cpu_parallel/workers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>

namespace aspic::parallel {
namespace {

TEST(Workers, DoEveryPieceOnceInEveryRound) {
  for (const unsigned threads : {1u, 2u, 5u}) {
    Workers workers(threads);
    EXPECT_EQ(workers.threads(), threads);
    std::vector<int> done(97, 0);
    for (int round = 0; round < 2000; ++round) {
      const std::size_t pieces = static_cast<std::size_t>(round) % (done.size() + 1);
      std::ranges::fill(done, 0);
      workers.run(pieces, [&](std::size_t n) { ++done[n]; });
      for (std::size_t n = 0; n < done.size(); ++n) ASSERT_EQ(done[n], n < pieces ? 1 : 0) << "piece " << n;
    }
  }
}

TEST(Workers, SeeWhatTheRoundBeforeWrote) {
  Workers workers(4);
  std::vector<std::uint64_t> sums(64, 1);
  for (int round = 0; round < 200; ++round) {
    const std::uint64_t total = std::accumulate(sums.begin(), sums.end(), std::uint64_t{0});
    workers.run(sums.size(), [&](std::size_t n) { sums[n] = total % 1000003 + n; });
    for (std::size_t n = 0; n < sums.size(); ++n) ASSERT_EQ(sums[n], total % 1000003 + n);
  }
}

TEST(Workers, ShareThePiecesOfOthersAsTheyComeAndGo) {
  constexpr std::size_t jobs = 7, rounds = 300;
  Workers pool(5);
  std::vector<std::shared_ptr<Workers>> helped;
  for (std::size_t n = 0; n < jobs; ++n) helped.push_back(Workers::of_helpers(pool.threads()));
  for (int repeat = 0; repeat < 3; ++repeat) {
    std::vector<std::vector<int>> done(jobs, std::vector<int>(41, 0));
    std::vector<std::vector<int>> at_work(jobs, std::vector<int>(pool.threads(), 0));
    std::atomic<std::size_t> next = 0;
    for (const auto& each : helped) each->admit();
    pool.run(pool.threads(), [&](std::size_t) {
      for (std::size_t n = next++; n < jobs; n = next++) {
        for (std::size_t round = 0; round < rounds; ++round)
          helped[n]->run(done[n].size(), [&](std::size_t piece) {
            ++done[n][piece];
            ++at_work[n][helped[n]->current()];  // a number is one thread's alone
          });
        helped[n]->release();
      }
      for (const auto& each : helped) each->help();
    });
    for (std::size_t n = 0; n < jobs; ++n) {
      for (const int count : done[n]) ASSERT_EQ(count, static_cast<int>(rounds));
      EXPECT_EQ(std::accumulate(at_work[n].begin(), at_work[n].end(), 0), static_cast<int>(rounds * 41));
    }
  }
  helped[0]->help();  // released: at once
}

TEST(Workers, AreAsManyAsTheEnvironmentSays) {
  setenv("ASPIC_THREADS", "3", 1);
  EXPECT_EQ(*available_threads(), 3u);
  setenv("ASPIC_THREADS", "1024", 1);
  EXPECT_EQ(*available_threads(), 1024u);
  for (const char* const word : {"", "0", "-1", "+2", "many", "2 ", "2.0", "1025", "99999999999"}) {
    setenv("ASPIC_THREADS", word, 1);
    const auto threads = available_threads();
    ASSERT_FALSE(threads.ok()) << word;
    EXPECT_EQ(threads.error().code, ErrorCode::usage);
    EXPECT_NE(threads.error().message().find("a whole number from 1 to 1024"), std::string::npos);
  }
  unsetenv("ASPIC_THREADS");
  EXPECT_GE(*available_threads(), 1u);
}

}  // namespace
}  // namespace aspic::parallel

#include "proofmass/fleet/pool.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <thread>
#include <unistd.h>
#include <vector>

namespace proofmass::fleet::pool_test {
namespace {

namespace fs = std::filesystem;

class Pool : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("proofmass_pool_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Status run(const std::vector<std::size_t>& jobs,
             PoolOptions options,
             const std::function<int(std::size_t)>& work,
             const std::function<bool(const Ended&)>& again = {}) {
    return run_pool(jobs, options,
                    {.run = work,
                     .output = [&](std::size_t job) { return folder_ / std::to_string(job); },
                     .ended =
                         [&](const Ended& one) {
                           ended_.push_back(one);
                           return again && again(one);
                         },
                     .goes_on =
                         [&](std::size_t running) {
                           most_running_ = std::max(most_running_, running);
                           return goes_on_;
                         }});
  }

  fs::path folder_;
  std::vector<Ended> ended_;
  std::size_t most_running_ = 0;
  bool goes_on_ = true;
};

TEST_F(Pool, RunsEachJobOnceAndNoMoreAtATimeThanItMay) {
  ASSERT_TRUE(run({4, 2, 0, 1, 3}, {.processes = 2}, [](std::size_t job) {
    std::printf("job %zu", job);
    std::fflush(stdout);
    std::fprintf(stderr, "says %zu", job);
    return static_cast<int>(job);
  }));
  EXPECT_LE(most_running_, 2U);
  ASSERT_EQ(ended_.size(), 5U);
  for (const Ended& one : ended_) {
    EXPECT_EQ(one.status, static_cast<int>(one.job));
    EXPECT_EQ(one.words, "says " + std::to_string(one.job));
    std::string text;
    std::getline(std::ifstream(folder_ / std::to_string(one.job)), text);
    EXPECT_EQ(text, "job " + std::to_string(one.job));
  }
}

TEST_F(Pool, ContainsACrash) {
  ASSERT_TRUE(run({0, 1}, {.processes = 2}, [](std::size_t job) {
    if (job == 0) {
      std::signal(SIGSEGV, SIG_DFL);
      ::raise(SIGSEGV);
    }
    return 0;
  }));
  std::map<std::size_t, int> signals;
  for (const Ended& one : ended_) signals[one.job] = one.signal;
  EXPECT_EQ(signals, (std::map<std::size_t, int>{{0, SIGSEGV}, {1, 0}}));
}

TEST_F(Pool, EndsAJobThatHangsWithAllThatItStarted) {
  const auto begun = std::chrono::steady_clock::now();
  const std::string mark = folder_ / "grandchild";
  ASSERT_TRUE(run({0}, {.processes = 1, .timeout_s = 0.3}, [&](std::size_t) {
    if (::fork() == 0) {
      std::this_thread::sleep_for(std::chrono::seconds(2));
      std::ofstream{mark} << "lives";
      ::_exit(0);
    }
    for (;;) ::pause();
    return 0;
  }));
  ASSERT_EQ(ended_.size(), 1U);
  EXPECT_TRUE(ended_[0].timed_out);
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::milliseconds(1800));
  std::this_thread::sleep_for(std::chrono::milliseconds(2300));
  EXPECT_FALSE(fs::exists(mark));
}

TEST_F(Pool, DoesAJobAgainWhereItIsAskedTo) {
  ASSERT_TRUE(run(
      {0, 1}, {.processes = 1}, [](std::size_t) { return 1; },
      [&](const Ended& one) { return one.job == 0 && ended_.size() < 3; }));
  std::vector<std::size_t> order;
  for (const Ended& one : ended_) order.push_back(one.job);
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 0}));
}

TEST_F(Pool, LimitsTheMemoryOfAJob) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer's own memory is beyond any limit";
#else
  ASSERT_TRUE(run({0}, {.processes = 1, .memory_bytes = std::size_t{256} << 20U}, [](std::size_t) {
    const std::vector<char> much(std::size_t{1} << 30U, 'x');
    return much[much.size() / 2] == 'x' ? 0 : 1;
  }));
  ASSERT_EQ(ended_.size(), 1U);
  EXPECT_EQ(ended_[0].status, 1);
  EXPECT_NE(ended_[0].words.find("bad_alloc"), std::string::npos);
#endif
}

TEST_F(Pool, EndsAllWhereItIsToStop) {
  goes_on_ = false;
  ASSERT_TRUE(run({0, 1, 2}, {.processes = 2}, [](std::size_t) { return 0; }));
  EXPECT_TRUE(ended_.empty());
}

}  // namespace
}  // namespace proofmass::fleet::pool_test

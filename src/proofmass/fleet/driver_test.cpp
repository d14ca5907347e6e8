#include "proofmass/fleet/driver.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <numeric>

namespace proofmass::fleet::driver_test {
namespace {

namespace fs = std::filesystem;

// A driver in the shell's words: each line that comes in is answered by what `answer` prints of the
// job's number $n.
std::vector<std::string> shell_driver(const std::string& answer) {
  return {"sh", "-c", "while read -r line; do n=${line#*:}; n=${n%%,*}; " + answer + "; done"};
}

std::string answer(const std::string& status, const std::string& document) {
  return R"(printf '{"job": %d, "status": )" + status +
         R"(, "signal": 0, "timed_out": false, "seconds": 0.5, "words": "w", "document": ")" +
         document + R"("}\n' "$n")";
}

class RunDriver : public testing::Test {
 protected:
  void SetUp() override {
    std::signal(SIGPIPE, SIG_IGN);
    folder_ = fs::temp_directory_path() /
              ("proofmass_driver_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  Status run(std::size_t jobs, const std::vector<std::string>& command) {
    std::vector<std::size_t> order(jobs);
    std::iota(order.begin(), order.end(), std::size_t{0});
    return run_driver(order, {.command = command, .program = {}},
                      {.arguments = [](std::size_t) { return std::vector<std::string>{"noise"}; },
                       .output = [&](std::size_t job) { return path(job); },
                       .ended =
                           [&](const Ended& one) {
                             ended_.push_back(one);
                             return ended_.size() <= again_;
                           },
                       .goes_on = [&](std::size_t) { return goes_on_; }});
  }
  [[nodiscard]] std::string path(std::size_t job) const {
    return (folder_ / std::to_string(job)).string();
  }

  fs::path folder_;
  std::vector<Ended> ended_;
  std::size_t again_ = 0;
  bool goes_on_ = true;
};

TEST_F(RunDriver, TakesEachResultWithItsDocument) {
  ASSERT_TRUE(run(300, shell_driver(answer("0", "the document"))));
  ASSERT_EQ(ended_.size(), 300U);
  EXPECT_EQ(ended_[7].job, 7U);
  EXPECT_EQ(ended_[7].seconds, 0.5);
  std::ifstream file(path(7));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "the document");
}

TEST_F(RunDriver, HasAJobDoneAgainWhereThatIsAskedFor) {
  again_ = 1;
  ASSERT_TRUE(run(2, shell_driver(answer("1", ""))));
  ASSERT_EQ(ended_.size(), 3U);
  EXPECT_EQ(ended_[0].job, ended_[2].job);
  EXPECT_EQ(ended_[0].status, 1);
  EXPECT_EQ(ended_[0].words, "w");
}

TEST_F(RunDriver, SaysWhatADriverThatEndsEarlyWroteLast) {
  const Status ran = run(2, {"sh", "-c", "echo first >&2; echo 'no scheduler there' >&2; exit 1"});
  ASSERT_FALSE(ran);
  EXPECT_EQ(ran.error().message, "the driver ended before its jobs: no scheduler there");
}

TEST_F(RunDriver, RefusesALineThatIsNoResult) {
  const Status ran = run(1, shell_driver("echo hello"));
  ASSERT_FALSE(ran);
  EXPECT_EQ(ran.error().code, Errc::corrupt);
}

TEST_F(RunDriver, SaysThatAProgramIsNotThere) {
  const Status ran = run(1, {"no-such-driver"});
  ASSERT_FALSE(ran);
  EXPECT_NE(ran.error().message.find("no-such-driver: cannot be started"), std::string::npos);
}

TEST_F(RunDriver, EndsTheDriverWhenItIsNotToGoOn) {
  goes_on_ = false;
  EXPECT_TRUE(run(1, {"sleep", "1000"}));
  EXPECT_TRUE(ended_.empty());
}

}  // namespace
}  // namespace proofmass::fleet::driver_test

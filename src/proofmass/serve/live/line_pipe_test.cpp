#include "proofmass/serve/live/line_pipe.hpp"

#include <array>
#include <csignal>
#include <gtest/gtest.h>
#include <string>
#include <thread>
#include <unistd.h>

namespace proofmass::serve::line_pipe_test {
namespace {

class LinePipeTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(::pipe(ends_.data()), 0);
    ::signal(SIGPIPE, SIG_IGN);
  }
  void TearDown() override {
    ::close(ends_[0]);
    ::close(ends_[1]);
  }
  // What a reader finds until the writer's end is closed.
  std::string all(LinePipe& pipe) {
    std::string text;
    std::thread reader([&] {
      std::array<char, 65536> piece{};
      for (ssize_t got = 0; (got = ::read(ends_[0], piece.data(), piece.size())) > 0;)
        text.append(piece.data(), static_cast<std::size_t>(got));
    });
    pipe.drain(60'000);
    ::close(ends_[1]);
    reader.join();
    ends_[1] = ::dup(ends_[0]);
    return text;
  }
  std::array<int, 2> ends_{};
};

TEST_F(LinePipeTest, APipeThatNobodyReadsDelaysNothingAndLosesWholeLines) {
  LinePipe pipe(ends_[1], 100'000);
  const std::string line(999, 'x');
  for (int k = 0; k < 1000; ++k) pipe.write(line);  // a megabyte
  EXPECT_GT(pipe.left_out(), 700U);
  const std::string text = all(pipe);
  ASSERT_EQ(text.size() % 1000, 0U);
  EXPECT_EQ(text.size() / 1000 + pipe.left_out(), 1000U);
  for (std::size_t at = 0; at < text.size(); at += 1000)
    EXPECT_EQ(text.substr(at, 1000), line + "\n");
}

TEST_F(LinePipeTest, NoticesThatNobodyReadsAnyMore) {
  LinePipe pipe(ends_[1]);
  pipe.write("a");
  EXPECT_FALSE(pipe.is_broken());
  ::close(ends_[0]);
  pipe.write("b");
  EXPECT_TRUE(pipe.is_broken());
  ends_[0] = ::dup(ends_[1]);
}

}  // namespace
}  // namespace proofmass::serve::line_pipe_test

#include "proofmass/io/bytes/subprocess.hpp"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace proofmass::io::watched_child_test {
namespace {

struct Heard {
  Status status = Done{};
  std::string text;
};

Heard hear(const std::function<Status(const ByteSink&)>& work, const ChildLimits& limits = {}) {
  Heard heard;
  const ByteTaker take = [&](std::span<const char> bytes) -> Status {
    heard.text.append(bytes.data(), bytes.size());
    return Done{};
  };
  heard.status = run_in_child(work, take, limits);
  return heard;
}

std::size_t open_descriptors() {
  using Entries = std::filesystem::directory_iterator;
  return static_cast<std::size_t>(std::distance(Entries("/proc/self/fd"), Entries()));
}

/// No child remains, running or dead.
bool is_alone() {
  return ::waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD;
}

TEST(Subprocess, HandsOverWhatItSaysInOrder) {
  std::string said;
  for (int k = 0; k < 400'000; ++k) said += std::to_string(k) + ' ';
  const Heard heard = hear([&](const ByteSink& sink) -> Status {
    sink(std::span(said).first(7));
    sink(std::span(said).subspan(7));
    return Done{};
  });
  ASSERT_TRUE(heard.status) << heard.status.error().message;
  EXPECT_EQ(heard.text, said);
}

TEST(Subprocess, PassesItsErrorsOnInOneLine) {
  const Heard heard =
      hear([](const ByteSink&) -> Status { return Error{Errc::too_few_samples, "two\nlines"}; });
  ASSERT_FALSE(heard.status);
  EXPECT_EQ(heard.status.error().code, Errc::too_few_samples);
  EXPECT_EQ(heard.status.error().message, "two lines");
}

TEST(Subprocess, IsOutlivedHoweverItEnds) {
  const auto expect = [](const std::function<Status(const ByteSink&)>& work, Errc code,
                         const std::string& part) {
    ChildLimits limits;
    limits.cpu_s = 1;
    limits.silence_s = 1;
    const Heard heard = hear(work, limits);
    ASSERT_FALSE(heard.status) << part;
    EXPECT_EQ(heard.status.error().code, code) << heard.status.error().message;
    EXPECT_NE(heard.status.error().message.find(part), std::string::npos)
        << heard.status.error().message;
  };
  const std::size_t before = open_descriptors();
  expect(
      [](const ByteSink&) -> Status {
        std::raise(SIGSEGV);
        return Done{};
      },
      Errc::corrupt, "the library that unpacks it stopped");
  expect([](const ByteSink&) -> Status { std::_Exit(0); }, Errc::corrupt, "stopped");
  expect([](const ByteSink&) -> Status { throw std::bad_alloc(); }, Errc::unsupported,
         "needs more than 2048 MiB");
  expect(
      [](const ByteSink& sink) -> Status {
        sink(std::string_view("begun"));
        std::abort();
      },
      Errc::corrupt, "stopped");
  expect(
      [](const ByteSink&) -> Status {
        for (;;) ::pause();
      },
      Errc::corrupt, "gives nothing within 1 s");
  EXPECT_TRUE(is_alone());
  EXPECT_EQ(open_descriptors(), before);
}

TEST(Subprocess, ComputesOnlySoLong) {
  ChildLimits limits;
  limits.cpu_s = 1;
  const Heard heard = hear(
      [](const ByteSink&) -> Status {
        for (;;) (void)::getppid();
      },
      limits);
  ASSERT_FALSE(heard.status);
  EXPECT_NE(heard.status.error().message.find("takes more than 1 s"), std::string::npos)
      << heard.status.error().message;
  EXPECT_TRUE(is_alone());
}

#if !defined(__SANITIZE_ADDRESS__)
TEST(Subprocess, GetsOnlySoMuchMemory) {
  ChildLimits limits;
  limits.memory_bytes = std::size_t{64} << 20;
  const auto take = [](std::size_t bytes) {
    return [bytes](const ByteSink&) -> Status {
      const std::string much(bytes, 'x');
      return much.back() == 'x' ? Status(Done{}) : Error{Errc::corrupt, ""};
    };
  };
  EXPECT_TRUE(hear(take(std::size_t{16} << 20), limits).status);
  const Heard heard = hear(take(std::size_t{128} << 20), limits);
  ASSERT_FALSE(heard.status);
  EXPECT_EQ(heard.status.error().message, "needs more than 64 MiB to unpack");
}
#endif

TEST(Subprocess, IsStoppedWhenNobodyListens) {
  std::size_t taken = 0;
  const auto work = [](const ByteSink& sink) -> Status {
    const std::string piece(1'000, 'x');
    while (sink(piece)) continue;
    return Done{};
  };
  const auto take = [&](std::span<const char>) -> Status {
    if (++taken == 3) return Error{Errc::unsupported, "enough"};
    return Done{};
  };
  const Status done = run_in_child(work, take, {});
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "enough");
  EXPECT_TRUE(is_alone());
}

TEST(Subprocess, WritesToNoneOfTheStandardStreams) {
  testing::internal::CaptureStderr();
  const Heard heard = hear([](const ByteSink&) -> Status {
    return ::write(STDERR_FILENO, "noise", 5) == 5 ? Status(Done{}) : Error{Errc::corrupt, ""};
  });
  EXPECT_TRUE(heard.status);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

Status take_text(std::string_view bytes, std::string& text) {
  const BytePump feed = [&](std::span<char> into) -> Result<std::size_t> {
    const std::size_t count = std::min(into.size(), bytes.size());
    std::memcpy(into.data(), bytes.data(), count);
    bytes.remove_prefix(count);
    return count;
  };
  return take_message(feed, [&](std::span<const char> piece) -> Status {
    text.append(piece.data(), piece.size());
    return Done{};
  });
}

TEST(Message, ThatBreaksOffAnywhereIsRefused) {
  using namespace std::literals;
  const std::string whole = "data\3\0\0\0abcdata\0\0\0\0end \0\0\0\0"s;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::string text;
    const Status taken = take_text(std::string_view(whole).substr(0, size), text);
    ASSERT_FALSE(taken) << size;
    EXPECT_EQ(taken.error().code, Errc::corrupt);
  }
  std::string text;
  EXPECT_TRUE(take_text(whole, text));
  EXPECT_EQ(text, "abc");
}

TEST(Message, BelievesNoLengthAndNoKind) {
  using namespace std::literals;
  std::string text;
  EXPECT_FALSE(take_text("data\xFF\xFF\xFF\xFF"s + std::string(5000, 'x'), text));
  EXPECT_FALSE(take_text("what\1\0\0\0x"s, text));
  const Status steps = take_text("erro\2\0\0\0\x7Fx"s, text);
  ASSERT_FALSE(steps);
  EXPECT_EQ(steps.error().code, Errc::corrupt);  // an invalid error number
  EXPECT_EQ(steps.error().message, "x");
  EXPECT_EQ(text, "");
}

}  // namespace
}  // namespace proofmass::io::watched_child_test

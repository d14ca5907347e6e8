#include <fcntl.h>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

#include "proofmass/acquire/source.hpp"
#include "proofmass/io/write_recording.hpp"

namespace proofmass::acquire::standard_input_test {
namespace {

using namespace std::chrono_literals;

/// Provides a text on standard input during its lifetime.
class Piped {
 public:
  explicit Piped(std::string_view text) : before_(::dup(STDIN_FILENO)) {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::pipe(ends), 0);
    // The capacity of a pipe without a reader is sufficient for these tests.
    EXPECT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
    ::close(ends[1]);
    ::dup2(ends[0], STDIN_FILENO);
    ::close(ends[0]);
  }
  Piped(const Piped&) = delete;
  Piped& operator=(const Piped&) = delete;
  ~Piped() {
    ::dup2(before_, STDIN_FILENO);
    ::close(before_);
  }

 private:
  int before_;
};

TEST(StandardInput, WaitsForWhoeverReadsAndEnds) {
  const Piped input("time (s),x (m/s^2)\n1700000000.25,1\n1700000000.5,2\n1700000000.75,3");
  const auto source = open_source("-", {.patience = 60s}).value();
  EXPECT_FALSE(source->head().is_paced);
  EXPECT_EQ(source->head().recording.channels[0].unit.symbol, "m/s^2");
  EXPECT_EQ(source->head().recording.time.start_ns, 1'700'000'000'250'000'000);
  Arrival arrival;
  ASSERT_EQ(source->read(arrival, 60s).value(), Arrived::rows);
  EXPECT_EQ(arrival.channels[0], (std::vector<double>{1, 2, 3})) << "the last line needs no end";
  EXPECT_EQ(source->read(arrival, 60s).value(), Arrived::ended);
  EXPECT_EQ(source->read(arrival, 60s).value(), Arrived::ended);
}

TEST(StandardInput, TakesWhatProofmassWrites) {
  Recording recording;
  recording.time.source = TimeSource::given_rate;
  recording.time.rate_hz = 100.0;
  for (const char* name : {"acc_x", "acc_y"})
    recording.channels.push_back({name, *parse_unit("g"), {0.1, -0.2, 0.3}});
  const std::string path = testing::TempDir() + "/piped_" + std::to_string(::getpid()) + ".csv";
  ASSERT_TRUE(io::write_recording(recording, path, {}));
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const int before = ::dup(STDIN_FILENO);
  ::dup2(file, STDIN_FILENO);
  const auto source = open_source("stdin:");
  ::dup2(before, STDIN_FILENO);
  ASSERT_TRUE(source) << source.error().message;
  Arrival arrival;
  ASSERT_EQ((*source)->read(arrival, 60s).value(), Arrived::rows);
  EXPECT_EQ(arrival.channels[1], (std::vector<double>{0.1, -0.2, 0.3}));
  EXPECT_EQ(arrival.device_ns, (std::vector<std::int64_t>{0, 10'000'000, 20'000'000}));
  EXPECT_EQ((*source)->head().recording.channels[1].name, "acc_y");
  ::close(file);
  ::close(before);
  ::unlink(path.c_str());
}

TEST(StandardInput, SaysWhatCameInstead) {
  const Piped input("no figures here\nnor here\n");
  const auto source = open_source("-", {.patience = 60s});
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().message.find("nor here"), std::string::npos);
}

TEST(StandardInput, ThatIsEmptyIsNoRecording) {
  const Piped input("");
  const auto source = open_source("-", {.patience = 60s});
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().message.find("ended before anything came"), std::string::npos);
}

}  // namespace
}  // namespace proofmass::acquire::standard_input_test

#include <algorithm>
#include <atomic>
#include <chrono>
#include <gtest/gtest.h>
#include <thread>

#include "proofmass/acquire/recorder/record_test_support.hpp"
#include "proofmass/acquire/stream/scripted_source_test_support.hpp"

// The analysis on its own thread, alongside the recording.
namespace proofmass::acquire::record_analysis_test {
namespace {

using namespace std::chrono_literals;

/// False: the condition did not hold within a minute.
bool comes_about(const auto& is_so) {
  const auto until = std::chrono::steady_clock::now() + 60s;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > until) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

/// Doubles the samples, and runs a callback before each block.
class Slow final : public LiveAnalysis {
 public:
  explicit Slow(std::function<void(std::size_t first)> before) : before_(std::move(before)) {}
  [[nodiscard]] const std::vector<Channel>& columns() const override { return doubler_.columns(); }
  [[nodiscard]] Status add(const Block& samples, Rows& out) override {
    before_(samples.first);
    return doubler_.add(samples, out);
  }
  [[nodiscard]] Status finish(Rows& out) override { return doubler_.finish(out); }
  [[nodiscard]] std::vector<Note> take_notes() override { return doubler_.take_notes(); }

 private:
  std::function<void(std::size_t)> before_;
  Doubler doubler_{1'000'000'000};
};

MakeAnalysis slow(std::function<void(std::size_t first)> before) {
  return [before = std::move(before)](const SourceHead&) -> Result<std::unique_ptr<LiveAnalysis>> {
    return std::unique_ptr<LiveAnalysis>(std::make_unique<Slow>(before));
  };
}

/// A source with its own pace, slow enough that a busy machine loses no rows of it.
struct Paced {
  std::atomic<std::uint64_t> seen = 0;  ///< rows received by the recording
  Script script(std::size_t count, std::size_t rows) {
    Script out{.acts = arrivals(count, {.rows = rows}), .is_paced = true};
    out.value = [this, rows](std::uint64_t row, std::size_t channel) {
      if (row % rows == 0) (void)comes_about([&] { return row <= seen + 20 * rows; });
      return 1000.0 * static_cast<double>(channel) + static_cast<double>(row);
    };
    return out;
  }
  RecordWatch watch() {
    return {.samples = [this](const Block& block) { seen += block.rows(); }};
  }
};

std::uint64_t left_out_of(const RecordSummary& summary) {
  for (const RecordEvent& event : summary.events)
    if (event.text.ends_with("were left out of the estimates, as their analysis was too slow"))
      return std::stoull(event.text);
  return 0;
}

/// Checks that estimates are twice the samples of their time, each once and in order.
void expect_doubled(const Recording& estimates) {
  for (std::size_t k = 0; k < estimates.samples(); ++k)
    ASSERT_NEAR(estimates.channels[0].values[k], 200.0 * estimates.time.at(k), 1e-6) << k;
  EXPECT_TRUE(std::ranges::is_sorted(estimates.channels[0].values));
}

TEST(RecordAnalysis, HoldsUpNobodyWhileItTakesLong) {
  const TestFolder folder;
  Paced source;
  bool saw_the_end = false;
  const auto waits_for_the_end = [&](std::size_t first) {
    if (first == 500) saw_the_end = comes_about([&] { return source.seen == 4000; });
  };
  const auto summary =
      record(open_scripts({source.script(400, 10)}), {.path = folder.file("run.mcap")},
             source.watch(), slow(waits_for_the_end));
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_TRUE(saw_the_end) << "rows go to the file while the analysis is at work";
  EXPECT_EQ(summary->samples, 4000u);
  EXPECT_EQ(summary->lost, 0u);
  EXPECT_TRUE(summary->events.empty()) << summary->events.front().text;
  EXPECT_EQ(read_back(folder.file("run.mcap")).samples(), 4000u);
  const Recording estimates = read_back(folder.file("run.mcap"), "estimates");
  EXPECT_EQ(estimates.samples(), 4000u);
  expect_doubled(estimates);
}

TEST(RecordAnalysis, IsLeftOutWhereTooMuchWaitsForItAndTheFileIsNot) {
  const TestFolder folder;
  Paced source;
  const auto waits_for_the_end = [&](std::size_t first) {
    if (first == 0) (void)comes_about([&] { return source.seen == 40'000; });
  };
  const auto summary = record(open_scripts({source.script(400, 100)}),
                              {.path = folder.file("run.mcap"), .queue_bytes = 400'000},
                              source.watch(), slow(waits_for_the_end));
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->samples, 40'000u);
  EXPECT_EQ(summary->lost, 0u);
  ASSERT_EQ(summary->events.size(), 2u);
  EXPECT_NE(summary->events[0].text.find("not of the recording"), std::string::npos);
  const Recording estimates = read_back(folder.file("run.mcap"), "estimates");
  EXPECT_EQ(estimates.samples() + left_out_of(*summary), 40'000u);
  // Two channels and a stamp of eight bytes each are queued.
  EXPECT_NEAR(static_cast<double>(estimates.samples()), 400'000.0 / 24.0, 1000.0);
  expect_doubled(estimates);
}

TEST(RecordAnalysis, TakesItsSamplesUpAgainBehindThoseLeftOut) {
  const TestFolder folder;
  Paced source;
  const auto waits_at_first = [&](std::size_t first) {
    if (first == 0) (void)comes_about([&] { return source.seen >= 30'000; });
  };
  Script script = source.script(400, 100);
  const auto paced = script.value;
  std::atomic<std::uint64_t> estimated = 0;
  // Rows from 35 000 on arrive when the analysis has caught up.
  script.value = [&](std::uint64_t row, std::size_t channel) {
    if (row == 35'000) (void)comes_about([&] { return estimated > 10'000; });
    return paced(row, channel);
  };
  RecordWatch watch = source.watch();
  watch.estimates = [&](const Block& rows) { estimated += rows.rows(); };
  const auto summary =
      record(open_scripts({script}), {.path = folder.file("run.mcap"), .queue_bytes = 400'000},
             watch, slow(waits_at_first));
  ASSERT_TRUE(summary) << summary.error().message;
  const Recording estimates = read_back(folder.file("run.mcap"), "estimates");
  EXPECT_EQ(estimates.samples() + left_out_of(*summary), 40'000u);
  EXPECT_EQ(estimates.channels[0].values.back(), 2.0 * 39'999.0);
  EXPECT_GT(left_out_of(*summary), 10'000u);
  expect_doubled(estimates);
}

TEST(RecordAnalysis, IsNotWaitedForLongByWhoeverStops) {
  const TestFolder folder;
  Paced source;
  Script script = source.script(200, 10);
  script.acts.push_back({.kind = Act::Kind::nothing, .wait_s = 1000.0});
  RecordWatch watch = source.watch();
  watch.stopped = [&] { return source.seen == 2000; };
  const auto summary =
      record(open_scripts({script}), {.path = folder.file("run.mcap"), .catch_up_s = 0.2}, watch,
             slow([](std::size_t) { std::this_thread::sleep_for(50ms); }));
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->end, RecordEnd::stopped);
  EXPECT_EQ(summary->samples, 2000u);
  EXPECT_GT(left_out_of(*summary), 0u);
  const Recording estimates = read_back(folder.file("run.mcap"), "estimates");
  EXPECT_EQ(estimates.samples() + left_out_of(*summary), 2000u);
}

TEST(RecordAnalysis, OfChannelsThatAreGoneIsFinishedInTheirFile) {
  const TestFolder folder;
  Paced source;
  Script first = source.script(20, 10);
  first.acts.push_back({.kind = Act::Kind::fail});
  Script second = source.script(20, 10);
  second.channels = 3;
  const auto summary =
      record(open_scripts({first, second}), {.path = folder.file("run.mcap"), .reconnect = true},
             source.watch(), slow([](std::size_t) { std::this_thread::sleep_for(5ms); }));
  ASSERT_TRUE(summary) << summary.error().message;
  ASSERT_EQ(summary->files.size(), 2u);
  for (const std::string& file : summary->files)
    EXPECT_EQ(read_back(file, "estimates").samples(), 200u) << file;
}

TEST(RecordAnalysis, EndsWithARecordingThatCannotBegin) {
  const TestFolder folder;
  const auto refused = record(open_scripts({{.acts = arrivals(3)}}),
                              {.path = folder.file("no/a.mcap")}, {}, doubled);
  EXPECT_EQ(refused.error().code, Errc::unwritable);
}

}  // namespace
}  // namespace proofmass::acquire::record_analysis_test

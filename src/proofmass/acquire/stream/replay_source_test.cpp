// The replayed data equal the file.
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>

#include "proofmass/acquire/recorder.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/acquire/stream/scripted_source_test_support.hpp"
#include "proofmass/io/read_recording.hpp"
#include "proofmass/io/write_recording.hpp"

namespace proofmass::acquire::replay_source_test {
namespace {

using std::chrono::milliseconds;

std::string scratch(const std::string& name) {
  return (std::filesystem::path(::testing::TempDir()) / ("proofmass_replay_" + name)).string();
}

std::string write(const std::string& name, const std::string& text) {
  std::ofstream(scratch(name), std::ios::binary) << text;
  return scratch(name);
}

std::unique_ptr<Source> open(const std::string& uri) {
  return open_source(uri).value();
}

struct Replayed {
  std::vector<std::vector<double>> channels;
  std::vector<std::int64_t> device_ns;
  std::vector<std::int64_t> host_ns;  ///< arrival of each row
  std::vector<Note> notes;
};

/// All rows; no read returns more than a second.
Replayed gathered(Source& source) {
  Replayed all;
  all.channels.resize(source.head().recording.channels.size());
  Arrival arrival;
  for (;;) {
    const Arrived arrived = source.read(arrival, milliseconds(1000)).value();
    all.notes.insert(all.notes.end(), arrival.notes.begin(), arrival.notes.end());
    if (arrived == Arrived::ended) return all;
    EXPECT_EQ(arrival.rows() > 0, arrived == Arrived::rows);
    EXPECT_EQ(arrival.device_ns.size(), arrival.rows());
    EXPECT_EQ(arrival.lost_before, 0U);
    for (std::size_t c = 0; c < all.channels.size(); ++c)
      all.channels[c].insert(all.channels[c].end(), arrival.channels[c].begin(),
                             arrival.channels[c].end());
    all.device_ns.insert(all.device_ns.end(), arrival.device_ns.begin(), arrival.device_ns.end());
    all.host_ns.insert(all.host_ns.end(), arrival.rows(), arrival.host_ns);
  }
}

/// Bit for bit; NaN equals NaN.
void expect_same(View<double> a, View<double> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    ASSERT_TRUE(a[k] == b[k] || (std::isnan(a[k]) && std::isnan(b[k]))) << k;
}

void expect_replayed(const std::string& path) {
  const Recording whole = io::read_recording(path, {}).value();
  const auto source = open("replay:" + path + "?speed=max");
  const Replayed replayed = gathered(*source);
  ASSERT_EQ(replayed.channels.size(), whole.channels.size());
  for (std::size_t c = 0; c < whole.channels.size(); ++c) {
    EXPECT_EQ(source->head().recording.channels[c].name, whole.channels[c].name);
    EXPECT_EQ(source->head().recording.channels[c].unit, whole.channels[c].unit);
    expect_same(replayed.channels[c], whole.channels[c].values);
  }
  EXPECT_EQ(source->head().recording.time.start_ns, whole.time.start_ns);
  for (std::size_t k = 0; k < whole.samples(); ++k)
    ASSERT_EQ(replayed.device_ns[k], std::llround(whole.time.at(k) * 1e9)) << k;
}

/// Rows of two channels with one NaN, stamped from an epoch.
std::string specimen(std::size_t rows) {
  std::string text = "time (s),Acc_X (g),Supply (V)\n";
  for (std::size_t k = 0; k < rows; ++k) {
    const double x = static_cast<double>(k);
    const double jitter = k % 7 == 3 ? 0.0004 : 0.0;
    text += fmt::format("{:.6f},{},{}\n", 100.0 + 0.01 * x + jitter, std::sin(0.37 * x),
                        k % 11 == 5 ? std::nan("") : 5.0 + 1e-9 * x);
  }
  return text;
}

TEST(ReplaySource, GivesTheFileToTheLastBit) {
  const std::string csv = write("whole.csv", specimen(10'000));
  expect_replayed(csv);
  const Recording recording = io::read_recording(csv, {}).value();
  for (const char* name : {"whole.mcap", "whole.npy", "whole.mat"}) {
    ASSERT_TRUE(io::write_recording(recording, scratch(name)));
    expect_replayed(scratch(name));
  }
}

TEST(ReplaySource, GivesALargeFileAsItGivesASmallOne) {
  Recording large;
  large.time.source = TimeSource::given_rate;
  large.time.rate_hz = 48'000.0;
  const auto value = [](std::size_t row) { return 1e-3 * static_cast<double>(row % 977); };
  for (const char* name : {"Acc_X", "Acc_Y", "Acc_Z"}) {
    Channel channel{name, *parse_unit("g"), {}};
    for (std::size_t k = 0; k < 3'000'000; ++k) channel.values.edit().push_back(value(k));
    large.channels.push_back(std::move(channel));
  }
  ASSERT_TRUE(io::write_recording(large, scratch("large.npy")));
  const auto source = open("replay:" + scratch("large.npy") + "?speed=max&rate=48000");
  Arrival arrival;
  std::size_t row = 0;
  std::size_t wrong = 0;
  while (source->read(arrival, milliseconds(0)).value() == Arrived::rows) {
    EXPECT_LE(arrival.rows(), 4800U);
    for (std::size_t k = 0; k < arrival.rows(); ++k, ++row) {
      const auto time_ns = std::llround(static_cast<double>(row) / 48'000.0 * 1e9);
      if (arrival.channels.back()[k] != value(row) || arrival.device_ns[k] != time_ns) ++wrong;
    }
  }
  EXPECT_EQ(row, large.samples());
  EXPECT_EQ(wrong, 0U);
  std::filesystem::remove(scratch("large.npy"));
}

TEST(ReplaySource, WithoutAPaceWaitsForNothing) {
  const auto source =
      open("replay:" + write("hour.csv", "time (s),x\n0,1\n3600,2\n7200,3\n") + "?speed=max");
  EXPECT_FALSE(source->head().is_paced);
  Arrival arrival;
  EXPECT_EQ(source->read(arrival, milliseconds(0)).value(), Arrived::rows);
  EXPECT_EQ(arrival.device_ns,
            (std::vector<std::int64_t>{0, 3'600'000'000'000, 7'200'000'000'000}));
}

TEST(ReplaySource, GivesNoRowBeforeItsTime) {
  for (const double speed : {1.0, 10.0}) {
    const auto source =
        open(fmt::format("replay:{}?speed={}", write("short.csv", specimen(40)), speed));
    EXPECT_EQ(source->head().is_paced, speed == 1.0);
    const std::int64_t began_ns = host_now_ns();
    const Replayed replayed = gathered(*source);
    ASSERT_EQ(replayed.device_ns.size(), 40U);
    for (std::size_t k = 0; k < 40; ++k) {
      const auto waited_ns = static_cast<double>(replayed.host_ns[k] - began_ns);
      EXPECT_GE(waited_ns * speed + 1e3, static_cast<double>(replayed.device_ns[k])) << k;
    }
  }
}

TEST(ReplaySource, KeepsAGapOfTheFileAsAGapOfTime) {
  std::string text = "time (s),x\n";
  for (int k = 0; k < 60; ++k)
    text += fmt::format("{:.3f},{}\n", 0.001 * k + (k < 30 ? 0 : 500), k);
  const std::string path = write("gap.csv", text);
  const Replayed all = gathered(*open("replay:" + path + "?speed=max"));
  EXPECT_EQ(all.device_ns[30] - all.device_ns[29], 500'001'000'000);
  const auto source = open("replay:" + path);
  Arrival arrival;
  std::size_t rows = 0;
  while (rows < 30 && source->read(arrival, milliseconds(1000)).value() == Arrived::rows)
    rows += arrival.rows();
  EXPECT_EQ(rows, 30U);
  EXPECT_EQ(source->read(arrival, milliseconds(20)).value(), Arrived::nothing);
  EXPECT_EQ(arrival.rows(), 0U);
}

TEST(ReplaySource, RecordedAgainIsTheFile) {
  const std::string csv = write("again.csv", specimen(3000));
  RecordOptions options;
  const TestFolder folder;
  options.path = folder.file("again.mcap");
  const auto summary =
      record([&] { return open_source("replay:" + csv + "?speed=max"); }, options).value();
  EXPECT_EQ(summary.end, RecordEnd::source_end);
  EXPECT_EQ(summary.lost, 0U);
  const Recording first = io::read_recording(csv, {}).value();
  const Recording again = io::read_recording(options.path, {}).value();
  ASSERT_EQ(again.channels.size(), first.channels.size());
  for (std::size_t c = 0; c < first.channels.size(); ++c) {
    EXPECT_EQ(again.channels[c].name, first.channels[c].name);
    expect_same(again.channels[c].values, first.channels[c].values);
  }
  ASSERT_EQ(again.samples(), first.samples());
  for (std::size_t k = 0; k < first.samples(); ++k)
    ASSERT_NEAR(again.time.at(k), first.time.at(k), 1e-9) << k;
}

TEST(ReplaySource, TellsOfTheLabelsItLeavesOut) {
  const auto source = open(
      "replay:" + write("labels.csv", "t,x,activity\n0,1,up\n1,2,up\n2,3,down\n") + "?speed=max");
  const Replayed replayed = gathered(*source);
  ASSERT_EQ(replayed.notes.size(), 1U);
  EXPECT_EQ(replayed.notes.front().text, "the labels of column activity are not replayed");
}

TEST(ReplaySource, WantsARateWhereTheFileHasNoTime) {
  const std::string path = write("timeless.csv", "x,y\n3,1\n1,2\n2,3\n");
  EXPECT_EQ(open_source("replay:" + path).error().message,
            fmt::format("replay:{}: the file has no times: add rate=HZ", path));
  const Replayed replayed = gathered(*open("replay:" + path + "?rate=1000"));
  EXPECT_EQ(replayed.device_ns, (std::vector<std::int64_t>{0, 1'000'000, 2'000'000}));
}

TEST(ReplaySource, FindsAFileWhoseNameHasAQuestionMark) {
  (void)write("what?.csv", "t,x\n0,1\n1,2\n");
  EXPECT_EQ(gathered(*open("replay:" + scratch("what%3F.csv") + "?speed=max")).device_ns.size(),
            2U);
}

TEST(ReplaySource, RefusesWhatItCannotReplay) {
  const std::string path = write("refused.csv", "t,x\n0,1\n1,2\n");
  EXPECT_EQ(open_source("replay:/nowhere/at.csv").error().code, Errc::unreadable);
  EXPECT_EQ(open_source("replay:/dev/zero").error().code, Errc::invalid_argument);
  EXPECT_EQ(open_source("replay:").error().code, Errc::invalid_argument);
  for (const char* query : {"?speed=0", "?speed=-1", "?speed=fast", "?rate=0", "?loop=yes"})
    EXPECT_EQ(open_source("replay:" + path + query).error().code, Errc::invalid_argument) << query;
}

TEST(ReplaySource, SaysWhatItReplays) {
  const std::string path = write("said.csv", "t,x\n0,1\n1,2\n");
  const SourceHead head = open("replay:" + path + "?speed=2.5")->head();
  EXPECT_EQ(head.recording.source, "replay:" + path + "?speed=2.5");
  EXPECT_EQ(head.settings, (std::vector<std::pair<std::string, std::string>>{
                               {"file", path}, {"file format", "CSV"}, {"speed", "2.5"}}));
  EXPECT_TRUE(head.has_device_clock);
}

}  // namespace
}  // namespace proofmass::acquire::replay_source_test

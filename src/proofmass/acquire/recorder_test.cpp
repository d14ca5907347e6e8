#include "proofmass/acquire/recorder.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>

#include "proofmass/acquire/recorder/record_test_support.hpp"
#include "proofmass/acquire/stream/scripted_source_test_support.hpp"

namespace proofmass::acquire::recorder_test {
namespace {

TEST(Recorder, WritesEveryRowOfASourceAndItReadsBack) {
  const TestFolder folder;
  const std::string path = folder.file("run.mcap");
  const auto summary =
      record(open_scripts({{.acts = arrivals(300)}}), {.path = path, .metadata = {{"who", "I"}}});
  ASSERT_TRUE(summary) << summary.error().message;
  EXPECT_EQ(summary->end, RecordEnd::source_end);
  EXPECT_EQ(summary->samples, 3000u);
  EXPECT_EQ(summary->not_written, 0u);
  EXPECT_EQ(summary->files, std::vector{path});
  EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  const Recording read = read_back(path);
  ASSERT_EQ(read.samples(), 3000u);
  ASSERT_EQ(read.channels.size(), 2u);
  EXPECT_EQ(read.channels[1].name, "acc_y");
  EXPECT_EQ(read.channels[1].unit.symbol, "m/s^2");
  for (std::size_t k = 0; k < 3000; ++k) {
    ASSERT_EQ(read.channels[1].values[k], 1000.0 + static_cast<double>(k));
    ASSERT_NEAR(read.time.at(k), 0.01 * static_cast<double>(k), 1e-9);
  }
  EXPECT_EQ(read.time.start_ns, summary->clock.start_realtime_ns);
  for (const Note& note : read.notes) EXPECT_EQ(note.severity, Severity::info) << note.text;
  EXPECT_NE(all_notes(read).find("who = I"), std::string::npos) << all_notes(read);
}

TEST(Recorder, WaitsForASourceThatGoesWhileItIsOpenedWhereReconnectionIsAskedFor) {
  for (const bool reconnect : {false, true}) {
    const TestFolder folder;
    int tries = 0;
    const OpenSource open =
        [&, script = open_scripts({{.acts = arrivals(3)}})]() -> Result<std::unique_ptr<Source>> {
      if (++tries < 3) return Error{Errc::device, "went"};
      return script();
    };
    std::vector<RecordEvent> reported;
    const RecordWatch watch{.event = [&](const RecordEvent& event) { reported.push_back(event); }};
    const auto summary =
        record(open, {.path = folder.file("run.mcap"), .reconnect = reconnect}, watch);
    ASSERT_EQ(summary.has_value(), reconnect);
    EXPECT_EQ(tries, reconnect ? 3 : 1);
    if (!reconnect) continue;
    EXPECT_EQ(summary->samples, 30u);
    ASSERT_EQ(reported.size(), 1u);
    EXPECT_EQ(reported[0].kind, EventKind::disconnected);
  }
}

TEST(Recorder, KeepsTheOrderOfWhatASourceSays) {
  const TestFolder folder;
  std::vector<RecordEvent> reported;
  const RecordWatch watch{.event = [&](const RecordEvent& event) { reported.push_back(event); }};
  Script script{.acts = arrivals(5)};
  script.acts.push_back({.rows = 10, .lost_before = 3, .notes = {{Severity::info, "a hiccup"}}});
  const auto summary = record(open_scripts({script}), {.path = folder.file("run.mcap")}, watch);
  ASSERT_TRUE(summary);
  ASSERT_EQ(reported.size(), 2u);
  EXPECT_EQ(reported[0].text, "a hiccup");
  EXPECT_EQ(reported[1].kind, EventKind::lost);
  EXPECT_EQ(summary->lost, 3u);
  EXPECT_EQ(summary->gap_count, 1u);
  EXPECT_EQ(summary->gaps.at(0).rows, 3u);
  EXPECT_EQ(summary->events.at(0).text, "a hiccup");
  const Recording read = read_back(folder.file("run.mcap"));
  EXPECT_EQ(read.samples(), 60u);
  EXPECT_NEAR(read.time.at(50), 0.53, 1e-9);
  EXPECT_NE(all_notes(read).find("1 lost (3 rows), 1 note; the first at 0.49 s: a hiccup"),
            std::string::npos)
      << all_notes(read);
}

TEST(Recorder, EndsAtTheDurationToTheRow) {
  const TestFolder folder;
  const auto summary = record(open_scripts({{.acts = arrivals(300)}}),
                              {.path = folder.file("run.mcap"), .duration_s = 1.235});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->end, RecordEnd::duration);
  EXPECT_EQ(summary->samples, 124u);
  EXPECT_EQ(summary->not_written, 0u);
  EXPECT_EQ(read_back(folder.file("run.mcap")).samples(), 124u);
}

TEST(Recorder, StopsWhenItIsToldAndKeepsWhatWasRead) {
  const TestFolder folder;
  std::atomic<std::uint64_t> rows = 0;
  const RecordWatch watch{.stopped = [&] { return rows >= 200; },
                          .samples = [&](const Block& block) { rows += block.rows(); }};
  Script script{.acts = arrivals(20), .is_paced = true};
  script.acts.push_back({.kind = Act::Kind::nothing, .wait_s = 1000.0});
  const auto summary = record(open_scripts({script}), {.path = folder.file("run.mcap")}, watch);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->end, RecordEnd::stopped);
  EXPECT_EQ(read_back(folder.file("run.mcap")).samples(), rows);
}

TEST(Recorder, WritesNothingOverAndSaysWhatToDo) {
  const TestFolder folder;
  const std::string path = folder.file("run.mcap");
  std::ofstream(path) << "precious";
  const auto over = record(open_scripts({{.acts = arrivals(3)}}), {.path = path});
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().code, Errc::invalid_argument);
  EXPECT_NE(over.error().message.find("is there already"), std::string::npos);
  std::filesystem::rename(path, path + ".part");
  const auto part = record(open_scripts({{.acts = arrivals(3)}}), {.path = path});
  ASSERT_FALSE(part);
  EXPECT_NE(part.error().message.find("recover it first: proofmass recover " + path + ".part"),
            std::string::npos)
      << part.error().message;
  std::string kept;
  std::ifstream(path + ".part") >> kept;
  EXPECT_EQ(kept, "precious");
}

TEST(Recorder, SaysWhyItCannotBegin) {
  const TestFolder folder;
  const auto open = open_scripts({});
  EXPECT_EQ(record(open, {.path = folder.file("a.mcap")}).error().code, Errc::device);
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.mcap.part")));
  EXPECT_EQ(record(open, {.path = "-"}).error().code, Errc::invalid_argument);
  EXPECT_EQ(record(open, {.path = "a.mcap", .duration_s = 0.0}).error().code,
            Errc::invalid_argument);
  EXPECT_EQ(record(open_scripts({{.acts = arrivals(3)}}), {.path = folder.file("no/a.mcap")})
                .error()
                .code,
            Errc::unwritable);
}

TEST(Recorder, TurnsOverToNewFilesExactlyInTime) {
  const TestFolder folder;
  for (int session = 0; session < 2; ++session) {
    const auto summary = record(open_scripts({{.acts = arrivals(25)}}),
                                {.path = folder.file("run.mcap"), .rotate_s = 0.955});
    ASSERT_TRUE(summary);
    ASSERT_EQ(summary->files.size(), 3u);
    EXPECT_EQ(summary->samples, 250u);
    EXPECT_EQ(summary->files[2], folder.file(session == 0 ? "run.0003.mcap" : "run.0006.mcap"));
  }
  double next = 0.0;
  std::int64_t start_ns = 0;
  for (const char* name : {"run.0001.mcap", "run.0002.mcap", "run.0003.mcap"}) {
    const Recording read = read_back(folder.file(name));
    ASSERT_EQ(read.samples(), next < 192 ? 96u : 58u);
    EXPECT_EQ(read.channels[0].values.front(), next);
    EXPECT_NEAR(read.duration_s(), 0.01 * static_cast<double>(read.samples() - 1), 1e-9);
    if (next > 0.0) {
      EXPECT_NEAR(static_cast<double>(*read.time.start_ns - start_ns), 0.96e9, 2.0);
    }
    start_ns = *read.time.start_ns;
    next = read.channels[0].values.back() + 1.0;
    for (const Note& note : read.notes) EXPECT_EQ(note.severity, Severity::info) << note.text;
  }
}

TEST(Recorder, TurnsOverByBytes) {
  const TestFolder folder;
  const auto summary = record(open_scripts({{.acts = arrivals(2000)}}),
                              {.path = folder.file("run.mcap"), .rotate_bytes = 200'000});
  ASSERT_TRUE(summary);
  EXPECT_GE(summary->files.size(), 2u);
  std::size_t rows = 0;
  for (const std::string& file : summary->files) {
    EXPECT_LT(std::filesystem::file_size(file), 400'000u);
    rows += read_back(file).samples();
  }
  EXPECT_EQ(rows, 20'000u);
}

/// One at rows 500, 520 and 1500, else zero.
double pulses(std::uint64_t row, std::size_t channel) {
  if (channel == 1) return static_cast<double>(row);
  return row == 500 || row == 520 || row == 1500 ? 1.0 : 0.0;
}

TEST(Recorder, KeepsWhatIsAroundATrigger) {
  const TestFolder folder;
  Script script{.acts = arrivals(200)};
  script.value = pulses;
  const auto summary = record(
      open_scripts({script}),
      {.path = folder.file("run.mcap"),
       .trigger =
           LevelTrigger{.channel = "acc_x", .level = 0.5, .before_s = 0.255, .after_s = 0.505}},
      {}, doubled);
  ASSERT_TRUE(summary);
  const Recording read = read_back(folder.file("run.mcap"));
  // Rows 475 to 570 and 1475 to 1550.
  ASSERT_EQ(read.samples(), 96u + 76u);
  EXPECT_EQ(summary->samples, 172u);
  EXPECT_EQ(summary->not_kept, 2000u - 172u);
  EXPECT_EQ(summary->not_written, 0u);
  EXPECT_EQ(read.channels[1].values.front(), 475.0);
  EXPECT_EQ(read.channels[1].values[95], 570.0);
  EXPECT_EQ(read.channels[1].values[96], 1475.0);
  EXPECT_NEAR(read.time.at(96), 10.0, 1e-9);
  ASSERT_EQ(read.labels.size(), 2u);
  EXPECT_EQ(read.labels[1], (Label{"stretch 2", 96, 171}));
  EXPECT_EQ(summary->gap_count, 0u);
  for (const Note& note : summary->audit) EXPECT_EQ(note.text.find("gap"), std::string::npos);
  EXPECT_EQ(std::ranges::count(summary->events, EventKind::triggered,
                               [](const RecordEvent& event) { return event.kind; }),
            3);
  const Recording estimates = read_back(folder.file("run.mcap"), "estimates");
  ASSERT_EQ(estimates.samples(), 172u);
  EXPECT_EQ(estimates.channels[0].values[96], 0.0);
}

TEST(Recorder, OpensASourceAgainThatIsGone) {
  const TestFolder folder;
  Script first{.acts = arrivals(10)};
  first.acts.push_back({.kind = Act::Kind::fail});
  const auto summary = record(open_scripts({first, {.acts = arrivals(10)}}),
                              {.path = folder.file("run.mcap"), .reconnect = true});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->end, RecordEnd::source_end);
  EXPECT_EQ(read_back(folder.file("run.mcap")).samples(), 200u);
  ASSERT_EQ(summary->events.size(), 2u);
  EXPECT_EQ(summary->events[0].kind, EventKind::disconnected);
  EXPECT_NE(summary->events[0].text.find("the cable is pulled"), std::string::npos);
  EXPECT_EQ(summary->events[1].kind, EventKind::reconnected);
}

TEST(Recorder, CountsOnWhereASourceIsOpenedAgain) {
  const TestFolder folder;
  // By the host's clock the interruption has about 1100 rows; by the count, which continued, 50.
  const auto host_ns = [](std::uint64_t row) {
    return static_cast<std::int64_t>(row) * 10'000'000 + (row >= 100 ? 11'000'000'000 : 0);
  };
  Script first{.acts = arrivals(10),
               .has_device_clock = false,
               .counts_rows = true,
               .rate_hz = 0.0,
               .host_ns = host_ns};
  Script second = first;
  first.acts.push_back({.kind = Act::Kind::fail});
  second.acts.front().uncounted = 50;
  const auto summary =
      record(open_scripts({first, second}), {.path = folder.file("run.mcap"), .reconnect = true});
  ASSERT_TRUE(summary);
  EXPECT_EQ(read_back(folder.file("run.mcap")).samples(), 200u);
  EXPECT_EQ(summary->lost, 50u);
}

TEST(Recorder, BeginsANewFileWhereTheChannelsAreOthers) {
  const TestFolder folder;
  Script first{.acts = arrivals(10)};
  first.acts.push_back({.kind = Act::Kind::fail});
  const auto summary = record(open_scripts({first, {.acts = arrivals(10), .channels = 3}}),
                              {.path = folder.file("run.mcap"), .reconnect = true});
  ASSERT_TRUE(summary);
  ASSERT_EQ(summary->files.size(), 2u);
  EXPECT_EQ(read_back(summary->files[0]).channels.size(), 2u);
  EXPECT_EQ(read_back(summary->files[1]).channels.size(), 3u);
  EXPECT_EQ(read_back(summary->files[1]).samples(), 100u);
}

TEST(Recorder, EndsWhereASourceIsGoneForGood) {
  const TestFolder folder;
  for (const bool reconnect : {false, true}) {
    Script script{.acts = arrivals(10)};
    script.acts.push_back({.kind = Act::Kind::fail});
    const auto summary =
        record(open_scripts({script}), {.path = folder.file(reconnect ? "a.mcap" : "b.mcap"),
                                        .reconnect = reconnect,
                                        .reconnect_for_s = 0.1});
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->end, RecordEnd::source_gone);
    EXPECT_NE(summary->end_reason.find(reconnect ? "is not there" : "the cable is pulled"),
              std::string::npos);
    EXPECT_EQ(summary->samples, 100u);
  }
}

TEST(Recorder, TellsASilenceAndEndsWithALongOne) {
  const TestFolder folder;
  Script script{.acts = arrivals(10), .has_device_clock = false, .is_paced = true};
  script.acts.push_back({.kind = Act::Kind::nothing, .wait_s = 1000.0});
  const auto summary =
      record(open_scripts({script}),
             {.path = folder.file("run.mcap"), .stall_s = 0.2, .stall_end_s = 0.6});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->end, RecordEnd::source_gone);
  ASSERT_GE(summary->events.size(), 2u);
  EXPECT_EQ(summary->events[0].kind, EventKind::stalled);
  EXPECT_NE(summary->end_reason.find("nothing came for"), std::string::npos);
  EXPECT_EQ(summary->samples, 100u);
}

TEST(Recorder, DropsAndCountsWhatAQueueThatIsFullCannotTake) {
  const TestFolder folder;
  Script script{
      .acts = arrivals(2000, {.lost_before = 1}), .has_device_clock = false, .is_paced = true};
  bool waited = false;
  const RecordWatch watch{.samples = [&](const Block&) {
    // A slow observer, until the source has ended.
    if (!waited) std::this_thread::sleep_for(std::chrono::milliseconds(700));
    waited = true;
  }};
  const auto summary = record(open_scripts({script}),
                              {.path = folder.file("run.mcap"), .queue_bytes = 20'000}, watch);
  ASSERT_TRUE(summary);
  EXPECT_GT(summary->overrun, 0u);
  EXPECT_EQ(summary->samples + summary->lost, 22'000u);
  EXPECT_GE(summary->lost, summary->overrun);
  const Recording read = read_back(folder.file("run.mcap"));
  ASSERT_EQ(read.samples(), summary->samples);
  // Time is counted on across lost rows.
  for (std::size_t k = 0; k < read.samples(); ++k)
    ASSERT_NEAR(read.time.at(k), 0.01 * (read.channels[0].values[k] - 1.0), 1e-6);
}

TEST(Recorder, DropsNothingOfASourceThatWaits) {
  const TestFolder folder;
  const RecordWatch watch{
      .samples = [](const Block&) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }};
  const auto summary = record(open_scripts({{.acts = arrivals(300)}}),
                              {.path = folder.file("run.mcap"), .queue_bytes = 10'000}, watch);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->samples, 3000u);
  EXPECT_EQ(summary->lost, 0u);
}

TEST(Recorder, TellsHowLongEstimatesTakeWhereSamplesComeByThemselves) {
  const TestFolder folder;
  const auto summary = record(open_scripts({{.acts = arrivals(30), .is_paced = true}}),
                              {.path = folder.file("run.mcap")}, {}, doubled);
  ASSERT_TRUE(summary);
  ASSERT_TRUE(summary->latency);
  EXPECT_EQ(summary->latency->blocks, 30u);
  EXPECT_GE(summary->latency->worst_s, summary->latency->median_s);
}

TEST(Recorder, PutsEstimatesBesideTheSamples) {
  const TestFolder folder;
  std::size_t seen = 0;
  const RecordWatch watch{.estimates = [&](const Block& rows) {
    EXPECT_EQ(rows.first, seen);
    seen += rows.rows();
  }};
  const auto summary =
      record(open_scripts({{.acts = arrivals(30)}}),
             {.path = folder.file("run.mcap"), .sensor_files = {"[sensor]\n"}}, watch, doubled);
  ASSERT_TRUE(summary);
  EXPECT_EQ(seen, 300u);
  EXPECT_FALSE(summary->latency) << "the source waits: a full queue is no latency";
  const Recording read = read_back(folder.file("run.mcap"));
  EXPECT_EQ(read.channels.size(), 2u) << "the samples, not the estimates, are read";
  EXPECT_NE(all_notes(read).find("sensor.toml"), std::string::npos);
  const Recording estimates = read_back(folder.file("run.mcap"), "estimates");
  ASSERT_EQ(estimates.samples(), 300u);
  EXPECT_EQ(estimates.channels[0].values[7], 14.0);
}

TEST(Recorder, KeepsEachOfSeveralSensorFiles) {
  const TestFolder folder;
  const auto summary =
      record(open_scripts({{.acts = arrivals(3)}}),
             {.path = folder.file("run.mcap"), .sensor_files = {"[sensor]\n", "[bias]\n"}});
  ASSERT_TRUE(summary);
  const std::string notes = all_notes(read_back(folder.file("run.mcap")));
  EXPECT_NE(notes.find("\"sensor.1.toml\", 9 bytes"), std::string::npos) << notes;
  EXPECT_NE(notes.find("\"sensor.2.toml\", 7 bytes"), std::string::npos) << notes;
}

TEST(Recorder, GoesOnWithoutAnAnalysisThatFails) {
  const TestFolder folder;
  const auto failing = [](const SourceHead&) -> Result<std::unique_ptr<LiveAnalysis>> {
    return std::unique_ptr<LiveAnalysis>(std::make_unique<Doubler>(55));
  };
  const auto summary = record(open_scripts({{.acts = arrivals(30)}}),
                              {.path = folder.file("run.mcap")}, {}, failing);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->samples, 300u);
  ASSERT_EQ(summary->events.size(), 1u);
  EXPECT_EQ(summary->events[0].text, "the estimates end here: it has had enough");
}

TEST(Recorder, ClosesAFileInWhichThereIsNothing) {
  const TestFolder folder;
  const auto summary = record(open_scripts({{.acts = {}}}), {.path = folder.file("run.mcap")});
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->samples, 0u);
  EXPECT_TRUE(std::filesystem::exists(folder.file("run.mcap")));
}

TEST(Recorder, HasWhatCameInAPartThatCanBeRead) {
  const TestFolder folder;
  const std::string part = folder.file("run.mcap.part");
  bool is_there = false;
  int asked = 0;
  Script script{.acts = arrivals(20), .has_device_clock = false, .is_paced = true};
  script.acts.push_back({.kind = Act::Kind::nothing, .wait_s = 1000.0});
  const RecordWatch watch{.stopped = [&] {
    if (++asked % 4 != 0) return false;
    const auto read = io::read_recording(part, {});
    is_there = read && read->samples() == 200;
    return is_there || asked > 2000;
  }};
  const auto summary = record(open_scripts({script}), {.path = folder.file("run.mcap")}, watch);
  ASSERT_TRUE(summary);
  EXPECT_TRUE(is_there);
}

TEST(Recorder, ReadsBackBitForBitWhatIsNoNumber) {
  const TestFolder folder;
  Script script{.acts = arrivals(10)};
  script.value = [](std::uint64_t row, std::size_t) {
    if (row % 7 == 0) return std::numeric_limits<double>::quiet_NaN();
    return row % 11 == 0 ? std::numeric_limits<double>::infinity() : 1e-310;
  };
  ASSERT_TRUE(record(open_scripts({script}), {.path = folder.file("run.mcap")}));
  const Recording read = read_back(folder.file("run.mcap"));
  ASSERT_EQ(read.samples(), 100u);
  EXPECT_TRUE(std::isnan(read.channels[0].values[7]));
  EXPECT_TRUE(std::isinf(read.channels[0].values[11]));
  EXPECT_EQ(read.channels[0].values[12], 1e-310);
}

}  // namespace
}  // namespace proofmass::acquire::recorder_test

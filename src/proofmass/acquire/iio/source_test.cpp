#include "proofmass/acquire/source.hpp"

#include <algorithm>
#include <gtest/gtest.h>

#include "proofmass/acquire/iio/fake_iiod_test_support.hpp"

// libiio itself with a simulated board.
namespace proofmass::acquire::iio_source_test {
namespace {

using namespace std::chrono_literals;

constexpr double scale = 0.009806;  // scale of the board, m/s² per count

std::string setting(const SourceHead& head, std::string_view key) {
  const auto found =
      std::ranges::find(head.settings, key, &std::pair<std::string, std::string>::first);
  return found == head.settings.end() ? "(none)" : found->second;
}

// The values of `count` rows, or the error. Waits as long as it takes.
Result<Arrival> gather(Source& source, std::size_t count) {
  Arrival all, piece;
  all.clear(source.head().recording.channels.size());
  while (all.rows() < count) {
    const auto arrived = source.read(piece, 1000ms);
    if (!arrived) return arrived.error();
    if (*arrived == Arrived::ended) break;
    for (std::size_t k = 0; k < all.channels.size(); ++k)
      std::ranges::copy(piece.channels[k], std::back_inserter(all.channels[k]));
    std::ranges::copy(piece.device_ns, std::back_inserter(all.device_ns));
    std::ranges::copy(piece.notes, std::back_inserter(all.notes));
    all.lost_before += piece.lost_before;
    all.host_ns = piece.host_ns;
  }
  return all;
}

// This machine stalls: only waits that must time out have a short limit.
const OpenOptions patient{.patience = 60s, .stopped = {}};
const OpenOptions impatient{.patience = 3s, .stopped = {}};

std::string opening_error(const FakeIiod& board,
                          const std::string& query = "",
                          const OpenOptions& options = patient) {
  const auto source = open_source(board.uri() + query, options);
  return source ? "it opened" : source.error().message;
}

TEST(IioSource, BringsEachRowOnceInMetresPerSecondSquaredAndTheBoardsAxes) {
  const FakeIiod board({});
  const auto source = open_source(board.uri(), patient);
  ASSERT_TRUE(source) << source.error().message;
  const Arrival rows = gather(**source, 100).value();
  ASSERT_EQ((*source)->head().recording.channels.size(), 3U);
  EXPECT_EQ((*source)->head().recording.channels[0].name, "accel_x");
  EXPECT_EQ((*source)->head().recording.channels[0].unit.quantity, Quantity::acceleration);
  for (std::size_t k = 0; k < rows.rows(); ++k) {
    // The chip's x is k and its y is -k counts; on the board x is the chip's y, and y its -x.
    ASSERT_NEAR(rows.channels[0][k], -scale * static_cast<double>(k), 1e-9);
    ASSERT_NEAR(rows.channels[1][k], -scale * static_cast<double>(k), 1e-9);
    ASSERT_NEAR(rows.channels[2][k], scale * 1000.0, 1e-9);
    ASSERT_EQ(rows.device_ns[k],
              1'000'000'000'000'000'000 + static_cast<std::int64_t>(k) * 10'000'000);
  }
  EXPECT_EQ(rows.lost_before, 0U);
  EXPECT_TRUE(rows.notes.empty());
  EXPECT_GT(rows.host_ns, 0);
  EXPECT_TRUE((*source)->head().has_device_clock);
}

TEST(IioSource, SaysWhatWasAskedAndWhatWasGranted) {
  const FakeIiod board({});
  const auto source = open_source(board.uri() + "?trigger=t0&rate=400", patient);
  ASSERT_TRUE(source) << source.error().message;
  const SourceHead& head = (*source)->head();
  EXPECT_EQ(head.recording.time.rate_hz, 400.0);
  EXPECT_EQ(setting(head, "device"), "faux3d");
  EXPECT_EQ(setting(head, "trigger"), "t0");
  EXPECT_EQ(setting(head, "rate asked"), "400 Hz");
  EXPECT_EQ(setting(head, "rate granted"), "400 Hz, by t0");
  EXPECT_EQ(setting(head, "rate of the device itself"), "400 Hz");
  EXPECT_EQ(setting(head, "clock"), "monotonic");
  EXPECT_EQ(setting(head, "timestamps"), "the device's");
  EXPECT_EQ(setting(head, "mount matrix of accel_*"), "0, 1, 0; -1, 0, 0; 0, 0, 1");
}

TEST(IioSource, LeavesTheMountMatrixOutWhereAnAxisIsMissing) {
  const FakeIiod board({});
  const auto source = open_source(board.uri() + "?channels=accel_x,accel_z", patient);
  ASSERT_TRUE(source) << source.error().message;
  const Arrival rows = gather(**source, 10).value();
  EXPECT_NEAR(rows.channels[0][9], scale * 9.0, 1e-9);
  ASSERT_EQ((*source)->head().recording.notes.size(), 1U);
  EXPECT_NE((*source)->head().recording.notes[0].text.find("axes are the chip's"),
            std::string::npos);
}

TEST(IioSource, RefusesARateThatTheTriggerDoesNotTake) {
  const FakeIiod board({});
  EXPECT_NE(opening_error(board, "?rate=9999").find("rate=9999: t0 refuses it (Invalid argument)"),
            std::string::npos);
}

TEST(IioSource, KnowsDeadTimestamps) {
  for (const char* const stamps : {"zero", "stuck"}) {
    const FakeIiod board({"--stamps", stamps});
    const auto source = open_source(board.uri(), patient);
    ASSERT_TRUE(source) << source.error().message;
    const SourceHead& head = (*source)->head();
    EXPECT_FALSE(head.has_device_clock);
    EXPECT_EQ(setting(head, "timestamps"), "dead");
    EXPECT_EQ(head.recording.time.rate_hz, 100.0);
    ASSERT_EQ(head.recording.notes.size(), 1U);
    EXPECT_NE(head.recording.notes[0].text.find("timestamps are dead"), std::string::npos);
    EXPECT_TRUE(gather(**source, 10).value().device_ns.empty());
  }
}

TEST(IioSource, TellsStampsThatGoBack) {
  const FakeIiod board({"--stamps", "back", "--rate", "1000"});
  const auto source = open_source(board.uri(), patient);
  ASSERT_TRUE(source) << source.error().message;
  const Arrival rows = gather(**source, 200).value();
  ASSERT_FALSE(rows.notes.empty());
  EXPECT_EQ(rows.notes[0].text, "the device's stamps stepped back 1 times, by 0.004 s here");
}

TEST(IioSource, SaysThatTheDeviceRefusesTheTrigger) {
  const FakeIiod board({"--fault", "refuse"});
  EXPECT_NE(
      opening_error(board, "?trigger=t0").find("faux3d refuses the trigger t0 (Invalid argument)"),
      std::string::npos);
  const std::string unasked = opening_error(board, "", impatient);
  EXPECT_NE(unasked.find("no trigger fires: faux3d has none, and refuses t0: Invalid argument"),
            std::string::npos)
      << unasked;
}

TEST(IioSource, LeavesATriggerThatIsSetAsItIs) {
  const FakeIiod board({"--fault", "held"});
  for (const char* const query : {"", "?trigger=t0"}) {
    const auto source = open_source(board.uri() + query, patient);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ(setting((*source)->head(), "trigger"), "t0");
  }
}

TEST(IioSource, SaysThatNoTriggerFires) {
  const FakeIiod silent({"--fault", "silent"});
  EXPECT_NE(
      opening_error(silent, "", impatient).find("no sample comes: the trigger t0 does not fire"),
      std::string::npos);
  const FakeIiod bare({"--fault", "bare"});
  EXPECT_NE(
      opening_error(bare, "", impatient).find("no trigger fires: faux3d has none; give it one"),
      std::string::npos);
}

TEST(IioSource, SaysThatSomebodyElseReads) {
  const FakeIiod board({"--fault", "busy"});
  EXPECT_NE(opening_error(board).find("another program reads it"), std::string::npos);
}

TEST(IioSource, SaysThatNobodyAnswers) {
  const FakeIiod mute({"--fault", "mute"});
  EXPECT_NE(opening_error(mute, "", impatient).find("waited 3 s for an answer"), std::string::npos);
  const FakeIiod board({});
  const auto dead = open_source("iio:ip:127.0.0.1:1", patient);
  ASSERT_FALSE(dead);
  EXPECT_EQ(dead.error().code, Errc::device);
  EXPECT_NE(dead.error().message.find("no board there (Connection refused)"), std::string::npos)
      << dead.error().message;
}

TEST(IioSource, GivesUpWhenItIsTold) {
  const FakeIiod mute({"--fault", "mute"});
  const auto source = open_source(mute.uri(), {.patience = 600s, .stopped = [] { return true; }});
  ASSERT_FALSE(source);
  EXPECT_NE(source.error().message.find("stopped before the first sample"), std::string::npos);
}

TEST(IioSource, TakesShortBuffers) {
  const FakeIiod board({"--fault", "short"});
  const auto source = open_source(board.uri(), patient);
  ASSERT_TRUE(source) << source.error().message;
  const Arrival rows = gather(**source, 20).value();
  // Buffers hold 8 rows, of which 4 arrive.
  EXPECT_NEAR(rows.channels[0][3], -scale * 3.0, 1e-9);
  EXPECT_NEAR(rows.channels[0][4], -scale * 8.0, 1e-9);
}

TEST(IioSource, LeavesAndTellsBytesThatAreNoWholeRow) {
  const FakeIiod board({"--fault", "ragged"});
  const auto source = open_source(board.uri(), patient);
  ASSERT_TRUE(source) << source.error().message;
  const Arrival rows = gather(**source, 4).value();
  ASSERT_FALSE(rows.notes.empty());
  EXPECT_EQ(rows.notes[0].text,
            "a buffer of the device ended within a row: 5 bytes of 16 are left out");
}

TEST(IioSource, EndsWithWordsWhereANumberWasDue) {
  const FakeIiod board({"--fault", "garbage"});
  EXPECT_NE(opening_error(board).find("reading its buffer failed"), std::string::npos);
}

TEST(IioSource, GivesAllThatCameBeforeTheBoardDied) {
  const FakeIiod board({"--fault", "dead", "--after", "40"});
  const auto source = open_source(board.uri(), patient);
  ASSERT_TRUE(source) << source.error().message;
  EXPECT_EQ(gather(**source, 40).value().rows(), 40U);
  const auto gone = gather(**source, 1);
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, Errc::device);
  EXPECT_NE(gone.error().message.find("faux3d: the board is gone"), std::string::npos);
}

TEST(IioSource, KeepsItsTimeWhileTheBoardHangsAndCanBeClosed) {
  const FakeIiod board({"--fault", "hang", "--after", "16"});
  const auto began = std::chrono::steady_clock::now();
  {
    const auto source = open_source(board.uri(), patient);
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ(gather(**source, 16).value().rows(), 16U);
    Arrival arrival;
    EXPECT_EQ((*source)->read(arrival, 10ms).value(), Arrived::nothing);
  }
  // libiio itself would wait for two minutes.
  EXPECT_LT(std::chrono::steady_clock::now() - began, 60s);
}

TEST(IioSource, HoldsTheBoardForGoneWhenItHangs) {
  // Duration of the timed-out wait: short, unless the machine is too busy for the board to reply by
  // then.
  std::string before;
  for (const auto patience : {3s, 15s, 60s}) {
    const FakeIiod board({"--fault", "hang", "--after", "16"});
    const auto source = open_source(board.uri(), {.patience = patience, .stopped = {}});
    if (!source) {
      before = source.error().message;
      continue;
    }
    const auto rows = gather(**source, 16);
    if (!rows) {
      before = rows.error().message;
      continue;
    }
    EXPECT_EQ(rows->rows(), 16U);
    const auto gone = gather(**source, 1);
    ASSERT_FALSE(gone);
    EXPECT_NE(gone.error().message.find("does not answer"), std::string::npos);
    return;
  }
  FAIL() << "nothing came before it hung: " << before;
}

TEST(IioSource, RefusesAnAddressThatIsNone) {
  EXPECT_EQ(open_source("iio:somewhere").error().code, Errc::invalid_argument);
  EXPECT_EQ(open_source("iio:ip:127.0.0.1?rte=200").error().code, Errc::invalid_argument);
  EXPECT_EQ(open_source("iio:ip:127.0.0.1?rate=fast").error().code, Errc::invalid_argument);
  EXPECT_EQ(open_source("iio:xml:/nowhere.xml").error().code, Errc::device);
}

}  // namespace
}  // namespace proofmass::acquire::iio_source_test

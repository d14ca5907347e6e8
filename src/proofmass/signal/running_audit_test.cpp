#include "proofmass/signal/running_audit.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::signal::running_audit_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::mt19937_64& generator() {
  static std::mt19937_64 random(8);
  return random;
}

double uniform() {
  return std::uniform_real_distribution<double>()(generator());
}

double normal() {
  static std::normal_distribution<double> distribution;
  return distribution(generator());
}

/// A channel of one of several kinds, with odd values, held values and a constant segment.
std::vector<double> some_channel(std::size_t n) {
  const auto character = static_cast<int>(5.0 * uniform());
  const double clip = 1.0 + uniform(), held = uniform() < 0.5 ? 0.0 : uniform();
  const double odd = uniform() < 0.5 ? 0.0 : 0.02 * uniform();
  const double odds[] = {nan, std::numeric_limits<double>::infinity(), 3e34, 1e-45, 0.0};
  std::vector<double> values(n);
  for (std::size_t k = 0; k < n; ++k) {
    const auto t = static_cast<double>(k);
    values[k] = character == 0   ? normal()
                : character == 1 ? std::round(3.0 * normal()) / 7.0
                : character == 2 ? std::clamp(3.0 * std::sin(0.003 * t), -clip, clip)
                : character == 3 ? std::clamp(std::round(900.0 * std::sin(0.01 * t)), -800.0, 800.0)
                                 : -0.01 * t;
    if (k > 0 && uniform() < held) values[k] = values[k - 1];
    if (uniform() < odd) values[k] = odds[static_cast<int>(5.0 * uniform())];
  }
  const auto from = static_cast<std::size_t>(uniform() * static_cast<double>(n));
  for (std::size_t k = from; k < std::min(n, from + 300); ++k) values[k] = values[from];
  return values;
}

Recording some_recording(std::size_t n) {
  Recording recording;
  recording.first_line = 2;
  recording.time = {TimeSource::stamps, "t", 100.0, {}, {}};
  if (uniform() < 0.6) {
    double s = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      recording.time.stamps_s.push_back(s);
      s += 0.01 + 1e-4 * normal() + (uniform() < 0.002 ? 0.1 * normal() : 0.0);
    }
  }
  for (const char* name : {"Acc_X", "Acc_Y", "Acc_Z"})
    recording.channels.push_back({name, *parse_unit("m/s^2"), some_channel(n)});
  recording.channels.push_back({"Temp", *parse_unit("degC"), some_channel(n)});
  std::vector<double> counter;
  for (double count = 250.0; counter.size() < n; count += uniform() < 0.01 ? 3.0 : 1.0)
    counter.push_back(std::fmod(count, 65536.0));
  recording.channels.push_back({"counter", *parse_unit("counts"), counter});
  for (std::size_t row = n / 3; row < std::min(n, n / 3 + 3); ++row)
    for (std::size_t c = 0; c < 3; ++c) recording.channels[c].values.edit()[row] = 0.0;
  return recording;
}

Recording head_of(const Recording& recording) {
  Recording head = recording;
  head.time.stamps_s.clear();
  for (Channel& channel : head.channels) channel.values.edit().clear();
  return head;
}

Block block_of(const Recording& recording, std::size_t from, std::size_t rows) {
  Block block;
  block.first = from;
  for (const Channel& channel : recording.channels)
    block.channels.push_back(View<double>(channel.values).subspan(from, rows));
  if (!recording.time.is_uniform())
    block.stamps_s = View<double>(recording.time.stamps_s).subspan(from, rows);
  return block;
}

RecordingAudit audit_in_pieces(const Recording& recording, std::size_t longest) {
  RunningAudit running(head_of(recording));
  for (std::size_t from = 0, rows = 0; from < recording.samples(); from += rows) {
    rows = static_cast<std::size_t>(uniform() * static_cast<double>(longest + 1));
    rows = std::min(rows, recording.samples() - from);
    running.add(block_of(recording, from, rows));
  }
  return running.finish(head_of(recording));
}

void expect_same(const ChannelAudit& a, const ChannelAudit& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.moments.count, b.moments.count);
  EXPECT_EQ(a.moments.mean, b.moments.mean);
  EXPECT_EQ(a.moments.squares, b.moments.squares);
  EXPECT_EQ(a.moments.min, b.moments.min);
  EXPECT_EQ(a.moments.max, b.moments.max);
  EXPECT_EQ(a.lsb, b.lsb);
  EXPECT_EQ(a.nonfinite, b.nonfinite);
  EXPECT_EQ(a.infinite, b.infinite);
  EXPECT_EQ(a.absurd, b.absurd);
  EXPECT_EQ(a.denormal, b.denormal);
  EXPECT_EQ(a.clipping, b.clipping);
  EXPECT_EQ(a.clipped, b.clipped);
  EXPECT_EQ(a.limit_low, b.limit_low);
  EXPECT_EQ(a.limit_high, b.limit_high);
  EXPECT_EQ(a.longest_stuck, b.longest_stuck);
  EXPECT_EQ(a.longest_stuck_start_s, b.longest_stuck_start_s);
}

void expect_same(const RecordingAudit& a, const RecordingAudit& b) {
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.duration_s, b.duration_s);
  ASSERT_EQ(a.channels.size(), b.channels.size());
  for (std::size_t c = 0; c < a.channels.size(); ++c) expect_same(a.channels[c], b.channels[c]);
  EXPECT_EQ(a.timing.jitter_s, b.timing.jitter_s);
  EXPECT_EQ(a.timing.gap_count, b.timing.gap_count);
  ASSERT_EQ(a.timing.gaps.size(), b.timing.gaps.size());
  for (std::size_t k = 0; k < a.timing.gaps.size(); ++k)
    EXPECT_EQ(a.timing.gaps[k].start_s, b.timing.gaps[k].start_s);
  EXPECT_EQ(a.timing.longest_gap.start_s, b.timing.longest_gap.start_s);
  EXPECT_EQ(a.timing.backwards, b.timing.backwards);
  EXPECT_EQ(a.timing.repeated, b.timing.repeated);
  EXPECT_EQ(a.timing.lost, b.timing.lost);
  EXPECT_EQ(a.zero_rows, b.zero_rows);
  EXPECT_EQ(a.zero_row_count, b.zero_row_count);
  ASSERT_EQ(a.notes.size(), b.notes.size());
  for (std::size_t k = 0; k < a.notes.size(); ++k) {
    EXPECT_EQ(a.notes[k].text, b.notes[k].text);
    EXPECT_EQ(a.notes[k].severity, b.notes[k].severity);
  }
}

TEST(RunningAudit, SaysTheSameHoweverTheRecordingIsCut) {
  for (int trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(trial);
    const Recording recording = some_recording(static_cast<std::size_t>(7000.0 * uniform()));
    const RecordingAudit whole = audit(recording);
    for (const std::size_t longest : {1U, 50U, 1024U, 5000U})
      expect_same(audit_in_pieces(recording, longest), whole);
  }
}

TEST(RunningAudit, SaysTheSameInParallel) {
  for (int trial = 0; trial < 4; ++trial) {
    SCOPED_TRACE(trial);
    const Recording recording = some_recording(80'000);
    expect_same(audit_in_pieces(recording, 5000), audit(recording));
  }
}

TEST(RunningAudit, SaysTheSameOfMoreValuesThanItKeeps) {
  Recording recording;
  recording.time.rate_hz = 1000.0;
  std::vector<double> values(600'000);
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = std::clamp(std::round(2000.0 * normal()), -6000.0, 6000.0) * 0.25;
  recording.channels.push_back({"ax", *parse_unit("m/s^2"), std::move(values)});
  const RecordingAudit whole = audit(recording);
  expect_same(audit_in_pieces(recording, 9000), whole);
  EXPECT_NEAR(whole.channels[0].lsb.value(), 0.25, 1e-12);
}

/// Runs of equal values, counted by the definition.
struct PlainRuns {
  std::size_t longest = 0, longest_start = 0, at_max = 0;
};

PlainRuns runs_of(View<double> values) {
  PlainRuns out;
  const double max = *std::ranges::max_element(values);
  for (std::size_t k = 0, end = 0; k < values.size(); k = end) {
    for (end = k + 1; end < values.size() && values[end] == values[k];) ++end;
    if (end - k > out.longest) out.longest_start = k;
    out.longest = std::max(out.longest, end - k);
    if (values[k] == max && end - k >= 3) out.at_max += end - k;
  }
  return out;
}

TEST(RunningAudit, FindsTheLongestRunThatPlainCountingFinds) {
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    Recording recording;
    recording.time.rate_hz = 1.0;
    const double levels = 1.0 + 30.0 * uniform(), held = uniform();
    std::vector<double> values(5000);
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = k > 0 && uniform() < held ? values[k - 1] : std::round(levels * normal());
    recording.channels.push_back({"Acc_X", *parse_unit("m/s^2"), values});
    const ChannelAudit found = audit(recording).channels[0];
    const PlainRuns plain = runs_of(values);
    EXPECT_EQ(found.longest_stuck, plain.longest);
    EXPECT_EQ(found.longest_stuck_start_s, static_cast<double>(plain.longest_start));
  }
}

TEST(RunningAudit, CountsARailThatIsReachedInPieces) {
  Recording recording;
  recording.time.rate_hz = 100.0;
  std::vector<double> values;
  // Each crest is clipped at a higher level than the one before, until the rail is found.
  for (int k = 0; k < 60'000; ++k)
    values.push_back(std::min(0.0002 * k * std::sin(0.01 * k), 5.0) + 20.0);
  recording.channels.push_back({"Acc_X", *parse_unit("m/s^2"), values});
  const RecordingAudit found = audit_in_pieces(recording, 100);
  EXPECT_EQ(found.channels[0].clipped, runs_of(values).at_max);
  EXPECT_GT(found.channels[0].clipped, 9000U);
}

TEST(RunningAudit, IsExactForValuesFarFromZero) {
  Recording recording;
  recording.time.rate_hz = 100.0;
  std::vector<double> values;
  for (int k = 0; k < 1'000'000; ++k) values.push_back(1e9 + (k % 2 == 0 ? 1.0 : -1.0));
  recording.channels.push_back({"x", *parse_unit("m"), std::move(values)});
  const Moments moments = audit(recording).channels[0].moments;
  EXPECT_EQ(moments.mean, 1e9);
  EXPECT_NEAR(moments.std(), std::sqrt(1e6 / (1e6 - 1.0)), 1e-14);
}

TEST(RunningAudit, ListsSoManyGapsAndCountsAll) {
  Recording recording;
  recording.time = {TimeSource::stamps, "t", 100.0, {}, {}};
  std::vector<double> values(most_listed + 12, 1.0);
  for (std::size_t k = 0; k < values.size(); ++k)
    recording.time.stamps_s.push_back(0.03 * static_cast<double>(k) +
                                      (k + 1 == values.size() ? 4.0 : 0.0));
  recording.channels.push_back({"x", *parse_unit("m"), std::move(values)});
  const TimingAudit timing = audit(recording).timing;
  EXPECT_EQ(timing.gaps.size(), most_listed);
  EXPECT_EQ(timing.gap_count, most_listed + 11);
  EXPECT_NEAR(timing.longest_gap.duration_s, 4.03, 1e-9);
}

TEST(RunningAudit, TakesNotesUnitsAndMendedStampsFromTheHeadAtTheEnd) {
  Recording recording = some_recording(100);
  RunningAudit running(head_of(recording));
  running.add(block_of(recording, 0, 100));
  Recording head = head_of(recording);
  head.notes.push_back({Severity::bad, "the file breaks off"});
  head.time.mended_backwards = head.time.mended = 1000;
  head.channels[3].unit = *parse_unit("K");
  // A column that turned out to contain words.
  head.channels.erase(head.channels.begin() + 1);
  const RecordingAudit found = running.finish(head);
  ASSERT_EQ(found.channels.size(), 4U);
  EXPECT_EQ(found.channels[1].name, "Acc_Z");
  EXPECT_EQ(found.channels[1].moments.mean, audit(recording).channels[2].moments.mean);
  EXPECT_EQ(found.channels[2].unit.symbol, "K");
  EXPECT_EQ(found.notes.front().text, "the file breaks off");
  EXPECT_EQ(found.timing.mended, 1000U);
  EXPECT_GE(found.timing.backwards, 1000U);
}

TEST(RunningAudit, OfNothingIsEmpty) {
  RunningAudit running(Recording{});
  running.add(Block{});
  const RecordingAudit found = running.finish(Recording{});
  EXPECT_EQ(found.samples, 0U);
  EXPECT_EQ(found.duration_s, 0.0);
  EXPECT_TRUE(found.notes.empty());
}

}  // namespace
}  // namespace proofmass::signal::running_audit_test

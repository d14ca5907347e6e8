#include "proofmass/signal/audit.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

#include "proofmass/core/random.hpp"
#include "proofmass/signal/audit/value_excerpts.hpp"
#include "proofmass/signal/channel_audit.hpp"

namespace proofmass::signal::audit_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

/// One accelerometer channel at 100 Hz, from a file whose rows begin on line 2.
Recording recording_of(std::vector<double> values) {
  Recording recording;
  recording.time = {TimeSource::given_rate, "", 100.0, {}, {}};
  recording.first_line = 2;
  recording.channels.push_back({"Acc_X", *parse_unit("m/s^2"), std::move(values)});
  return recording;
}

/// The same with one value per stamp.
Recording stamped(std::vector<double> stamps_s, double rate_hz) {
  Recording recording = recording_of(std::vector<double>(stamps_s.size(), 1.0));
  recording.time = {TimeSource::stamps, "t", rate_hz, std::move(stamps_s), {}};
  return recording;
}

std::vector<double> noise(std::size_t count, double std) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, std);
  std::vector<double> out(count);
  for (double& x : out) x = normal(random);
  return out;
}

std::string notes_of(const RecordingAudit& audit) {
  std::string all;
  for (const Note& note : audit.notes) all += note.text + "\n";
  return all;
}

TEST(Audit, CountsWhatIsNoMeasurementAndLeavesItOutOfTheMoments) {
  const RecordingAudit found =
      audit(recording_of({9.0, nan, 11.0, inf, -inf, 3e34, -3e34, 1e-45, 5e-324, 10.0, 0.0}));
  const ChannelAudit& channel = found.channels.at(0);
  EXPECT_EQ(channel.nonfinite, 3u);
  EXPECT_EQ(channel.infinite, 2u);
  EXPECT_EQ(channel.absurd, 2u);
  EXPECT_EQ(channel.denormal, 2u);
  EXPECT_EQ(channel.moments.count, 4u);
  EXPECT_EQ(channel.moments.mean, 7.5);
  EXPECT_EQ(channel.moments.max, 11.0);
  EXPECT_TRUE(found.is_bad());
}

TEST(Audit, SaysWhereTheValuesAre) {
  const std::string notes =
      notes_of(audit(recording_of({9.0, nan, 11.0, 3e34, -3e34, 1.0, 1e-45})));
  EXPECT_NE(notes.find("Acc_X: 1 value missing or no number (NaN) at 0.01 s (line 3)"),
            std::string::npos)
      << notes;
  EXPECT_NE(notes.find("(3e34 and the like) at 0.03 s … 0.04 s (lines 5 … 6)"), std::string::npos)
      << notes;
  EXPECT_NE(notes.find("denormal (as bytes read wrongly are) at 0.06 s (line 8)"),
            std::string::npos)
      << notes;
}

TEST(Audit, OfACleanRecordingHasNothingToSay) {
  const RecordingAudit found = audit(recording_of(noise(5000, 0.1)));
  EXPECT_TRUE(found.notes.empty()) << notes_of(found);
  EXPECT_FALSE(found.is_bad());
  EXPECT_EQ(found.samples, 5000u);
  EXPECT_NEAR(found.duration_s, 49.99, 1e-9);
}

TEST(Lsb, IsTheStepOfTheConverter) {
  for (const double lsb : {0.00333, 1.0, 1.0 / 4096.0, 0.0048828125}) {
    std::vector<double> values = noise(20'000, 3.0 * lsb);
    for (double& x : values) x = std::round(x / lsb) * lsb;
    EXPECT_NEAR(find_lsb(values).value(), lsb, 1e-9 * lsb);
    // Written with few decimals, and with a few off-grid values.
    for (double& x : values) x = std::round(x / (0.02 * lsb)) * 0.02 * lsb;
    values[7] = 0.37 * lsb;
    EXPECT_NEAR(find_lsb(values).value(), lsb, 0.02 * lsb);
  }
}

TEST(Lsb, IsNoneOfAContinuousSeries) {
  EXPECT_FALSE(find_lsb(noise(20'000, 1.0)).has_value());
  EXPECT_FALSE(find_lsb(std::vector<double>(100, 2.5)).has_value());
  EXPECT_FALSE(find_lsb({}).has_value());
}

TEST(Clipping, CountsTheSamplesAtTheRails) {
  std::vector<double> values;
  std::size_t clipped = 0;
  for (int k = 0; k < 5000; ++k) {
    const double x = 3.0 * std::sin(0.01 * k);
    if (std::abs(x) >= 2.0) ++clipped;
    values.push_back(std::clamp(x, -2.0, 2.0));
  }
  const RecordingAudit found = audit(recording_of(values));
  EXPECT_EQ(found.channels[0].clipped, clipped);
  EXPECT_TRUE(found.is_bad());
}

// Noise reaches the limit for one sample or two at a time.
TEST(Clipping, CountsTheSamplesThatPileUpAtALimit) {
  for (const double step : {0.0, 1.0 / 128.0}) {
    std::vector<double> values = noise(5000, 1.0);
    std::size_t clipped = 0;
    for (double& x : values) {
      if (step > 0.0) x = step * std::round(x / step);
      if (x >= 1.875) ++clipped;
      x = std::min(x, 1.875);
    }
    const RecordingAudit found = audit(recording_of(values));
    EXPECT_EQ(found.channels[0].clipping, Clipping::rail) << step;
    EXPECT_EQ(found.channels[0].clipped, clipped);
    EXPECT_EQ(found.channels[0].limit_high, 1.875);
    EXPECT_FALSE(found.channels[0].limit_low.has_value());
  }
}

// Shocks between rests of which the converter shows nothing: the rests are no motion that is held.
TEST(Clipping, IsSeenInShocksBetweenRests) {
  std::vector<double> values(6000, 0.25);
  std::size_t clipped = 0;
  for (std::size_t shock = 0; shock < 15; ++shock) {
    const double omega = 0.3 + 0.06 * static_cast<double>(shock), high = 6.0;
    for (std::size_t k = 0; k < 120; ++k) {
      const double t = static_cast<double>(k);
      const double x = 0.25 + 12.0 * std::exp(-t / 40.0) * std::sin(omega * t);
      values[400 * shock + k] = std::min(std::round(x / 0.03125) * 0.03125, high);
      if (values[400 * shock + k] == high) ++clipped;
    }
  }
  const RecordingAudit found = audit(recording_of(values));
  EXPECT_EQ(found.channels[0].limit_high, 6.0);
  EXPECT_EQ(found.channels[0].clipped, clipped);
}

TEST(Clipping, IsNotSeenInASineOrInAFewLevelsOfNoise) {
  std::vector<double> sine;
  for (int k = 0; k < 5000; ++k) sine.push_back(std::round(1000.0 * std::sin(0.01 * k)));
  EXPECT_EQ(audit(recording_of(sine)).channels[0].clipped, 0u);
  std::vector<double> levels = noise(5000, 0.8);
  for (double& x : levels) x = std::round(x);
  EXPECT_EQ(audit(recording_of(levels)).channels[0].clipped, 0u);
}

/// Coarsely quantised measurements of these levels, each held for 1000 samples, with noise.
std::vector<double> coarse_positions(const std::vector<double>& levels, double step, double std) {
  const std::vector<double> errors = noise(1000 * levels.size(), std);
  std::vector<double> out;
  for (std::size_t k = 0; k < errors.size(); ++k)
    out.push_back(std::round((levels[k / 1000] + errors[k]) / step) * step);
  return out;
}

TEST(Clipping, IsNotSeenInCoarseReadings) {
  constexpr double step = 0.0383;
  for (const double std : {0.05, 0.1, 0.2, 0.4}) {
    // The offset places each level anywhere between two quantisation steps.
    for (int k = 0; k < 10; ++k) {
      const double offset = 0.1 * k * step;
      const RecordingAudit found = audit(recording_of(coarse_positions(
          {9.81 + offset, -9.81 + offset, 0.3, 0.1, -0.2, 0.4}, step, std * step)));
      EXPECT_EQ(found.channels[0].clipped, 0u) << std << " " << k;
      EXPECT_FALSE(found.is_bad());
    }
  }
  for (const double omega : {0.002, 0.01, 0.05, 0.2}) {
    std::vector<double> sine;
    for (int k = 0; k < 9000; ++k)
      sine.push_back(std::round((2.0 * std::sin(omega * k) + 0.011) / step) * step);
    EXPECT_EQ(audit(recording_of(sine)).channels[0].clipped, 0u) << omega;
  }
}

TEST(Clipping, IsSeenInCoarseReadings) {
  constexpr double step = 0.0383, rail = 500.0 * step;
  std::vector<double> values;
  for (int k = 0; k < 9000; ++k)
    values.push_back(std::round(std::clamp(30.0 * std::sin(0.05 * k), -rail, rail) / step) * step);
  const auto at_rail =
      std::ranges::count_if(values, [&](double x) { return std::abs(x) > rail - 0.5 * step; });
  // Except for a visit of one or two samples.
  EXPECT_NEAR(static_cast<double>(audit(recording_of(values)).channels[0].clipped),
              static_cast<double>(at_rail), 2.0);
}

TEST(Clipping, IsNotSeenInAValueThatIsHeldForOnce) {
  std::vector<double> values = noise(2000, 1.0);
  for (std::size_t k = 100; k < 110; ++k) values[k] = 0.5;
  for (std::size_t k = 300; k < 306; ++k) values[k] = 6.0;
  EXPECT_EQ(audit(recording_of(values)).channels[0].clipped, 0u);
}

/// A motion of three alternating amplitudes.
std::vector<double> uneven_motion(double strength) {
  std::vector<double> out;
  for (int k = 0; k < 20'000; ++k) {
    const double t = 0.03 * k;
    out.push_back(strength * (1.0 + 0.6 * std::sin(0.07 * t)) *
                  (std::sin(t) + 0.5 * std::sin(2.3 * t + 1.0)));
  }
  return out;
}

TEST(Clipping, IsSeenBelowNoiseThatWasAddedBehindIt) {
  const std::vector<double> errors = noise(20'000, 0.005);
  std::vector<double> values = uneven_motion(3.0);
  std::size_t at_limit = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::abs(values[k]) >= 2.0) ++at_limit;
    values[k] = std::clamp(values[k], -2.0, 2.0) + errors[k];
  }
  const RecordingAudit found = audit(recording_of(values));
  EXPECT_EQ(found.channels[0].clipping, Clipping::before_noise);
  EXPECT_NEAR(found.channels[0].limit_high.value(), 2.0, 0.001);
  EXPECT_NEAR(found.channels[0].limit_low.value(), -2.0, 0.001);
  EXPECT_NEAR(static_cast<double>(found.channels[0].clipped), static_cast<double>(at_limit),
              0.02 * static_cast<double>(at_limit));
  EXPECT_TRUE(found.is_bad());
  EXPECT_NE(notes_of(found).find("with noise added after it"), std::string::npos);
}

/// Vibration of a broad band, standard deviation 1, below a quarter of a cycle per sample.
std::vector<double> vibration() {
  const std::vector<double> white = noise(20'003, 1.0);
  std::vector<double> out;
  for (std::size_t k = 3; k < white.size(); ++k)
    out.push_back(0.5 * (white[k] + white[k - 1] + white[k - 2] + white[k - 3]));
  return out;
}

TEST(Clipping, IsSeenInVibrationWhoseVisitsAreShort) {
  std::vector<double> errors = noise(20'000, 0.01);
  std::ranges::reverse(errors);  // independent of the vibration, which has the same seed
  std::vector<double> values = vibration();
  ASSERT_EQ(audit(recording_of(values)).channels[0].clipping, Clipping::none);
  std::size_t at_limit = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::abs(values[k]) >= 2.0) ++at_limit;
    values[k] = std::clamp(values[k], -2.0, 2.0) + errors[k];
  }
  const RecordingAudit found = audit(recording_of(values));
  EXPECT_EQ(found.channels[0].clipping, Clipping::before_noise);
  EXPECT_NEAR(found.channels[0].limit_high.value(), 2.0, 0.005);
  EXPECT_NEAR(found.channels[0].limit_low.value(), -2.0, 0.005);
  EXPECT_NEAR(static_cast<double>(found.channels[0].clipped), static_cast<double>(at_limit),
              0.1 * static_cast<double>(at_limit));
}

TEST(Clipping, IsSeenWhereTheRangeBendsTheSignal) {
  const std::vector<double> errors = noise(20'000, 0.002);
  std::vector<double> values = uneven_motion(3.0);
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = 2.0 * std::tanh(values[k] / 2.0) + errors[k];
  const RecordingAudit found = audit(recording_of(values));
  EXPECT_EQ(found.channels[0].clipping, Clipping::soft);
  EXPECT_GT(found.channels[0].limit_high.value(), 0.8);
  EXPECT_LT(found.channels[0].limit_high.value(), 2.0);
  EXPECT_NE(notes_of(found).find("soft clipping"), std::string::npos);
  std::vector<double> free = uneven_motion(3.0);
  for (std::size_t k = 0; k < free.size(); ++k) free[k] += errors[k];
  EXPECT_EQ(audit(recording_of(free)).channels[0].clipping, Clipping::none);
}

TEST(Clipping, IsNotToldFromFlatCrestsThatAreAllAlike) {
  const std::vector<double> errors = noise(20'000, 0.002);
  std::vector<double> values;
  for (std::size_t k = 0; k < errors.size(); ++k)
    values.push_back(std::tanh(2.0 * std::sin(0.03 * static_cast<double>(k))) + errors[k]);
  const RecordingAudit found = audit(recording_of(values));
  EXPECT_EQ(found.channels[0].clipping, Clipping::undetermined);
  EXPECT_EQ(found.channels[0].clipped, 0u);
  EXPECT_FALSE(found.is_bad());
}

TEST(Clipping, IsNotSeenInStrokesAtALimitedAcceleration) {
  std::vector<double> values;
  for (const double top : {1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0})
    for (int k = 0; k < 700; ++k) {
      const auto pulse = [](int t) { return std::clamp(std::min(t, 120 - t) / 10.0, 0.0, 1.0); };
      values.push_back(top * (pulse(k) - pulse(k - 200)));
    }
  const std::vector<double> errors = noise(values.size(), 0.001);
  std::vector<double> coarse = values;
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] += errors[k];
    coarse[k] = std::round(100.0 * values[k]) / 100.0;
  }
  EXPECT_EQ(audit(recording_of(values)).channels[0].clipping, Clipping::none);
  EXPECT_EQ(audit(recording_of(coarse)).channels[0].clipping, Clipping::none);
}

TEST(Excerpts, AreAllOfAShortSeriesAndStretchesOfALongOne) {
  ValueExcerpts excerpts(16 * ValueExcerpts::piece);
  std::vector<double> piece(ValueExcerpts::piece);
  for (int n = 0; n < 16; ++n) {
    std::ranges::fill(piece, n);
    excerpts.add(piece);
  }
  EXPECT_EQ(excerpts.values().size(), 16 * ValueExcerpts::piece);
  EXPECT_EQ(excerpts.share(), 1.0);
  for (int n = 16; n < 40; ++n) {
    std::ranges::fill(piece, n);
    excerpts.add(piece);
  }
  const std::vector<double> kept = excerpts.values();
  EXPECT_EQ(excerpts.share(), 4.0);
  for (std::size_t k = 0; k < 10; ++k) {
    const std::size_t from = k * (ValueExcerpts::piece + 1);
    EXPECT_EQ(kept.at(from), 4.0 * static_cast<double>(k));
    EXPECT_EQ(kept.at(from + ValueExcerpts::piece - 1), 4.0 * static_cast<double>(k));
    EXPECT_TRUE(k == 9 || std::isnan(kept.at(from + ValueExcerpts::piece)));
  }
}

TEST(Audit, NoticesAChannelThatIsStuck) {
  std::vector<double> values = noise(2000, 1.0);
  for (std::size_t k = 500; k < 900; ++k) values[k] = 0.25;
  const RecordingAudit found = audit(recording_of(values));
  EXPECT_EQ(found.channels[0].longest_stuck, 400u);
  EXPECT_DOUBLE_EQ(found.channels[0].longest_stuck_start_s, 5.0);
  EXPECT_NE(notes_of(found).find("one and the same value for 400 samples from 5 s on"),
            std::string::npos)
      << notes_of(found);
}

TEST(Audit, NoticesRowsOfZeros) {
  Recording recording = recording_of(noise(50, 1.0));
  recording.channels.push_back({"Acc_Y", *parse_unit("m/s^2"), noise(50, 1.0)});
  recording.channels.push_back({"Gyr_X", *parse_unit("deg/s"), noise(50, 1.0)});
  recording.channels.push_back({"Temp", *parse_unit("degC"), std::vector<double>(50, 20.0)});
  for (Channel& channel : recording.channels)
    if (channel.name != "Temp") channel.values.edit()[0] = 0.0;
  EXPECT_EQ(audit(recording).zero_rows, (std::vector<std::size_t>{0}));
}

TEST(Timing, FindsGapsRepeatsAndStepsBack) {
  const RecordingAudit found =
      audit(stamped({0.0, 0.1, 0.2, 0.7, 0.8, 0.8, 0.9, 0.85, 0.95, 1.05}, 10.0));
  ASSERT_EQ(found.timing.gaps.size(), 1u);
  EXPECT_DOUBLE_EQ(found.timing.gaps[0].start_s, 0.2);
  EXPECT_DOUBLE_EQ(found.timing.gaps[0].duration_s, 0.5);
  EXPECT_EQ(found.timing.repeated, 1u);
  EXPECT_EQ(found.timing.backwards, 1u);
  EXPECT_TRUE(found.is_bad()) << "time ran backwards, and nobody mended it";
}

TEST(Timing, APauseInWhichNoSampleIsMissingIsNoGap) {
  std::vector<double> stamps_s;
  for (int k = 0; k < 1000; ++k)
    stamps_s.push_back(k >= 400 && k < 450 ? 4.49 + 1e-4 * (k - 449) : 0.01 * k);
  const RecordingAudit found = audit(stamped(stamps_s, 100.0));
  EXPECT_TRUE(found.timing.gaps.empty());
  EXPECT_EQ(found.timing.stalls, 1U);
  EXPECT_NEAR(found.timing.longest_stall_s, 0.5, 0.02);
  EXPECT_NEAR(found.timing.longest_stall_start_s, 3.99, 1e-9);
  EXPECT_NE(notes_of(found).find("stamped late"), std::string::npos) << notes_of(found);
}

TEST(Timing, CountsTheStampsThatAReaderMended) {
  Recording recording = stamped({0.0, 0.1, 0.2, 0.3}, 10.0);
  recording.time.mended = 2;
  recording.time.mended_backwards = 1;
  const RecordingAudit found = audit(recording);
  EXPECT_EQ(found.timing.mended, 2u);
  EXPECT_EQ(found.timing.backwards, 1u);
  EXPECT_FALSE(found.is_bad());
}

TEST(Timing, JitterIsTheSpreadOfTheStepsWithoutTheGaps) {
  const std::vector<double> deviations_s = noise(20'000, 1e-4);
  std::vector<double> stamps_s{0.0};
  for (std::size_t k = 0; k < deviations_s.size(); ++k)
    stamps_s.push_back(stamps_s.back() + 0.01 + deviations_s[k] + (k % 5000 == 4999 ? 3.0 : 0.0));
  const RecordingAudit found = audit(stamped(stamps_s, 100.0));
  EXPECT_NEAR(found.timing.jitter_s.value(), 1e-4, 2e-6);
  EXPECT_EQ(found.timing.gaps.size(), 4u);
}

TEST(Timing, TheRateIsAsUncertainAsTheLineThroughTheStamps) {
  const std::vector<double> errors_s = noise(4000, 1e-3);
  std::vector<double> stamps_s;
  for (std::size_t k = 0; k < errors_s.size(); ++k)
    stamps_s.push_back(0.01 * static_cast<double>(k) + errors_s[k]);
  // For a straight line: the noise of a stamp times the root of 12 / n^3, relative to one second.
  const double expected_hz = 1e-3 / 0.01 * 100.0 * std::sqrt(12.0 / std::pow(4000.0, 3.0));
  // The true rate differs from the line by a few of these, which counts as well.
  const double std_hz = audit(stamped(stamps_s, 100.0)).timing.rate_std_hz.value();
  EXPECT_GT(std_hz, 0.5 * expected_hz);
  EXPECT_LT(std_hz, 3.0 * expected_hz);
  const TimingAudit off = audit(stamped(stamps_s, 100.1)).timing;
  EXPECT_NEAR(off.rate_hz, 100.0, 3.0 * expected_hz) << "a rate that is not the line's is replaced";
  EXPECT_NEAR(off.rate_std_hz.value(), std_hz, expected_hz);
}

// A twentieth of the rows is lost and the stamps jitter by 12 % of a step: every gap has the length
// of the samples that are missing, and none is invented.
TEST(Timing, CountsTheLostRowsOfStampsThatJitter) {
  Random random(5, "lost rows");
  const std::vector<double> jitter_s = noise(8000, 1.2e-3);
  std::vector<double> stamps_s;
  std::size_t lost = 0;
  for (std::size_t k = 0; k < jitter_s.size(); ++k) {
    if (k > 0 && k + 1 < jitter_s.size() && random.uniform() < 0.05)
      ++lost;
    else
      stamps_s.push_back(0.01 * static_cast<double>(k) + jitter_s[k]);
  }
  const TimingAudit found = audit(stamped(stamps_s, 100.0)).timing;
  double missing = 0.0;
  for (const Gap& gap : found.gaps) missing += std::round(100.0 * gap.duration_s) - 1.0;
  EXPECT_EQ(found.gap_count, found.gaps.size());
  EXPECT_NEAR(missing, static_cast<double>(lost), 1.0);
  EXPECT_NEAR(found.rate_hz, 100.0, 0.02);
  std::vector<double> whole_s;
  for (std::size_t k = 0; k < jitter_s.size(); ++k)
    whole_s.push_back(0.01 * static_cast<double>(k) + jitter_s[k]);
  EXPECT_TRUE(audit(stamped(whole_s, 100.0)).timing.gaps.empty());
}

TEST(Timing, OfAUniformBaseHasNoJitter) {
  Recording recording = recording_of({1.0, 2.0, 3.0});
  EXPECT_FALSE(audit(recording).timing.jitter_s.has_value()) << "a given rate says nothing of it";
  recording.time.source = TimeSource::stamps;
  EXPECT_EQ(audit(recording).timing.jitter_s, 0.0);
}

TEST(Timing, CountsLostRowsByThePacketCounter) {
  Recording recording = recording_of(std::vector<double>(40, 1.0));
  std::vector<double> counter;
  for (int k = 0; counter.size() < 40; ++k)
    if (k != 7 && k != 21 && k != 22) counter.push_back(k);
  counter[12] = nan;
  counter[30] = 3e34;
  recording.channels.push_back({"PacketCounter", *parse_unit("counts"), counter});
  EXPECT_EQ(audit(recording).timing.lost, 3u);
  recording.channels[1].name = "Battery";
  EXPECT_FALSE(audit(recording).timing.lost.has_value());
}

}  // namespace
}  // namespace proofmass::signal::audit_test

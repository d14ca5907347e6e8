#include "proofmass/signal/resample.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <numeric>
#include <random>

#include "proofmass/signal/resampler.hpp"

namespace proofmass::signal::resample_test {
namespace {

constexpr double pi = std::numbers::pi;

/// One channel x(t) at `count` even times, or at those given.
template <class Function>
Recording recording_of(Function x, double rate_hz, std::size_t count) {
  Recording out;
  out.time.source = TimeSource::given_rate;
  out.time.rate_hz = rate_hz;
  out.channels.push_back({"x", {}, {}});
  for (std::size_t k = 0; k < count; ++k)
    out.channels[0].values.edit().push_back(x(static_cast<double>(k) / rate_hz));
  return out;
}
template <class Function>
Recording recording_of(Function x, double rate_hz, std::vector<double> stamps_s) {
  Recording out;
  out.channels.push_back({"x", {}, {}});
  for (const double t : stamps_s) out.channels[0].values.edit().push_back(x(t));
  out.time.source = TimeSource::stamps;
  out.time.rate_hz = rate_hz;
  out.time.stamps_s = std::move(stamps_s);
  return out;
}

std::vector<double> jittered(double rate_hz, std::size_t count, double jitter) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> off(-jitter, jitter);
  std::vector<double> out;
  for (std::size_t k = 0; k < count; ++k)
    out.push_back((static_cast<double>(k) + (k == 0 ? 0.0 : off(random))) / rate_hz);
  return out;
}

/// The largest error relative to x(t), excluding a margin at either end.
template <class Function>
double worst(const Recording& got, Function x, double margin_s = 0.0) {
  double most = 0.0;
  const auto& values = got.channels[0].values;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double t = got.time.at(k);
    if (t < margin_s || t > got.time.at(values.size() - 1) - margin_s) continue;
    most = std::max(most, std::isnan(values[k]) ? 1e300 : std::abs(values[k] - x(t)));
  }
  return most;
}

TEST(Resample, LinearIsExactOnALineAndCubicOnACubicAtUnevenStamps) {
  const auto line = [](double t) { return 3.0 - 2.0 * t; };
  const auto cube = [](double t) { return 1.0 + t - 0.5 * t * t + 0.125 * t * t * t; };
  for (const double target_hz : {37.0, 100.0, 261.0}) {
    const auto stamps = jittered(100.0, 400, 0.2);
    const auto straight =
        resample(recording_of(line, 100.0, stamps), {target_hz, ResampleMethod::linear});
    ASSERT_TRUE(straight.has_value()) << straight.error().message;
    EXPECT_LT(worst(*straight, line), 1e-13);
    const auto curved =
        resample(recording_of(cube, 100.0, stamps), {target_hz, ResampleMethod::cubic});
    ASSERT_TRUE(curved.has_value());
    EXPECT_LT(worst(*curved, cube), 1e-12);
    EXPECT_TRUE(curved->time.is_uniform());
    EXPECT_EQ(curved->time.rate_hz, target_hz);
  }
}

TEST(Resample, SincBringsASineBackWithinItsStatedError) {
  for (const double target_hz : {73.0, 50.0, 133.0, 400.0}) {
    const double limit_hz = 0.84 * std::min(target_hz, 100.0) / 2.0;
    for (const double part : {0.1, 0.7, 1.0}) {
      const auto sine = [&](double t) { return std::sin(2.0 * pi * part * limit_hz * t + 0.3); };
      const auto got = resample(recording_of(sine, 100.0, 3000), {.target_hz = target_hz});
      ASSERT_TRUE(got.has_value());
      EXPECT_LT(worst(*got, sine, 1.0), 3e-4) << target_hz << " " << part;
    }
  }
}

TEST(Resample, SincRejectsWhatWouldBeAnAlias) {
  const double target_hz = 40.0;
  for (const double frequency_hz : {20.5, 27.0, 39.9, 45.0}) {
    const auto sine = [&](double t) { return std::sin(2.0 * pi * frequency_hz * t); };
    const auto got = resample(recording_of(sine, 100.0, 4000), {.target_hz = target_hz});
    ASSERT_TRUE(got.has_value());
    EXPECT_LT(worst(*got, [](double) { return 0.0; }, 1.0), 2e-4) << frequency_hz;
  }
}

TEST(Resample, SincKeepsTheVarianceOfABand) {
  // White noise at 200 Hz: at 50 Hz 0.23 of its variance remains, the part below 0.92 · 25 Hz.
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  const auto noise = [&](double) { return normal(random); };
  const auto got = resample(recording_of(noise, 200.0, 400'000), {.target_hz = 50.0});
  ASSERT_TRUE(got.has_value());
  const auto& x = got->channels[0].values;
  const double power = std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
  EXPECT_NEAR(power / static_cast<double>(x.size()), 0.23, 0.005);
}

TEST(Resample, SincReturnsTheSamplesThemselvesAtTheirOwnTimes) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const auto noise = [&](double) { return normal(random); };
  const Recording recording = recording_of(noise, 100.0, 500);
  const auto twice = resample(recording, {.target_hz = 200.0});
  ASSERT_TRUE(twice.has_value());
  for (std::size_t k = 0; k < 500; ++k)
    EXPECT_NEAR(twice->channels[0].values[2 * k], recording.channels[0].values[k], 1e-12);
}

TEST(Resample, SincSeesThroughUnevenStamps) {
  const auto sine = [](double t) { return std::sin(2.0 * pi * 2.0 * t); };
  const auto got =
      resample(recording_of(sine, 100.0, jittered(100.0, 2000, 0.2)), {.target_hz = 60.0});
  ASSERT_TRUE(got.has_value()) << got.error().message;
  EXPECT_LT(worst(*got, sine, 1.0), 1e-3);
}

TEST(Resample, LeavesGapsEmptyWhateverTheMethod) {
  std::vector<double> stamps;
  for (int k = 0; k < 1000; ++k)
    if (k < 400 || k > 450) stamps.push_back(0.01 * k);
  const auto constant = [](double) { return 2.0; };
  const Recording recording = recording_of(constant, 100.0, stamps);
  for (const auto method : {ResampleMethod::sinc, ResampleMethod::linear, ResampleMethod::cubic,
                            ResampleMethod::nearest, ResampleMethod::mean}) {
    const auto got = resample(recording, {.target_hz = 50.0, .method = method});
    ASSERT_TRUE(got.has_value()) << got.error().message;
    for (std::size_t k = 0; k < got->samples(); ++k) {
      const double t = got->time.at(k);
      const double value = got->channels[0].values[k];
      if (t > 4.005 && t < 4.495) {
        EXPECT_TRUE(std::isnan(value)) << t << name_of(method);
      } else if (t < 3.985 || t > 4.515) {
        EXPECT_NEAR(value, 2.0, 1e-12) << t << name_of(method);
      }
    }
  }
}

TEST(Resample, KeepsWhatIsNoNumberNoNumber) {
  Recording recording = recording_of([](double t) { return t; }, 100.0, 300);
  recording.channels[0].values.edit()[150] = std::nan("");
  for (const auto method : {ResampleMethod::sinc, ResampleMethod::linear, ResampleMethod::cubic}) {
    const auto got = resample(recording, {.target_hz = 330.0, .method = method});
    ASSERT_TRUE(got.has_value());
    std::size_t missing = 0;
    for (const double x : got->channels[0].values) missing += std::isnan(x) ? 1 : 0;
    // 1.49 … 1.51 s, ends excluded.
    EXPECT_EQ(missing, 7u) << name_of(method);
  }
}

TEST(Resample, MeansGoDownOnly) {
  const auto ramp = [](double t) { return t; };
  const auto got = resample(recording_of(ramp, 100.0, 1001),
                            {.target_hz = 10.0, .method = ResampleMethod::mean});
  ASSERT_TRUE(got.has_value());
  // Samples at t − 0.05 s … t + 0.04 s.
  EXPECT_NEAR(got->channels[0].values[50], 5.0 - 0.005, 1e-9);
  EXPECT_EQ(resample(recording_of(ramp, 100.0, 100), {200.0, ResampleMethod::mean}).error().code,
            Errc::invalid_argument);
}

TEST(Resample, RefusesWhatCannotBe) {
  const auto ramp = [](double t) { return t; };
  const Recording recording = recording_of(ramp, 100.0, 100);
  for (const double target_hz : {-1.0, std::nan(""), 1e300, 1e12})
    EXPECT_EQ(resample(recording, {.target_hz = target_hz}).error().code, Errc::invalid_argument);
  const auto back =
      resample(recording_of(ramp, 100.0, {0.0, 0.01, 0.02, 0.01, 0.02, 0.03}), {.target_hz = 50.0});
  EXPECT_EQ(back.error().code, Errc::corrupt);
  EXPECT_EQ(resample(recording_of(ramp, 0.0, 100), {.target_hz = 50.0}).error().code,
            Errc::invalid_argument);
  EXPECT_TRUE(resample(recording_of(ramp, 100.0, 1), {.target_hz = 50.0}).has_value());
}

TEST(Resample, TakesCountersFromTheNearestSampleAndMovesLabels) {
  Recording recording = recording_of([](double t) { return t; }, 100.0, 400);
  recording.channels.push_back({"PacketCounter", {}, {}});
  for (int k = 0; k < 400; ++k) recording.channels[1].values.edit().push_back(k);
  recording.labels = {{"up", 100, 199}};
  recording.label_channel = "pose";
  const auto got = resample(recording, {.target_hz = 50.0});
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->channels[1].values[7], 14.0);
  EXPECT_EQ(got->labels, (std::vector<Label>{{"up", 50, 99}}));
  EXPECT_EQ(got->notes.back().text, "resampled from 100 Hz to 50 Hz by sinc; gaps are left empty");
}

TEST(Join, BringsTablesOfOneClockTogetherWhereTheyOverlap) {
  const auto sine = [](double t) { return std::sin(2.0 * pi * t); };
  Recording slow = recording_of(sine, 50.0, 500);
  slow.source = "acc";
  slow.time.start_ns = 1'700'000'000'000'000'000;
  const auto later = [&](double t) { return 10.0 * sine(t + 1.003); };
  Recording fast = recording_of(later, 200.0, 1600);
  fast.source = "gyro";
  fast.time.start_ns = 1'700'000'001'003'000'000;
  fast.channels.push_back({"temp", {}, std::vector<double>(1600, 20.0)});
  const std::vector<Recording> both{slow, fast};
  const auto got = join(both, {});
  ASSERT_TRUE(got.has_value()) << got.error().message;
  EXPECT_EQ(got->time.rate_hz, 200.0);
  EXPECT_EQ(got->time.start_ns, 1'700'000'001'003'000'000);
  EXPECT_NEAR(got->duration_s(), 7.995, 1e-9);
  ASSERT_EQ(got->channels.size(), 3u);
  EXPECT_EQ(got->channels[0].name, "acc.x");
  EXPECT_EQ(got->channels[1].name, "gyro.x");
  EXPECT_EQ(got->channels[2].name, "temp");
  for (std::size_t k = 200; k < 1400; ++k) {
    const double t = got->time.at(k) + 1.003;
    EXPECT_NEAR(got->channels[0].values[k], sine(t), 1e-4);
    EXPECT_NEAR(got->channels[1].values[k], 10.0 * sine(t), 1e-4);
  }
}

TEST(Join, RefusesWhatDoesNotOverlapAndTellsAnUnknownBeginning) {
  Recording a = recording_of([](double t) { return t; }, 50.0, 100);
  a.source = "a";
  Recording b = a;
  b.source = "b";
  a.time.start_ns = 0;
  b.time.start_ns = 60'000'000'000;
  EXPECT_EQ(join(std::vector<Recording>{a, b}, {}).error().code, Errc::too_few_samples);
  b.time.start_ns.reset();
  const auto got = join(std::vector<Recording>{a, b}, {});
  ASSERT_TRUE(got.has_value());
  EXPECT_TRUE(got->notes.back().text.starts_with("b: does not say when it began"));
  EXPECT_EQ(got->samples(), 100u);
}

}  // namespace
}  // namespace proofmass::signal::resample_test

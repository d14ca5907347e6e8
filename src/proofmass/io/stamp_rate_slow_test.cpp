#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <iostream>
#include <random>
#include <string>

#include "proofmass/io/time_base.hpp"
#include "proofmass/signal/audit.hpp"

// Stamps drawn by rules of their own, and what is said of them counted.
namespace proofmass::io::stamp_rate_slow_test {
namespace {

struct Kind {
  std::string name;
  double lowest_hz = 50.0, highest_hz = 500.0;
  double tick_s = 1e-6;
  double jitter = 0.0;  ///< standard deviation of a stamp, in steps
  double lost = 0.0;
  std::size_t shortest = 1, longest = 1;  ///< rows of a packet
  double late = 0.0;                      ///< mean lateness of a packet, in steps
  double tolerance = 1e-3;
  /// Rates outside their interval: 5 % of 200, and two standard deviations more.
  int most_outside = 16;
};

void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}

struct Drawn {
  std::vector<double> stamps_s;
  double rate_hz = 0.0;
};

Drawn draw(const Kind& kind, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  std::exponential_distribution<double> exponential;
  std::uniform_int_distribution<std::size_t> size(kind.shortest, kind.longest);
  Drawn out;
  out.rate_hz = kind.lowest_hz * std::pow(kind.highest_hz / kind.lowest_hz, uniform(random));
  const double phase = uniform(random);
  std::size_t left = 0;
  double packet = 0.0;
  for (int k = 0; k < 8000; ++k) {
    double at = k + phase;
    if (kind.longest > 1) {
      if (left == 0) {
        left = size(random);
        packet = std::max(packet, at + static_cast<double>(left) + kind.late * exponential(random));
      }
      --left;
      at = packet;
    }
    at += kind.jitter * normal(random);
    if (k > 0 && uniform(random) < kind.lost) continue;
    out.stamps_s.push_back(std::round(at / out.rate_hz / kind.tick_s) * kind.tick_s);
  }
  return out;
}

struct Wrong {
  int rate = 0, gaps = 0;
  int outside = 0;  ///< of the interval of 95 % about the rate
};

Wrong count_wrong(const Kind& kind, int recordings) {
  Wrong wrong;
  for (int k = 0; k < recordings; ++k) {
    const Drawn drawn = draw(kind, 1000U + static_cast<unsigned>(k));
    TimeEvidence evidence;
    evidence.samples = drawn.stamps_s.size();
    evidence.stamps.emplace();
    evidence.stamps->name = "t";
    evidence.stamps->unit = *parse_unit("s");
    for (const double stamp_s : drawn.stamps_s)
      evidence.stamps->values.push_back(stamp_s - drawn.stamps_s.front());
    const TimeBase time = find_time_base(evidence, {}).base;
    if (!(std::abs(time.rate_hz / drawn.rate_hz - 1.0) < kind.tolerance)) ++wrong.rate;
    Recording recording;
    recording.time = time;
    recording.channels.push_back(
        {"a", *parse_unit("m/s^2"), std::vector<double>(drawn.stamps_s.size(), 1.0)});
    const signal::TimingAudit timing = signal::audit(recording).timing;
    if (kind.lost == 0.0 && timing.gap_count > 0) ++wrong.gaps;
    const double std_hz = timing.rate_std_hz.value_or(0.0);
    if (std::abs(time.rate_hz - drawn.rate_hz) > 1.96 * std_hz) ++wrong.outside;
  }
  std::cout << "| " << kind.name << " | " << wrong.rate << " of " << recordings << " | "
            << wrong.outside << " | ";
  if (kind.lost == 0.0)
    std::cout << wrong.gaps << " of " << recordings << " |\n";
  else
    std::cout << "– |\n";
  return wrong;
}

Kind whole_ms(
    const char* name, double lowest_hz, double highest_hz, double tolerance, double lost = 0.0) {
  return {.name = name,
          .lowest_hz = lowest_hz,
          .highest_hz = highest_hz,
          .tick_s = 1e-3,
          .lost = lost,
          .tolerance = tolerance,
          // Rounded stamps with lost rows are covered in 82 % only: a known limit.
          .most_outside = lost > 0.0 ? 45 : 20};
}

class StampRate : public testing::TestWithParam<Kind> {};

TEST_P(StampRate, AndGapsAreRight) {
  const Wrong wrong = count_wrong(GetParam(), 200);
  EXPECT_EQ(wrong.rate, 0);
  EXPECT_EQ(wrong.gaps, 0);
  EXPECT_LE(wrong.outside, GetParam().most_outside);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds,
    StampRate,
    testing::Values(
        whole_ms("whole ms, 667–980 Hz", 667.0, 980.0, 1e-4),
        whole_ms("whole ms, 1020–2000 Hz", 1020.0, 2000.0, 1e-4),
        whole_ms("whole ms, 100–660 Hz", 100.0, 660.0, 1e-3),
        whole_ms("whole ms and 0.2 % lost, 667–950 Hz", 667.0, 950.0, 2e-3, 0.002),
        whole_ms("whole ms and 2 % lost, 667–950 Hz", 667.0, 950.0, 0.1, 0.02),
        whole_ms("whole ms and 2 % lost, 980–1020 Hz", 980.0, 1020.0, 0.1, 0.02),
        Kind{.name = "whole ms and 8 % jitter, 980–1020 Hz, 1 % lost",
             .lowest_hz = 980.0,
             .highest_hz = 1020.0,
             .tick_s = 1e-3,
             .jitter = 0.08,
             .lost = 0.01,
             .tolerance = 0.1},
        Kind{.name = "5 % jitter", .jitter = 0.05, .tolerance = 2e-3},
        Kind{.name = "8 % jitter, 10 % lost", .jitter = 0.08, .lost = 0.1, .tolerance = 2e-3},
        Kind{.name = "8 % jitter, 20 % lost", .jitter = 0.08, .lost = 0.2, .tolerance = 2e-3},
        Kind{.name = "2 % jitter, 10 % lost", .jitter = 0.02, .lost = 0.1, .tolerance = 2e-3},
        Kind{.name = "packets of 8 rows", .shortest = 8, .longest = 8},
        Kind{.name = "packets of 4 to 16 rows", .shortest = 4, .longest = 16},
        Kind{.name = "packets of 4 to 16 rows, late by 2 steps in the mean",
             .shortest = 4,
             .longest = 16,
             .late = 2.0,
             .tolerance = 2e-3}));

}  // namespace
}  // namespace proofmass::io::stamp_rate_slow_test

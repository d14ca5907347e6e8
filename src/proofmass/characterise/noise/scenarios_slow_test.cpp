#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/characterise/noise/noise_test_support.hpp"
#include "proofmass/characterise/noise_analysis.hpp"

// The table of docs/methods/noise.md: recordings of random length and random composition, and the
// coverage of the interval and of value ± 1.96 std in each scenario. White noise is 1 throughout.
namespace proofmass::characterise::noise_scenarios_slow_test {
namespace {

using test::Series;

constexpr double rate_hz = 100.0;
constexpr std::array names{"Q", "N", "B", "K", "R"};

struct Drawn {
  std::array<double, names.size()> truth{};  // in that order
  Series series;
};

struct Tally {
  int identified = 0, in_interval = 0, in_printed = 0, bounded = 0, absent = 0, sure_and_false = 0;
  double largest_z = 0.0;
};

struct Outcome {
  int records = 0, not_stationary = 0;
  std::array<Tally, names.size()> terms;
};

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {  // uniform in the logarithm
    return low * std::pow(high / low, std::uniform_real_distribution<>()(engine_));
  }
  std::size_t samples() { return static_cast<std::size_t>(between(5000.0, 60'000.0)); }

 private:
  std::mt19937_64 engine_;
};

Drawn mixture(std::array<double, names.size()> truth, std::size_t n, unsigned seed) {
  const auto [Q, N, B, K, R] = truth;
  std::vector<Series> parts{test::white(N, rate_hz, n, seed)};
  if (Q > 0.0) parts.push_back(test::quantisation(Q, rate_hz, n, seed + 1));
  if (B > 0.0) parts.push_back(test::flicker(B, n, seed + 2));
  if (K > 0.0) parts.push_back(test::random_walk(K, rate_hz, n, seed + 3));
  if (R > 0.0) parts.push_back(test::ramp(R, rate_hz, n));
  return {truth, test::sum_of(parts)};
}

void add_shape(Drawn& drawn, double size, const std::function<double(double)>& shape) {
  const auto n = static_cast<double>(drawn.series.size());
  for (std::size_t k = 0; k < drawn.series.size(); ++k)
    drawn.series[k] += size * shape(static_cast<double>(k) / n);
}

void tally(const NoiseModelFit& model, const Drawn& drawn, Outcome& outcome) {
  const std::array<const Coefficient*, names.size()> found{
      &model.quantisation, &model.white, &model.flicker, &model.random_walk, &model.ramp};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Coefficient& c = *found[k];
    Tally& seen = outcome.terms[k];
    const double truth = drawn.truth[k];
    const bool identified = c.verdict == Verdict::identified;
    if (truth == 0.0) {
      seen.sure_and_false += identified && c.lower_95 > 0.0 ? 1 : 0;
    } else if (identified) {
      const double z = (c.value - truth) / c.std;
      ++seen.identified;
      seen.in_interval += c.lower_95 <= truth && truth <= c.upper_two_sided_95 ? 1 : 0;
      seen.in_printed += std::abs(z) <= 1.96 ? 1 : 0;
      if (std::abs(z) > std::abs(seen.largest_z)) seen.largest_z = z;
    } else {
      ++seen.absent;
      seen.bounded += truth <= c.upper_95 ? 1 : 0;
    }
  }
}

Outcome analysed(int records, const std::function<Drawn(Dice&, unsigned)>& draw) {
  Outcome outcome;
  for (int record = 0; record < records; ++record) {
    const auto seed = static_cast<unsigned>(record);
    Dice dice(77 * seed + 5);
    const Drawn drawn = draw(dice, 1000 * seed + 13);
    const auto analysis =
        analyse_noise(drawn.series, {.rate_hz = rate_hz, .taus = {.kind = TauGrid::Kind::decade}});
    if (!analysis) continue;
    ++outcome.records;
    outcome.not_stationary += analysis->stationarity.stationary ? 0 : 1;
    tally(analysis->model, drawn, outcome);
  }
  return outcome;
}

int percent(int part, int whole) {
  return whole == 0 ? 0 : static_cast<int>(std::lround(100.0 * part / whole));
}

void print(const std::string& name, const Outcome& outcome) {
  std::printf("| %s | %d | not stationary %d |\n", name.c_str(), outcome.records,
              outcome.not_stationary);
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Tally& t = outcome.terms[k];
    if (t.identified + t.absent > 0)
      std::printf("|   %s | %d | %d %% | %d %% | %.1f | %d %% of %d |\n", names[k], t.identified,
                  percent(t.in_interval, t.identified), percent(t.in_printed, t.identified),
                  t.largest_z, percent(t.bounded, t.absent), t.absent);
    else if (t.sure_and_false > 0)
      std::printf("|   %s | | | | | false without doubt: %d |\n", names[k], t.sure_and_false);
  }
}

/// At least `share` of the trials, up to three standard deviations.
void expect_at_least(double share, int count, int trials) {
  if (trials == 0) return;
  EXPECT_GE(count, share * trials - 3.0 * std::sqrt(share * (1.0 - share) * trials));
}

void expect_honest(const std::string& name, const Outcome& outcome) {
  SCOPED_TRACE(name);
  print(name, outcome);
  EXPECT_LE(outcome.not_stationary, 0.01 * outcome.records + 3.0);
  for (std::size_t k = 0; k < names.size(); ++k) {
    SCOPED_TRACE(names[k]);
    const Tally& t = outcome.terms[k];
    expect_at_least(0.93, t.in_interval, t.identified);
    expect_at_least(0.93, t.in_printed, t.identified);
    expect_at_least(0.9, t.bounded, t.absent);
    EXPECT_LT(std::abs(t.largest_z), 5.0);
    EXPECT_LE(t.sure_and_false, 0.03 * outcome.records + 3.0);
  }
}

constexpr int records = 200;

TEST(NoiseScenarios, IntervalsAndPrintedDeviationsHoldTheTruth) {
  using Draw = std::function<Drawn(Dice&, unsigned)>;
  const std::vector<std::pair<std::string, Draw>> scenarios{
      {"white", [](Dice& d, unsigned s) { return mixture({0, 1, 0, 0, 0}, d.samples(), s); }},
      {"white, flicker",
       [](Dice& d, unsigned s) {
         return mixture({0, 1, d.between(0.1, 2.0), 0, 0}, d.samples(), s);
       }},
      {"white, random walk",
       [](Dice& d, unsigned s) {
         return mixture({0, 1, 0, d.between(0.01, 1.0), 0}, d.samples(), s);
       }},
      {"white, flicker, random walk",
       [](Dice& d, unsigned s) {
         const double B = d.between(0.2, 2.0), K = d.between(0.02, 0.5);
         return mixture({0, 1, B, K, 0}, d.samples(), s);
       }},
      {"white, quantisation",
       [](Dice& d, unsigned s) {
         return mixture({d.between(0.01, 0.2), 1, 0, 0, 0}, d.samples(), s);
       }},
      {"all four",
       [](Dice& d, unsigned s) {
         const double Q = d.between(0.02, 0.2), B = d.between(0.2, 2.0), K = d.between(0.02, 0.5);
         return mixture({Q, 1, B, K, 0}, d.samples(), s);
       }},
      {"white, random walk, ramp",
       [](Dice& d, unsigned s) {
         const double K = d.between(0.02, 0.2), R = d.between(0.01, 0.5);
         return mixture({0, 1, 0, K, R}, d.samples(), s);
       }},
      {"white, flicker, random walk, gaps",
       [](Dice& d, unsigned s) {
         const double B = d.between(0.2, 2.0), K = d.between(0.02, 0.5);
         Drawn drawn = mixture({0, 1, B, K, 0}, d.samples(), s);
         for (int gap = 0; gap < 8; ++gap) {
           const auto at = static_cast<std::size_t>(
               d.between(1.0, static_cast<double>(drawn.series.size() - 200)));
           for (std::size_t k = at; k < at + 20 * static_cast<std::size_t>(gap + 1); ++k)
             drawn.series[k] = std::numeric_limits<double>::quiet_NaN();
         }
         return drawn;
       }},
  };
  for (const auto& [name, draw] : scenarios) expect_honest(name, analysed(records, draw));
}

TEST(NoiseScenarios, ASlowSineOrABendIsNotACertainRandomWalk) {
  const auto sine = [](Dice& d, unsigned s) {
    Drawn drawn = mixture({0, 1, 0, 0, 0}, d.samples(), s);
    const double periods = 1.0 / d.between(0.2, 2.0), phase = d.between(1.0, 6.28);
    add_shape(drawn, d.between(0.3, 10.0),
              [=](double x) { return std::sin(2.0 * std::numbers::pi * periods * x + phase); });
    return drawn;
  };
  const auto bend = [](Dice& d, unsigned s) {
    Drawn drawn = mixture({0, 1, 0, 0, 0}, d.samples(), s);
    add_shape(drawn, d.between(0.3, 10.0),
              [](double x) { return (2.0 * x - 1.0) * (2.0 * x - 1.0); });
    return drawn;
  };
  for (const auto& [name, outcome] :
       {std::pair{"slow sine", analysed(records, sine)}, {"parabola", analysed(records, bend)}}) {
    SCOPED_TRACE(name);
    print(name, outcome);
    EXPECT_LE(outcome.terms[2].sure_and_false, 4);
    EXPECT_LE(outcome.terms[3].sure_and_false, 4);
  }
}

TEST(NoiseScenarios, NoiseThatChangesIsNotCalledStationary) {
  const auto louder = [](Dice& d, unsigned s) {
    Drawn drawn = mixture({0, 1, 0, 0, 0}, d.samples(), s);
    const double factor = d.between(1.3, 4.0);
    for (std::size_t k = drawn.series.size() / 2; k < drawn.series.size(); ++k)
      drawn.series[k] *= factor;
    return drawn;
  };
  const auto swelling = [](Dice& d, unsigned s) {
    Drawn drawn = mixture({0, 1, 0, 0, 0}, d.samples(), s);
    const double periods = d.between(0.7, 4.0);
    const auto n = static_cast<double>(drawn.series.size());
    for (std::size_t k = 0; k < drawn.series.size(); ++k)
      drawn.series[k] *=
          1.0 + 0.6 * std::sin(2.0 * std::numbers::pi * periods * static_cast<double>(k) / n);
    return drawn;
  };
  for (const auto& [name, outcome] :
       {std::pair{"1.3 … 4 times louder half way", analysed(records, louder)},
        {"60 % slower modulation", analysed(records, swelling)}}) {
    SCOPED_TRACE(name);
    print(name, outcome);
    EXPECT_GE(outcome.not_stationary, outcome.records - 3);
    // relative to the initial level
    EXPECT_GE(outcome.terms[1].in_interval, 0.93 * outcome.records);
  }
}

}  // namespace
}  // namespace proofmass::characterise::noise_scenarios_slow_test

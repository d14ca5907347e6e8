#include <algorithm>
#include <array>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <gtest/gtest.h>
#include <map>
#include <optional>
#include <string>

#include "proofmass/calibrate/tumble_test_support.hpp"

// Coverage of the 95 % intervals for realistic tables: nonlinear drift, inaccurate angles, an
// outlier. Nothing is stated except, in some cases, the noise.
namespace proofmass::calibrate::tumble_scenarios_slow_test {
namespace {

using Q = TumbleQuantity;
constexpr int tests = 200;
constexpr double sigma = 1e-3;  // m/s², of a measurement

/// The bias of each position, m/s².
using Drift = std::function<std::vector<double>(std::size_t count, std::mt19937_64& random)>;

struct Scenario {
  std::string name;
  std::vector<TumblePosition> plan;
  Drift drift = {};
  double angle_std_deg = 0.0;  ///< of each setting, equal at each visit
  double wrong_mps2 = 0.0;     ///< error of one randomly chosen position
  bool noise_stated = true;
};

double uniform(double low, double high, std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A function of the elapsed fraction of the test.
Drift as(const std::function<double(double)>& shape) {
  return [=](std::size_t count, std::mt19937_64& random) {
    const double sign = uniform(-1.0, 1.0, random) < 0.0 ? -1.0 : 1.0;
    std::vector<double> bias;
    for (std::size_t k = 0; k < count; ++k)
      bias.push_back(sign * shape(static_cast<double>(k) / static_cast<double>(count - 1)));
    return bias;
  };
}

/// Total change 10 mm/s².
Drift exponential() {
  return as([](double x) { return 0.01 * (1.0 - std::exp(-3.0 * x)) / (1.0 - std::exp(-3.0)); });
}

Drift line() {
  return as([](double x) { return 0.01 * x; });
}

Drift sine() {
  return [](std::size_t count, std::mt19937_64& random) {
    const double phase = uniform(0.0, rad_per_turn, random);
    return as([=](double x) { return 0.01 * std::sin(rad_per_turn * x + phase); })(count, random);
  };
}

Drift step() {
  return [](std::size_t count, std::mt19937_64& random) {
    const double when = uniform(0.1, 0.9, random);
    return as([=](double x) { return x < when ? 0.0 : 0.01; })(count, random);
  };
}

Drift walk() {
  return [](std::size_t count, std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    std::vector<double> bias{0.0};
    const double each = 0.01 / std::sqrt(static_cast<double>(count - 1));
    while (bias.size() < count) bias.push_back(bias.back() + each * normal(random));
    return bias;
  };
}

struct Reading {
  std::vector<TumblePosition> positions;
  TableTruth truth;  ///< K0 at the centre of the test
  std::optional<std::size_t> wrong;
};

Reading read(const Scenario& scenario, unsigned seed) {
  std::mt19937_64 random(seed);
  Reading out;
  const std::size_t n = scenario.plan.size();
  const bool cubic = n > 7;  // with four positions it is part of the scale
  out.truth = {.K1 = uniform(0.97, 1.03, random),
               .K0 = uniform(-0.5, 0.5, random),
               .K2 = uniform(-1e-5, 1e-5, random),
               .K3 = cubic ? uniform(-1e-6, 1e-6, random) : 0.0,
               .Kpp = 0.0,
               .delta_o = uniform(-0.01, 0.01, random),
               .Kip = n > 6 ? uniform(-1e-5, 1e-5, random) : 0.0,
               .noise = sigma,
               .setting_rad = scenario.angle_std_deg * rad_per_deg};
  out.positions = read_table(scenario.plan, out.truth, random);
  if (scenario.drift) {
    const std::vector<double> bias = scenario.drift(n, random);
    double mean = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
      out.positions[k].output += out.truth.K1 * bias[k];
      mean += bias[k] / static_cast<double>(n);
    }
    out.truth.K0 += mean;
  }
  if (scenario.wrong_mps2 > 0.0) {
    out.wrong = static_cast<std::size_t>(uniform(0.0, static_cast<double>(n) - 1e-9, random));
    out.positions[*out.wrong].output += out.truth.K1 * scenario.wrong_mps2;
  }
  if (scenario.noise_stated)
    for (TumblePosition& p : out.positions) p.output_std = sigma;
  return out;
}

struct Tally {
  int inside = 0, given = 0;
  double largest_z = 0.0;
  std::vector<double> widths;
};

bool is_counted(Q quantity) {
  constexpr std::array counted{Q::K1,           Q::K0,  Q::K0_up_down, Q::misalignment,
                               Q::K2_minus_Kpp, Q::Kip, Q::K3};
  return std::ranges::find(counted, quantity) != counted.end();
}

void count(const TumbleFit& fit, const TableTruth& truth, std::map<Q, Tally>& tallies) {
  for (const TumbleCoefficient& c : fit.coefficients) {
    if (!c.half_width_95 || !is_counted(c.quantity)) continue;
    Tally& tally = tallies[c.quantity];
    const double error = std::abs(*c.value - true_value(truth, c.quantity));
    ++tally.given;
    if (error <= *c.half_width_95) ++tally.inside;
    tally.largest_z = std::max(tally.largest_z, 1.96 * error / *c.half_width_95);
    tally.widths.push_back(*c.half_width_95);
  }
}

struct Names {
  int right = 0, wrong = 0, clean = 0;
};

void expect_honest(const Scenario& scenario, std::map<Q, Tally>& tallies, const Names& names) {
  std::printf("%s: named %d, others named %d, not noticed %d of %d\n", scenario.name.c_str(),
              names.right, names.wrong, names.clean, tests);
  for (auto& [quantity, tally] : tallies) {
    std::ranges::sort(tally.widths);
    const double share = static_cast<double>(tally.inside) / tally.given;
    std::printf("  %-18s %5.3f of %3d, largest %5.2f, half-width %.3g\n",
                std::string(name_of(quantity)).c_str(), share, tally.given, tally.largest_z,
                tally.widths[tally.widths.size() / 2]);
    EXPECT_GT(share, 0.91 - 3.0 * std::sqrt(0.05 * 0.95 / tally.given))
        << scenario.name << ": " << name_of(quantity);
    // Student's t with one or two degrees of freedom has longer tails.
    if (scenario.noise_stated) {
      EXPECT_LT(tally.largest_z, 8.0) << scenario.name << ": " << name_of(quantity);
    }
  }
}

std::vector<Scenario> scenarios() {
  const auto closed = [](int n) { return table_turn(n, true); };
  std::vector<TumblePosition> twice = table_turn(12);
  append(twice, closed(12));
  std::vector<Scenario> all;
  for (const int n : {4, 6, 8, 12, 24}) {
    all.push_back({.name = fmt::format("{} positions", n), .plan = closed(n)});
    all.push_back({.name = fmt::format("{} positions, noise not stated", n),
                   .plan = closed(n),
                   .noise_stated = false});
  }
  for (const int n : {4, 12, 24})
    all.push_back(
        {.name = fmt::format("{}, exponential", n), .plan = closed(n), .drift = exponential()});
  all.push_back({.name = "12, line", .plan = closed(12), .drift = line()});
  for (const int n : {12, 24}) {
    all.push_back({.name = fmt::format("{}, sine", n), .plan = closed(n), .drift = sine()});
    all.push_back({.name = fmt::format("{}, walk", n), .plan = closed(n), .drift = walk()});
    all.push_back({.name = fmt::format("{}, step", n), .plan = closed(n), .drift = step()});
  }
  all.push_back({.name = "12, not closed, line", .plan = table_turn(12), .drift = line()});
  all.push_back({.name = "12 forwards and backwards, exponential",
                 .plan = there_and_back(12),
                 .drift = exponential()});
  all.push_back({.name = "12 twice, exponential", .plan = twice, .drift = exponential()});
  all.push_back({.name = "12 twice, no drift", .plan = twice});
  for (const auto& [n, degrees] :
       {std::pair{4, 0.01}, {4, 0.05}, {4, 0.5}, {8, 0.05}, {12, 0.05}, {24, 0.2}, {24, 0.5}})
    for (const bool stated : {true, false})
      all.push_back(
          {.name = fmt::format("{}, angles {}°{}", n, degrees, stated ? "" : ", noise not stated"),
           .plan = closed(n),
           .angle_std_deg = degrees,
           .noise_stated = stated});
  for (const auto& [n, stds] : {std::pair{6, 100.0}, {8, 10.0}, {12, 10.0}, {24, 10.0}})
    all.push_back({.name = fmt::format("{}, one reading off by {} sigma", n, stds),
                   .plan = closed(n),
                   .wrong_mps2 = stds * sigma});
  return all;
}

class TumbleScenarios : public testing::TestWithParam<Scenario> {};

TEST_P(TumbleScenarios, HoldTheTruth) {
  const Scenario& scenario = GetParam();
  std::map<Q, Tally> tallies;
  Names names;
  const TumbleOptions nothing_stated{.gravity_mps2 = table_gravity_mps2};
  for (unsigned seed = 1; seed <= tests; ++seed) {
    const Reading reading = read(scenario, seed);
    const TumbleFit fit = fit_tumble(reading.positions, nothing_stated).value();
    count(fit, reading.truth, tallies);
    bool right = false, other = false;
    for (std::size_t k = 0; k < fit.positions.size(); ++k)
      if (fit.positions[k].suspect) (k == reading.wrong ? right : other) = true;
    names.right += right;
    names.wrong += other;
    names.clean += fit.lack_of_fit && fit.lack_of_fit->p > 0.01 && !right;
  }
  expect_honest(scenario, tallies, names);
  // A step or random walk of ten times the noise between two positions is equivalent to an outlier.
  if (!scenario.drift) {
    EXPECT_LT(names.wrong, tests / 30) << scenario.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Tables, TumbleScenarios, testing::ValuesIn(scenarios()));

}  // namespace
}  // namespace proofmass::calibrate::tumble_scenarios_slow_test

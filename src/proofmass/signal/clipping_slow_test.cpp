#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <iostream>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "proofmass/signal/audit.hpp"

// Recordings that are clipped in several ways, and others that are not, drawn by rules of their
// own; what is said of them is counted.
namespace proofmass::signal::clipping_slow_test {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
using Series = std::vector<double>;

struct Random {
  std::mt19937_64 bits;
  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(bits);
  }
  double log_uniform(double from, double to) {
    return from * std::pow(to / from, uniform(0.0, 1.0));
  }
  double normal() { return std::normal_distribution<double>()(bits); }
  std::size_t whole(double from, double to) { return static_cast<std::size_t>(uniform(from, to)); }
  bool chance(double p) { return uniform(0.0, 1.0) < p; }
};

/// Standard deviation 1, frequencies up to some `cycles` a sample.
Series gaussian(Random& random, std::size_t n, double cycles) {
  Series out(n, 0.0);
  constexpr int terms = 60;
  for (int k = 0; k < terms; ++k) {
    const double f = cycles * std::abs(random.normal()), phase = random.uniform(0.0, two_pi);
    for (std::size_t t = 0; t < n; ++t)
      out[t] += std::sin(two_pi * f * static_cast<double>(t) + phase) * std::sqrt(2.0 / terms);
  }
  return out;
}

/// A smooth motion of standard deviation about 1: sine, modulated, several sines, noise of a band,
/// sweep, decays.
Series motion(Random& random, std::size_t n, int kind) {
  const double f = random.log_uniform(0.001, 0.02), phase = random.uniform(0.0, two_pi);
  const double slow = random.uniform(0.02, 0.2), root = std::numbers::sqrt2;
  if (kind == 3) return gaussian(random, n, f);
  Series out(n);
  const double others[] = {random.uniform(0.3, 2.0), random.uniform(0.3, 2.0)};
  double strength = 1.0, begun = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const auto t = static_cast<double>(k);
    const double angle = two_pi * f * t + phase;
    if (kind == 5 && f * (t - begun) > 8.0) {
      begun = t;
      strength = random.uniform(1.0, 4.0);
    }
    out[k] = kind == 0   ? root * std::sin(angle)
             : kind == 1 ? root * std::sin(angle) * (1.0 + 0.7 * std::sin(slow * angle))
             : kind == 2 ? 0.8 * (std::sin(angle) + std::sin(others[0] * angle) +
                                  std::sin(others[1] * angle + 1.0))
             : kind == 4 ? root * std::sin(two_pi * f * t * (0.3 + t / static_cast<double>(n)))
                         : 2.0 * strength * std::exp(-0.5 * f * (t - begun)) *
                               std::sin(two_pi * f * (t - begun));
  }
  return out;
}

void add_noise(Random& random, Series& values, double std) {
  for (double& x : values) x += std * random.normal();
}

void quantise(Series& values, double step) {
  for (double& x : values) x = std::round(x / step) * step;
}

double range_of(const Series& values) {
  const auto [low, high] = std::ranges::minmax(values);
  return high - low;
}

/// Positions held for hundreds of samples, with smooth or plain turns between them.
Series positions(Random& random, std::size_t n, int kind) {
  Series out;
  double level = 9.81;
  while (out.size() < n) {
    out.insert(out.end(), random.whole(200, 1500), level);
    constexpr double faces[] = {-9.81, 9.81, 0.0, 0.1, -0.2};
    const double next = kind == 0   ? faces[random.whole(0.0, 4.99)] + 0.05 * random.normal()
                        : kind == 1 ? (random.chance(0.5) ? 9.81 : -9.81)
                                    : random.uniform(-9.8, 9.8);
    const auto turn = random.uniform(20.0, 300.0);
    const bool smooth = random.chance(0.6);
    for (double t = 0.0; t < 1.0; t += 1.0 / turn) {
      const double share = smooth ? t * t * t * (10.0 - 15.0 * t + 6.0 * t * t) : t;
      out.push_back(std::lerp(level, next, share));
    }
    level = next;
  }
  out.resize(n);
  return out;
}

Series square_motion(Random& random, std::size_t n) {
  const double f = random.log_uniform(0.001, 0.02);
  Series out(n);
  for (std::size_t k = 0; k < n; ++k)
    out[k] = std::sin(two_pi * f * static_cast<double>(k) + 0.3) > 0.0 ? 1.0 : -1.0;
  if (random.chance(0.4)) return out;
  // Behind a filter of several samples.
  const double pole = 1.0 / random.uniform(2.0, 0.2 / f);
  double state = 0.0;
  for (double& x : out) x = state += pole * (x - state);
  return out;
}

Series strokes(Random& random, std::size_t n) {
  Series out(n, 0.0);
  for (std::size_t at = 100; at + 1200 < n; at += random.whole(700, 1200)) {
    const double top = random.chance(0.5) ? 1.0 : -1.0;
    const double ramp = random.uniform(5.0, 30.0), held = random.uniform(50.0, 150.0);
    const double cruise = random.uniform(0.0, 200.0);
    const auto pulse = [&](double t) {
      return std::clamp(std::min(t, 2.0 * ramp + held - t) / ramp, 0.0, 1.0);
    };
    for (std::size_t k = 0; k < 700; ++k) {
      const auto t = static_cast<double>(k);
      out[at + k] += top * (pulse(t) - pulse(t - 2.0 * ramp - held - cruise));
    }
  }
  return out;
}

Series impacts(Random& random, std::size_t n) {
  Series out(n, 0.0);
  for (std::size_t k = 0; k < n / 500 + 5; ++k) {
    const std::size_t at = random.whole(0.0, static_cast<double>(n) - 100.0);
    const double size = random.uniform(0.2, 5.0), omega = random.uniform(0.2, 1.5);
    for (std::size_t j = 0; j < 60; ++j) {
      const auto t = static_cast<double>(j);
      out[at + j] += size * std::exp(-t / 8.0) * std::cos(omega * t);
    }
  }
  return out;
}

/// Slides that end at a stop.
Series slides(Random& random, std::size_t n) {
  Series out(n, 0.0);
  for (std::size_t at = 200; at + 800 < n; at += random.whole(600, 1500)) {
    const std::size_t length = random.whole(50, 200);
    const double size = random.uniform(0.5, 2.0), stop = random.uniform(3.0, 8.0);
    for (std::size_t j = 0; j < length; ++j)
      out[at + j] =
          size * std::sin(std::numbers::pi * static_cast<double>(j) / static_cast<double>(length));
    for (std::size_t j = 0; j < 3; ++j) out[at + length + j] = -stop;
  }
  return out;
}

Series heavy_tails(Random& random, std::size_t n) {
  std::student_t_distribution<double> distribution(3.0);
  Series out(n);
  for (double& x : out) x = distribution(random.bits);
  return out;
}

struct Kind {
  std::string name;
  bool is_clipped;
  /// What the text has to say of at least so many of 200.
  Clipping as = Clipping::none;
  int fewest = 0;
  std::function<Series(Random&, std::size_t)> draw;
};

void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.name;
}

double bent(double x) {
  return std::tanh(x);
}
double cut(double x) {
  return std::clamp(x, -1.0, 1.0);
}

/// A motion of up to some twice the range, limited, with noise of this size behind it.
Series limited(Random& random, std::size_t n, double (*limit)(double), double least, double most) {
  // A sine alone repeats its crest: what a soft limit makes of it a motion can be as well.
  Series out = motion(random, n, static_cast<int>(random.whole(limit == bent ? 1.0 : 0.0, 5.99)));
  const double scale = 1.0 / random.uniform(0.5, 1.0), offset = random.uniform(-0.2, 0.2);
  for (double& x : out) x = limit(scale * x + offset);
  if (most > 0.0) add_noise(random, out, random.log_uniform(least, most));
  if (random.chance(0.4)) quantise(out, 1.0 / std::exp2(std::floor(random.uniform(9.0, 13.0))));
  return out;
}

/// With noise and steps of any size, on any scale.
Series finished(Random& random, Series values) {
  const double range = range_of(values);
  add_noise(random, values, range * random.log_uniform(1e-4, 1e-2));
  if (random.chance(0.4)) quantise(values, range / std::exp2(std::floor(random.uniform(7, 13))));
  return values;
}

std::vector<Kind> kinds() {
  const auto free = [](int kind) {
    return [kind](Random& r, std::size_t n) { return finished(r, motion(r, n, kind)); };
  };
  const auto held = [](int kind) {
    return [kind](Random& r, std::size_t n) { return finished(r, positions(r, n, kind)); };
  };
  const auto of = [](auto draw) {
    return [draw](Random& r, std::size_t n) { return finished(r, draw(r, n)); };
  };
  const auto coarse = [](auto draw) {
    return [draw](Random& r, std::size_t n) {
      Series values = draw(r, n);
      constexpr double step = 0.0383, noises[] = {0.05, 0.1, 0.2, 0.4};
      add_noise(r, values, step * noises[r.whole(0.0, 3.99)]);
      quantise(values, step);
      return values;
    };
  };
  return {
      {"hard clip", true, Clipping::rail, 195,
       [](Random& r, std::size_t n) { return limited(r, n, cut, 0.0, 0.0); }},
      {"hard clip, then noise", true, Clipping::before_noise, 140,
       [](Random& r, std::size_t n) { return limited(r, n, cut, 3e-4, 2e-2); }},
      {"soft clip", true, Clipping::soft, 130,
       [](Random& r, std::size_t n) { return limited(r, n, bent, 3e-5, 5e-3); }},
      {"sine", false, {}, 0, free(0)},
      {"modulated sine", false, {}, 0, free(1)},
      {"several sines", false, {}, 0, free(2)},
      {"noise of a band", false, {}, 0, free(3)},
      {"sweep", false, {}, 0, free(4)},
      {"decays", false, {}, 0, free(5)},
      {"six positions", false, {}, 0, held(0)},
      {"up and down", false, {}, 0, held(1)},
      {"positions anywhere", false, {}, 0, held(2)},
      {"square motion", false, {}, 0, of(square_motion)},
      {"strokes at a limited acceleration", false, {}, 0, of(strokes)},
      {"impacts", false, {}, 0, of(impacts)},
      {"heavy tails", false, {}, 0, of(heavy_tails)},
      {"positions, coarse", false, {}, 0, coarse([](Random& r, std::size_t n) {
         return positions(r, n, 0);
       })},
      {"slides to a stop, coarse", false, {}, 0, coarse(slides)},
      {"sine, coarse", false, {}, 0, coarse([](Random& r, std::size_t n) {
         return motion(r, n, 0);
       })},
      {"square motion, coarse", false, {}, 0, coarse(square_motion)},
  };
}

Clipping told(Random& random, const Kind& kind) {
  Series values = kind.draw(random, random.whole(5000, 20'000));
  const double scale = random.log_uniform(0.1, 100.0), offset = random.uniform(-0.5, 0.5);
  if (kind.name.find("coarse") == std::string::npos)
    for (double& x : values) x = scale * (x + offset);
  Recording recording;
  recording.time = {TimeSource::given_rate, "", 100.0, {}, {}};
  recording.channels.push_back({"Acc_X", *parse_unit("m/s^2"), std::move(values)});
  return audit(recording).channels[0].clipping;
}

class ClippingOf : public testing::TestWithParam<Kind> {};

TEST_P(ClippingOf, IsToldAndNeverInvented) {
  const Kind& kind = GetParam();
  constexpr int recordings = 200;
  int as_it_is = 0, claimed = 0, undetermined = 0;
  for (int k = 0; k < recordings; ++k) {
    Random random{std::mt19937_64(4000U + static_cast<unsigned>(k))};
    const Clipping clipping = told(random, kind);
    if (clipping == kind.as) ++as_it_is;
    if (clipping == Clipping::undetermined) ++undetermined;
    if (clipping != Clipping::none && clipping != Clipping::undetermined) ++claimed;
  }
  std::cout << "| " << kind.name << " | " << claimed << " | " << as_it_is << " | " << undetermined
            << " |\n";
  if (kind.is_clipped)
    EXPECT_GE(as_it_is, kind.fewest);
  else
    EXPECT_EQ(claimed, 0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ClippingOf, testing::ValuesIn(kinds()));

}  // namespace
}  // namespace proofmass::signal::clipping_slow_test

#include "proofmass/report/page/ticks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string_view>

#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

// The smallest of 1, 2, 5 times a power of ten that fits into the range at most `most` times.
double nice_step(double range, int most) {
  const double raw = range / most;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * (1.0 - 1e-12)) return factor * power;
  }
  return 10.0 * power;
}

std::string superscript(int number) {
  constexpr std::array<std::string_view, 10> digits = {"⁰", "¹", "²", "³", "⁴",
                                                       "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = number < 0 ? "⁻" : "";
  for (const char c : std::to_string(std::abs(number))) {
    out += digits[static_cast<std::size_t>(c - '0')];
  }
  return out;
}

// "2.5·10⁻⁷", for axes on which plain numbers would not fit.
std::string with_power(double value, int power, int decimals) {
  if (value == 0.0) return "0";
  return fixed(value / std::pow(10.0, power), decimals) + "·10" + superscript(power);
}

// "0.02": digit · 10^exponent in decimal notation.
std::string plain_power(int exponent, int digit) {
  return fixed(digit * std::pow(10.0, exponent), std::max(0, -exponent));
}

// 1, 2 and 5 times each power of ten within the range.
std::vector<Tick> one_two_five(double low, double high) {
  std::vector<Tick> ticks;
  const auto last = static_cast<int>(std::floor(std::log10(high)));
  for (auto power = static_cast<int>(std::floor(std::log10(low))); power <= last; ++power) {
    for (const int digit : {1, 2, 5}) {
      const double value = digit * std::pow(10.0, power);
      if (value < low * (1.0 - 1e-9) || value > high * (1.0 + 1e-9)) continue;
      ticks.push_back({value, plain_power(power, digit)});
    }
  }
  return ticks;
}

}  // namespace

std::vector<Tick> linear_ticks(double low, double high, int most) {
  const double range = high - low;
  const double size = std::max(std::abs(low), std::abs(high));
  if (!(range > 0.0) || !std::isfinite(range) || range < 1e-13 * size) return {};
  const double step = nice_step(range, most);
  const int step_exponent = static_cast<int>(std::floor(std::log10(step) + 1e-9));
  const int top_exponent = static_cast<int>(std::floor(std::log10(size)));
  const bool plain = top_exponent < 6 && step_exponent >= -5;
  std::vector<Tick> ticks;
  const double first = std::ceil(low / step - 1e-9);
  const double last = std::floor(high / step + 1e-9);
  for (double k = first; k <= last; k += 1.0) {
    const double value = k * step;
    ticks.push_back({value, plain ? fixed(value, std::max(0, -step_exponent))
                                  : with_power(value, top_exponent,
                                               std::max(0, top_exponent - step_exponent))});
  }
  return ticks;
}

std::vector<Tick> log_ticks(double low, double high, int most) {
  if (!(low > 0.0) || !(high > low) || !std::isfinite(high)) return {};
  const int first = static_cast<int>(std::ceil(std::log10(low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(high) + 1e-9));
  const bool plain = first >= -2 && last <= 4;
  const std::vector<Tick> between = plain ? one_two_five(low, high) : std::vector<Tick>{};
  if (between.size() >= 3 && between.size() <= static_cast<std::size_t>(most) + 1) return between;
  if (last - first < 1) return linear_ticks(low, high, most);
  const int every = std::max(1, (last - first + most) / most);
  std::vector<Tick> ticks;
  for (int exponent = first; exponent <= last; ++exponent) {
    if (exponent % every != 0) continue;
    ticks.push_back({std::pow(10.0, exponent),
                     plain ? plain_power(exponent, 1) : "10" + superscript(exponent)});
  }
  return ticks;
}

}  // namespace proofmass::report

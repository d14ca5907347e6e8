#include "proofmass/core/number_words.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace proofmass {
namespace {

// A true minus sign; none before zero.
std::string with_minus(std::string text) {
  if (text.empty() || text.front() != '-') return text;
  text.erase(0, 1);
  const bool zero =
      std::all_of(text.begin(), text.end(), [](char c) { return c == '0' || c == '.'; });
  return zero ? text : "−" + text;
}

}  // namespace

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "none";
  if (decimals >= 0) return with_minus(fmt::format("{:.{}f}", value, decimals));
  const double place = std::pow(10.0, -decimals);
  return with_minus(fmt::format("{:.0f}", std::round(value / place) * place));
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "none";
  if (value == 0.0) return "0";
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(value))));
  if (exponent < -4 || exponent >= 6) return with_minus(fmt::format("{:.{}e}", value, digits - 1));
  return fixed(value, digits - 1 - exponent);
}

std::string compact(double value, int digits) {
  return std::isfinite(value) ? with_minus(fmt::format("{:.{}g}", value, digits)) : "none";
}

}  // namespace proofmass

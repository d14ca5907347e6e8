#include "proofmass/estimate/motor/screening.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/motor/current_errors.hpp"

namespace proofmass::estimate::motor {
namespace {

// How far each value lies outside the two before and the two after, where all are finite: a step
// does not.
std::vector<double> beyond_neighbours(const std::vector<double>& values) {
  std::vector<double> out(values.size(), 0.0);
  for (std::size_t k = 2; k + 2 < values.size(); ++k) {
    const auto [low, high] =
        std::minmax({values[k - 2], values[k - 1], values[k + 1], values[k + 2]});
    const double distance = std::max(low - values[k], values[k] - high);
    const bool finite =
        std::isfinite(values[k - 2] + values[k - 1] + values[k + 1] + values[k + 2] + values[k]);
    if (finite) out[k] = std::max(distance, 0.0);
  }
  return out;
}

// Makes single outliers NaN, and returns their number.
std::size_t drop_outliers(std::vector<double>& values) {
  constexpr double noise_factor = 10.0, usual = 0.99, usual_factor = 4.0, range_share = 1e-3;
  constexpr double most_dropped = 0.01;
  std::vector<double> finite;
  for (const double v : values)
    if (std::isfinite(v)) finite.push_back(v);
  const std::vector<double> distances = beyond_neighbours(values);
  const double range =
      quantile(finite, usual).value_or(0.0) - quantile(finite, 1.0 - usual).value_or(0.0);
  const double limit =
      std::max({noise_factor * sample_noise(finite),
                usual_factor * quantile(distances, usual).value_or(0.0), range_share * range});
  const auto outlying = [limit](double distance) { return distance > limit; };
  const auto count = static_cast<std::size_t>(std::ranges::count_if(distances, outlying));
  if (static_cast<double>(count) > most_dropped * static_cast<double>(values.size())) return 0;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (outlying(distances[k])) values[k] = std::numeric_limits<double>::quiet_NaN();
  return count;
}

}  // namespace

MotorRecord screened(const MotorRecord& record, std::vector<Note>& notes) {
  MotorRecord out = record;
  if (const auto why = unusable_current(out)) {
    out.current_a.clear();
    notes.push_back({Severity::warning, *why});
  }
  std::string dropped;
  const auto screen = [&dropped](const char* name, std::vector<double>& values) {
    const std::size_t count = drop_outliers(values);
    if (count > 0)
      dropped += (dropped.empty() ? "" : ", ") + std::to_string(count) + " of the " + name;
  };
  screen("voltage", out.voltage_v);
  screen("current", out.current_a);
  screen("angle", out.angle_rad);
  constexpr std::array names{"x axis", "y axis", "z axis"};
  for (auto& sensor : out.accel_mps2)
    for (std::size_t i = 0; i < 3; ++i) screen(names[i], sensor[i]);
  if (!dropped.empty())
    notes.push_back({Severity::warning, "single outliers are left out: " + dropped});
  return out;
}

}  // namespace proofmass::estimate::motor

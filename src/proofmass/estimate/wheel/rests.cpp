#include "proofmass/estimate/wheel/rests.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate {
namespace {

/// Least-squares line through evenly spaced values, and their scatter.
struct Line {
  double slope = 0.0, slope_std = 0.0;        ///< a step
  double residual_std = 0.0, step_std = 0.0;  ///< about the line; by third differences
};

Line line_through(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    mean += values[i] / n;
    moment += values[i] * (static_cast<double>(i) - 0.5 * (n - 1.0));
  }
  const double spread = n * (n * n - 1.0) / 12.0;
  Line line;
  line.slope = moment / spread;
  double squares = 0.0, thirds = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    squares += square(values[i] - mean - line.slope * (static_cast<double>(i) - 0.5 * (n - 1.0)));
    if (i >= 3)
      thirds += square(values[i] - 3.0 * values[i - 1] + 3.0 * values[i - 2] - values[i - 3]);
  }
  line.residual_std = std::sqrt(squares / (n - 2.0));
  // A third difference of white noise has 1 + 9 + 9 + 1 times its variance.
  line.step_std = std::sqrt(thirds / (20.0 * (n - 3.0)));
  line.slope_std = line.residual_std / std::sqrt(spread);
  return line;
}

/// Whether an axis is constant over `span_s`.
bool is_still(const std::vector<double>& axis, double span_s, double gravity_mps2) {
  constexpr double scatter_ratio = 1.5, most_scatter_mps2 = 1.0;
  const Line line = line_through(axis);
  const double per_s = static_cast<double>(axis.size()) / span_s;
  const double slope_mps3 = (std::abs(line.slope) + 2.0 * line.slope_std) * per_s;
  return slope_mps3 < standing_speed_radps * gravity_mps2 &&
         line.residual_std < most_scatter_mps2 &&
         line.residual_std <= scatter_ratio * line.step_std;
}

class Span {
 public:
  Span(const WheelReadings& readings, std::size_t first, std::size_t last)
      : readings_(readings), first_(first), last_(last) {}

  [[nodiscard]] bool stands() const {
    for (std::size_t s = 0; s < readings_.sensors.size(); ++s) {
      const PlanarReadings& sensor = readings_.sensors[s];
      for (const std::vector<double>* axis : {&sensor.u_mps2, &sensor.v_mps2})
        if (!is_still(values(s, *axis))) return false;
    }
    return true;
  }

 private:
  [[nodiscard]] std::vector<double> values(std::size_t sensor,
                                           const std::vector<double>& axis) const {
    std::vector<double> out;
    for (std::size_t k = first_; k < last_; ++k) {
      const std::int64_t row = readings_.epochs[k].row[sensor];
      if (row == WheelEpoch::no_row) continue;
      const double value = axis[static_cast<std::size_t>(row)];
      if (!std::isnan(value)) out.push_back(value);
    }
    return out;
  }
  [[nodiscard]] bool is_still(const std::vector<double>& axis) const {
    constexpr std::size_t fewest = 20;
    const double span_s = readings_.time_s[last_ - 1] - readings_.time_s[first_];
    return axis.size() >= fewest && span_s > 0.0 &&
           estimate::is_still(axis, span_s, readings_.gravity_mps2);
  }

  const WheelReadings& readings_;
  std::size_t first_, last_;
};

}  // namespace

void mark_standing(WheelReadings& readings) {
  const std::vector<double>& time_s = readings.time_s;
  const auto mark = [&](std::size_t first, std::size_t last) {
    if (!Span(readings, first, last).stands()) return;
    for (std::size_t k = first; k < last; ++k) readings.epochs[k].stands = true;
  };
  std::size_t first = 0;
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    if (time_s[k] - time_s[first] < standing_stretch_s) continue;
    mark(first, k + 1);
    first = k + 1;
  }
  // The remainder at the end is tested together with enough earlier samples for a whole interval.
  const auto before =
      std::ranges::lower_bound(time_s, time_s.back() - standing_stretch_s) - time_s.begin();
  if (first < time_s.size()) mark(static_cast<std::size_t>(before), time_s.size());
}

}  // namespace proofmass::estimate

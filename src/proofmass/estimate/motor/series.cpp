#include "proofmass/estimate/motor/series.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate::motor {
namespace {

constexpr double window_s = 0.12;       // of the cubic through the load's angle
constexpr double settle_s = 0.05;       // after the load has begun to move, until the flank bears
constexpr double least_share = 0.02;    // friction is known above this share of the top speed,
constexpr double braking_share = 0.03;  // of the largest current
constexpr double noise_factor = 4.0;    // and above this many standard deviations

// Σ j² and the other even moments over −h … h.
struct Moments246 {
  double two = 0.0, four = 0.0, six = 0.0;
  explicit Moments246(std::size_t half) {
    for (std::size_t j = 1; j <= half; ++j) {
      const double square = static_cast<double>(j * j);
      two += 2.0 * square;
      four += 2.0 * square * square;
      six += 2.0 * square * square * square;
    }
  }
  // Weight of y_j in the slope at the middle.
  [[nodiscard]] double weight(double j) const {
    return (six * j - four * j * j * j) / (two * six - four * four);
  }
};

double slope_at(const std::vector<double>& y, std::size_t k, std::size_t half) {
  if (half < 2) {
    const std::size_t next = std::min(k + 1, y.size() - 1), last = k > 0 ? k - 1 : 0;
    return (y[next] - y[last]) / static_cast<double>(next - last);
  }
  const Moments246 moments(half);
  double slope = 0.0;
  for (std::size_t j = 1; j <= half; ++j)
    slope += moments.weight(static_cast<double>(j)) * (y[k + j] - y[k - j]);
  return slope;
}

std::size_t samples_in(double duration_s, double step_s) {
  return static_cast<std::size_t>(std::ceil(duration_s / step_s));
}

// Where the voltage steps: the windows over which current and speed are smoothed mix what is before
// with what is behind. None if that is most of the recording, as by the pulses of a switched
// supply.
std::vector<bool> steps_of_voltage(const Series& series) {
  constexpr double step_share = 0.1, over_s = 0.02, around_s = 0.05, most = 0.5;
  const double top_v = largest_magnitude(series.voltage_v);
  const std::size_t n = series.size(), over = samples_in(over_s, series.step_s),
                    around = samples_in(around_s, series.step_s);
  std::vector<bool> out(n, false);
  for (std::size_t k = over; k < n; ++k)
    if (std::abs(series.voltage_v[k] - series.voltage_v[k - over]) > step_share * top_v)
      std::fill(out.begin() + static_cast<std::ptrdiff_t>(k - std::min(k, over + around)),
                out.begin() + static_cast<std::ptrdiff_t>(std::min(n, k + around + 1)), true);
  const auto count = static_cast<double>(std::ranges::count(out, true));
  if (count > most * static_cast<double>(n)) out.assign(n, false);
  return out;
}

std::int8_t direction(double speed_radps, double least_radps) {
  if (!(std::abs(speed_radps) > least_radps)) return 0;
  return speed_radps > 0.0 ? std::int8_t{1} : std::int8_t{-1};
}

// Where the current opposes the motion.
std::vector<bool> where_it_brakes(const Series& series, const Motion& motion) {
  const double least_a = braking_share * largest_magnitude(series.current_a);
  std::vector<bool> out;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const std::int8_t towards = direction(motion.speed_radps[k], motion.rest_radps);
    out.push_back(series.current_a[k] * towards < -least_a);
  }
  return out;
}

// Where the load may lie in the gap: between the play operators that start from both flanks.
class PossibleLoad {
 public:
  PossibleLoad(double motor_rad, double gap_rad)
      : half_(0.5 * gap_rad), low_(motor_rad - half_), high_(motor_rad + half_) {}

  /// The next angle of the motor: +1 or −1 if it pushes a load whose place is known forwards or
  /// backwards, else 0.
  int follow(double motor_rad, bool brakes) {
    const double low = motor_rad - half_, high = motor_rad + half_;
    const double last_low = low_, last_high = high_;
    low_ = brakes ? low : std::clamp(last_low, low, high);
    high_ = brakes ? high : std::clamp(last_high, low, high);
    if (low_ != high_) return 0;
    return (low_ > last_low && high_ > last_high ? 1 : 0) -
           (low_ < last_low && high_ < last_high ? 1 : 0);
  }

 private:
  double half_, low_, high_;
};

}  // namespace

bool Motion::has_both_flanks() const {
  return std::ranges::count(contact, std::int8_t{1}) > 0 &&
         std::ranges::count(contact, std::int8_t{-1}) > 0;
}

std::size_t Motion::reversals() const {
  std::size_t count = 0;
  int last = 0;
  for (const std::int8_t flank : contact) {
    if (flank == 0) continue;
    if (flank == -last) ++count;
    last = flank;
  }
  return count;
}

double Motion::top_radps() const {
  // Impacts of the gear are far outside.
  constexpr double share = 0.99;
  std::vector<double> sizes;
  for (const double w : speed_radps) sizes.push_back(std::abs(w));
  return quantile(sizes, share).value_or(0.0);
}

double largest_magnitude(const std::vector<double>& values) {
  double out = 0.0;
  for (const double v : values) out = std::max(out, std::abs(v));
  return out;
}

double sample_noise(const std::vector<double>& values) {
  std::vector<double> thirds;
  for (std::size_t k = 3; k < values.size(); ++k)
    thirds.push_back(values[k] - 3.0 * values[k - 1] + 3.0 * values[k - 2] - values[k - 3]);
  return robust_std(thirds).value_or(0.0) / std::sqrt(20.0);
}

std::vector<double> slopes(const std::vector<double>& y, double step_s, std::size_t half) {
  std::vector<double> out(y.size(), 0.0);
  if (y.size() < 2) return out;
  for (std::size_t k = 0; k < y.size(); ++k)
    out[k] = slope_at(y, k, std::min({half, k, y.size() - 1 - k})) / step_s;
  return out;
}

double slope_noise(std::size_t half) {
  const Moments246 moments(half);
  double squares = 0.0;
  for (std::size_t j = 1; j <= half; ++j)
    squares += 2.0 * std::pow(moments.weight(static_cast<double>(j)), 2);
  return std::sqrt(squares);
}

std::vector<double> integral(const std::vector<double>& y, double step_s) {
  std::vector<double> out(y.size(), 0.0);
  for (std::size_t k = 1; k < y.size(); ++k) out[k] = out[k - 1] + 0.5 * step_s * (y[k - 1] + y[k]);
  return out;
}

void shorten_runs(std::vector<std::int8_t>& contact, std::size_t margin) {
  const std::size_t n = contact.size();
  for (std::size_t first = 0; first < n;) {
    std::size_t last = first + 1;
    while (last < n && contact[last] == contact[first]) ++last;
    for (std::size_t k = first; k < last; ++k)
      if (k < first + margin || k + margin >= last) contact[k] = 0;
    first = last;
  }
}

std::size_t half_window(double window_s, double step_s) {
  return std::max<std::size_t>(3, static_cast<std::size_t>(std::lround(0.5 * window_s / step_s)));
}

std::vector<double> smoothed(const std::vector<double>& y, double step_s, double window_s) {
  return slopes(integral(y, step_s), step_s, half_window(window_s, step_s));
}

Motion motion_of_load(const Series& series) {
  const std::size_t half = half_window(window_s, series.step_s);
  Motion motion{.speed_radps = slopes(series.angle_rad, series.step_s, half),
                .angle_rad = smoothed(series.angle_rad, series.step_s, window_s),
                .half_window = half};
  const double std_radps = slope_noise(half) * sample_noise(series.angle_rad) / series.step_s;
  motion.rest_radps = std::max(noise_factor * std_radps, least_share * motion.top_radps());
  // The flank on which the motor drives the load, once the load has moved one way for settle_s.
  for (std::size_t k = 0; k < series.size(); ++k)
    motion.contact.push_back(
        series.bridged[k] ? std::int8_t{0} : direction(motion.speed_radps[k], motion.rest_radps));
  shorten_runs(motion.contact, std::max(samples_in(settle_s, series.step_s), half + 1));
  return motion;
}

void subtract_current_offset(const Motion& load, Series& series) {
  constexpr double least_s = 0.5, no_voltage_share = 0.01, settled_s = 0.1;
  const double top_v = largest_magnitude(series.voltage_v);
  std::vector<double> at_rest;
  double since_s = 0.0;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const bool idle = std::abs(load.speed_radps[k]) < load.rest_radps && !series.bridged[k] &&
                      std::abs(series.voltage_v[k]) < no_voltage_share * top_v;
    since_s = idle ? since_s + series.step_s : 0.0;
    if (since_s > settled_s) at_rest.push_back(series.sampled_current_a[k]);
  }
  if (static_cast<double>(at_rest.size()) * series.step_s < least_s) return;
  const double offset = median(at_rest).value_or(0.0);
  for (double& i : series.current_a) i -= offset;
  for (double& i : series.sampled_current_a) i -= offset;
  series.current_offset_a = offset;
}

Motion motion_of_motor(const Series& series,
                       const std::vector<double>& motor_rad,
                       std::vector<double> load_rad,
                       MotorSpeed speed,
                       double gap_rad) {
  Motion motion{.speed_radps = std::move(speed.radps),
                .angle_rad = std::move(load_rad),
                .half_window = speed.half_window};
  motion.rest_radps = std::max(noise_factor * speed.std_radps, least_share * motion.top_radps());
  motion.contact.assign(series.size(), 0);
  const std::size_t margin = samples_in(settle_s, series.step_s);
  const std::vector<bool> braking = where_it_brakes(series, motion),
                          steps = steps_of_voltage(series);
  PossibleLoad load(motor_rad.front(), gap_rad);
  std::size_t bearing = 0;  // samples since the flank was reached
  for (std::size_t k = 0; k < series.size(); ++k) {
    const std::int8_t towards = direction(motion.speed_radps[k], motion.rest_radps);
    const int pushed = load.follow(motor_rad[k], braking[k]);
    bearing = towards != 0 && pushed == towards && !series.bridged[k] ? bearing + 1 : 0;
    if (bearing > margin && !steps[k]) motion.contact[k] = towards;
  }
  shorten_runs(motion.contact, speed.half_window + 1);
  return motion;
}

}  // namespace proofmass::estimate::motor

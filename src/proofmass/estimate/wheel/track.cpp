#include <limits>
#include <span>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/doubts.hpp"
#include "proofmass/estimate/wheel/encoder.hpp"
#include "proofmass/estimate/wheel/gyro_jerk.hpp"
#include "proofmass/estimate/wheel/likelihood.hpp"

namespace proofmass::estimate {
namespace {

/// Constants have a tight prior while the phase is being found: a free bias would absorb it.
constexpr ConstantsPrior seeking_prior{0.3, 0.03, 0.01, 0.5, 0.15};

struct Seek {
  double accel_std_mps2;  ///< of a measurement at 120 Hz
  WheelNoise noise;
};

/// Noise parameters for tracking a wheel without prior knowledge, from a car's wheel on the road to
/// a bench with little vibration. The first set that keeps the phase is used.
constexpr std::array<Seek, wheel_seeks> seeks{
    Seek{1.5, {20.0, 0.0, 1e-7}}, Seek{3.0, {100.0, 0.0, 1e-7}}, Seek{1.5, {500.0, 0.0, 1e-7}},
    Seek{0.5, {200.0, 0.0, 1e-7}}};

void set_variance(WheelReadings& readings, double accel_std_mps2) {
  // The same density whatever the rate.
  const double variance =
      accel_std_mps2 * accel_std_mps2 * std::max(readings.rate_hz(), 1.0) / 120.0;
  for (PlanarReadings& sensor : readings.sensors)
    sensor.variance_m2ps4.assign(sensor.u_mps2.size(), variance);
}

/// Mean gravity phase of the first few measurements.
double first_phase(const PlanarReadings& sensor) {
  double u = 0.0, v = 0.0;
  int seen = 0;
  for (std::size_t k = 0; k < sensor.u_mps2.size() && seen < 5; ++k) {
    if (std::isnan(sensor.u_mps2[k]) || std::isnan(sensor.v_mps2[k])) continue;
    u += sensor.u_mps2[k];
    v += sensor.v_mps2[k];
    ++seen;
  }
  return std::atan2(u, v);
}

/// From rest outwards: 0, 1.5, −1.5, 3, −3 … rad/s, up to the limit set by the rate.
std::vector<double> speeds_to_try(double rate_hz, double step_radps) {
  std::vector<double> speeds{0.0};
  const double top = std::min(fastest_radps(rate_hz), 120.0);
  for (double speed = step_radps; speed <= top; speed += step_radps) {
    speeds.push_back(speed);
    speeds.push_back(-speed);
  }
  return speeds;
}

/// The start that predicts the first four seconds best.
Beginning seek_beginning(const WheelReadings& readings, const WheelNoise& noise) {
  constexpr double window_s = 4.0, speed_step_radps = 1.5;
  const auto model = wheel_model<1>(readings, noise);
  const auto last = static_cast<std::size_t>(
      std::ranges::upper_bound(readings.time_s, readings.time_s.front() + window_s) -
      readings.time_s.begin());
  const double phase = first_phase(readings.sensors.front());
  Beginning best;
  double best_lost = std::numeric_limits<double>::infinity();
  std::size_t innovations = 0;  // of a whole window
  for (const double speed : speeds_to_try(readings.rate_hz(), speed_step_radps))
    for (int quarter = 0; quarter < 4; ++quarter) {
      const Beginning candidate{phase + quarter * std::numbers::pi / 2.0, 0.6, speed,
                                0.7 * speed_step_radps};
      auto state = prior_state<1>({candidate, seeking_prior, {}});
      StepOf<WheelModel<1>> step;
      LostShare lost(readings.gravity_mps2);
      // A later candidate must be clearly better: at rest, many explain little.
      const double most_lost = 0.95 * best_lost;
      for (std::size_t k = 0; k < last; ++k) {
        advance(model, k, wheel_gate, state, step);
        lost.add(step);
        if (innovations > 0 && lost.share_of(innovations) >= most_lost) break;
      }
      if (innovations == 0) innovations = lost.readings();
      if (lost.readings() < innovations || lost.share() >= most_lost) continue;
      best_lost = lost.share();
      best = candidate;
    }
  return best;
}

/// Appends the average of one sensor's measurements at these epochs. Returns its row, no_row if it
/// has none.
std::int64_t append_average(const PlanarReadings& sensor,
                            std::size_t index,
                            std::span<const WheelEpoch> epochs,
                            PlanarReadings& out) {
  double u = 0.0, v = 0.0, variance = 0.0, count = 0.0, speeds = 0.0;
  Mat<3> rate = Mat<3>::Zero();  // about the axle, along u and v
  for (const WheelEpoch& epoch : epochs) {
    const std::int64_t row = epoch.row[index];
    const auto at = static_cast<std::size_t>(row);
    if (row == WheelEpoch::no_row || !sensor.has(at)) continue;
    u += sensor.u_mps2[at];
    v += sensor.v_mps2[at];
    variance += sensor.variance_m2ps4[at];
    count += 1.0;
    if (sensor.speed_radps.empty() || std::isnan(sensor.speed_radps[at])) continue;
    rate += Mat<3>(sensor.speed_radps[at], sensor.rate_u_radps[at], sensor.rate_v_radps[at]);
    speeds += 1.0;
  }
  if (count == 0.0) return WheelEpoch::no_row;
  out.u_mps2.push_back(u / count);
  out.v_mps2.push_back(v / count);
  out.variance_m2ps4.push_back(variance / (count * count));
  if (!sensor.speed_radps.empty()) {
    rate /= speeds;  // NaN without any
    out.speed_radps.push_back(rate(0));
    out.rate_u_radps.push_back(rate(1));
    out.rate_v_radps.push_back(rate(2));
  }
  return static_cast<std::int64_t>(out.u_mps2.size()) - 1;
}

/// Share of unexplained measurements below which no further noise parameters are tried.
constexpr double clearly_found = 0.3;

/// find_track() on these measurements.
WheelTrack seek_track(WheelReadings& readings, std::size_t first) {
  WheelTrack best;
  best.lost = std::numeric_limits<double>::infinity();
  ConstantsPrior prior = seeking_prior;
  prior.axle_slopes[0] = readings.sensors[0].axle_slope;
  if (!readings.sensors[0].speed_radps.empty())
    prior.rolling_m = rolling_prior_std_m(readings, false);
  for (std::size_t i = first; i < seeks.size(); ++i) {
    const Seek& seek = seeks[i];
    set_variance(readings, seek.accel_std_mps2);
    const auto model = wheel_model<1>(readings, seek.noise);
    const Beginning beginning = seek_beginning(readings, seek.noise);
    Traced<1> traced = trace_path(model, prior_state<1>({beginning, prior, {}}));
    // A filter that follows every vibration predicts slightly better without being better.
    if (traced.lost >= 0.6 * best.lost) continue;
    const Mat<wheel::moving>& at = traced.path.moving.front();
    best = {.beginning = {at(wheel::angle), 0.2, at(wheel::speed), beginning.speed_std_radps},
            .noise = seek.noise,
            .path = std::move(traced.path),
            .lost = traced.lost};
    if (best.lost < clearly_found) break;
  }
  return best;
}

/// Whether the wheel turns by less than a twentieth of a radian between measurements.
bool turns_little(const WheelReadings& readings, const WheelTrack& track) {
  const double most_radps = 0.05 * readings.rate_hz();
  return std::ranges::all_of(track.path.moving, [&](const Mat<wheel::moving>& at) {
    return std::abs(at(wheel::speed)) < most_radps;
  });
}

}  // namespace

double WheelReadings::rate_hz() const {
  // The mean step, not the median: rows that arrive in packets have nearly equal stamps. Gaps are
  // excluded.
  constexpr double gap_share = 0.01, gap_factor = 5.0;
  std::vector<double> steps;
  steps.reserve(epochs.size());
  for (const WheelEpoch& epoch : epochs)
    if (epoch.dt_s > 0.0) steps.push_back(epoch.dt_s);
  if (steps.empty()) return 0.0;
  const double gap_s = gap_factor * *quantile(steps, 1.0 - gap_share);
  double sum_s = 0.0, count = 0.0;
  for (const double step : steps) {
    if (step > gap_s) continue;
    sum_s += step;
    count += 1.0;
  }
  return count / sum_s;
}

WheelReadings averaged(const WheelReadings& readings, std::size_t each) {
  PM_EXPECTS(each >= 1);
  WheelReadings out{.gravity_mps2 = readings.gravity_mps2,
                    .gravity_std_mps2 = readings.gravity_std_mps2,
                    .given_rolling_radius_m = readings.given_rolling_radius_m,
                    .found_rolling_radius_m = readings.found_rolling_radius_m,
                    .rolling_radius_m = readings.rolling_radius_m,
                    .delay_s = readings.delay_s,
                    .phase_rad = readings.phase_rad,
                    .orders = readings.orders,
                    .one_speed = readings.one_speed,
                    .shakes = readings.shakes,
                    .time_s = {},
                    .epochs = {},
                    .sensors = std::vector<PlanarReadings>(readings.sensors.size())};
  if (readings.encoder) out.encoder = averaged(*readings.encoder, readings.time_s, each);
  for (std::size_t s = 0; s < readings.sensors.size(); ++s) {
    out.sensors[s].speed_variance = readings.sensors[s].speed_variance / static_cast<double>(each);
    out.sensors[s].speed_scatter2 = readings.sensors[s].speed_scatter2 / static_cast<double>(each);
    out.sensors[s].axle_slope = readings.sensors[s].axle_slope;
  }
  const std::span all(readings.epochs);
  for (std::size_t first = 0; first < all.size(); first += each) {
    const auto epochs = all.subspan(first, std::min(each, all.size() - first));
    Moments times_s;
    for (std::size_t k = first; k < first + epochs.size(); ++k) times_s.add(readings.time_s[k]);
    const double time_s = times_s.mean;
    WheelEpoch averaged;
    averaged.spread_s2 = times_s.squares / static_cast<double>(times_s.count);
    averaged.stands = std::ranges::all_of(epochs, &WheelEpoch::stands);
    for (std::size_t s = 0; s < readings.sensors.size(); ++s)
      averaged.row[s] = append_average(readings.sensors[s], s, epochs, out.sensors[s]);
    averaged.dt_s = out.time_s.empty() ? 0.0 : time_s - out.time_s.back();
    out.time_s.push_back(time_s);
    out.epochs.push_back(averaged);
  }
  mark_jerks(out);
  return out;
}

WheelTrack find_track(WheelReadings& readings, std::size_t first) {
  PM_EXPECTS(readings.sensors.size() == 1 && readings.epochs.size() >= 2);
  // At least two averages to the limit of the search, so that none is mistaken for a slow wheel.
  constexpr std::size_t each = 4, long_recording = 200'000;
  if (readings.epochs.size() >= long_recording) {
    WheelReadings averages = averaged(readings, each);
    WheelTrack track = seek_track(averages, first);
    if (track.lost < clearly_found && turns_little(averages, track)) {
      readings.sensors[0].variance_m2ps4.assign(
          readings.sensors[0].u_mps2.size(),
          static_cast<double>(each) * averages.sensors[0].variance_m2ps4.front());
      track.path.moving = moving_at(readings.time_s, averages.time_s, track.path.moving);
      return track;
    }
  }
  return seek_track(readings, first);
}

bool shows_gravity(const WheelReadings& readings, const WheelTrack& track) {
  constexpr double least_s = 4.0, most_doubted = 0.1;
  const double duration_s = readings.time_s.back() - readings.time_s.front();
  if (duration_s < least_s) return false;
  auto model = wheel_model<1>(readings, track.noise);
  model.with_gyro = false;
  std::vector<WheelDoubt> doubts;
  GravityShown<1> gravity(model, readings, doubts);
  Mat<wheel::states(1)> at;
  at.tail<wheel::standing(1)>() = track.path.standing;
  for (std::size_t k = 0; k < model.size(); ++k) {
    at.head<wheel::moving>() = track.path.moving[k];
    gravity.add(k, at);
  }
  double doubted_s = 0.0;
  for (const WheelDoubt& doubt : doubts)
    doubted_s += readings.time_s[doubt.last] - readings.time_s[doubt.first];
  return doubted_s < most_doubted * duration_s;
}

}  // namespace proofmass::estimate

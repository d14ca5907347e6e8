#include "proofmass/estimate/wheel/fit.hpp"

#include <cmath>
#include <limits>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/in_parallel.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/coarse_fit.hpp"
#include "proofmass/estimate/wheel/colour.hpp"
#include "proofmass/estimate/wheel/doubts.hpp"
#include "proofmass/estimate/wheel/encoder.hpp"
#include "proofmass/estimate/wheel/held_figures.hpp"
#include "proofmass/estimate/wheel/rivals.hpp"
#include "proofmass/estimate/wheel/settle.hpp"

namespace proofmass::estimate {
namespace {

void resize(WheelSeries& series, std::size_t size) {
  for (std::vector<double>* column :
       {&series.angle_rad, &series.angle_std_rad, &series.speed_radps, &series.speed_std_radps,
        &series.accel_radps2, &series.accel_std_radps2, &series.filtered_angle_rad,
        &series.filtered_angle_std_rad})
    column->resize(size);
  series.nis.resize(size);
  series.channels_used.resize(size);
  series.channels_gated.resize(size);
}

/// Channels of each sensor: along u, along v and, with a gyroscope, about the axle.
template <int S>
std::size_t channels_each(const WheelModel<S>& model) {
  return model.with_gyro ? 3 : 2;
}

/// Those of all sensors, then the encoder's.
template <int S>
std::size_t channels_of(const WheelModel<S>& model) {
  return S * channels_each(model) + (model.encoder != nullptr ? 1 : 0);
}

template <int S>
void note_forward(const WheelModel<S>& model,
                  std::size_t k,
                  const StepOf<WheelModel<S>>& step,
                  ConsistencyCheck& check,
                  WheelFit& fit) {
  double nis = 0.0;
  unsigned char used = 0, gated = 0;
  const std::size_t each = channels_each(model);
  std::size_t next = 0;
  const auto note = [&](std::size_t channel) {
    const auto& u = step.updates[next++];
    check.add(channel, u.innovation, u.expected, u.used);
    nis += u.used ? u.nis() : 0.0;
    ++(u.used ? used : gated);
  };
  for (std::size_t s = 0; s < static_cast<std::size_t>(S); ++s) {
    if (!model.has_readings(s, k)) continue;
    const std::size_t read = model.has_speed(s, k) ? 3 : 2;
    for (std::size_t channel = each * s; channel < each * s + read; ++channel) note(channel);
  }
  if (model.has_encoder(k)) note(each * S);
  fit.series.nis[k] = static_cast<float>(nis);
  fit.series.channels_used[k] = used;
  fit.series.channels_gated[k] = gated;
}

template <int S>
void note_backward(const WheelModel<S>& model,
                   std::size_t k,
                   const StepOf<WheelModel<S>>& step,
                   const BackwardInformation<wheel::states(S)>& later,
                   WheelFit& fit) {
  WheelSeries& series = fit.series;
  const Mat<wheel::states(S)> mean = later.mean(step.filtered);
  const auto now = model.motion(mean);
  const auto std_of = [&](const Mat<wheel::states(S)>& slope) {
    return std::sqrt(std::max(later.variance(step.filtered, slope), 0.0));
  };
  series.angle_rad[k] = now.angle;
  series.angle_std_rad[k] = std_of(now.by_angle);
  series.speed_radps[k] = now.speed;
  series.speed_std_radps[k] = std_of(now.by_speed);
  series.accel_radps2[k] = now.accel;
  series.accel_std_radps2[k] = std_of(now.by_accel);
  fit.track.path.moving[k] = mean.template head<wheel::moving>();
}

/// The extended filter as it would run on calibrated sensors, the initial motion unknown.
template <int S>
void filter_calibrated(const WheelModel<S>& model,
                       const WheelPrior& prior,
                       const Calibrated<S>& known,
                       WheelSeries& series) {
  constexpr int count = wheel::standing(S);
  auto state = prior_state<S>(prior);
  state.x.mean.template tail<count>() = known.mean;
  state.x.cov.template bottomRightCorner<count, count>() = known.cov;
  filter(model, {0, model.size()}, wheel_gate, state, [&](std::size_t k, const auto& step) {
    const auto now = model.motion(step.filtered.mean);
    series.filtered_angle_rad[k] = now.angle;
    series.filtered_angle_std_rad[k] =
        std::sqrt(std::max(now.by_angle.dot(step.filtered.cov * now.by_angle), 0.0));
  });
}

/// From the state after the last epoch.
template <int S>
void take_constants(const Gaussian<wheel::states(S)>& end,
                    const Settled<S>& settled,
                    WheelFit& fit) {
  constexpr int count = wheel::standing(S);
  fit.constants = end.mean.template tail<count>();
  const auto by = settled.widened.asDiagonal();
  const auto of_passes = end.cov.template bottomRightCorner<count, count>();
  fit.constants_cov = by * of_passes * by;
  fit.constants_widened = fit.constants_cov - of_passes;
}

/// At epoch k, before its measurements, from the state after those of k − 1.
template <int S>
Gaussian<wheel::moving> predicted_motion(const WheelModel<S>& model,
                                         std::size_t k,
                                         const Gaussian<wheel::states(S)>& before) {
  const auto transition = model.transition(before.mean, k);
  const auto cov = before.cov.template topLeftCorner<wheel::moving, wheel::moving>();
  return {transition.mean, transition.F * cov * transition.F.transpose() + transition.Q};
}

/// Results of filter and smoother with the lever arms held at their estimates.
template <int S>
WheelFit smooth_at_places(const WheelReadings& readings,
                          const Settled<S>& settled,
                          const WheelPath& about,
                          const Calibrated<S>& known,
                          const Progress& progress) {
  const auto model = held_model<S>(readings, settled.noise, about);
  const std::size_t size = model.size();
  WheelFit fit;
  resize(fit.series, size);
  fit.series.time_s = readings.time_s;
  fit.track = {
      .beginning = settled.prior.beginning, .noise = settled.noise, .path = about, .tuned = true};
  const auto prior = prior_state<S>(settled.prior);
  Gaussian<wheel::states(S)> end = prior.x;
  ConsistencyCheck check({.channels = std::vector<std::string>(channels_of(model)),
                          .rate_hz = readings.rate_hz(),
                          .gate = wheel_gate.limit});
  AngleColour<S> colour;
  LostShare lost(readings.gravity_mps2);
  std::vector<WheelDoubt> unseen;
  GravityShown<S> gravity(model, readings, unseen);
  const auto report = [&](std::string_view stage, std::size_t done) {
    if (progress && done % 65536 == 0)
      progress(stage, static_cast<double>(done) / static_cast<double>(size));
  };
  const auto there_and_back = [&] {
    smooth(
        model, prior, wheel_gate,
        [&](std::size_t k, const auto& step) {
          if (k > 0) {
            const Gaussian<wheel::moving> predicted = predicted_motion(model, k, end);
            end.mean.template head<wheel::moving>() = predicted.mean;
            gravity.add(k, end.mean);
            if (readings.time_s[k] > readings.time_s.front() + 1.0 &&
                predicted.cov(wheel::angle, wheel::angle) > square(lost_prediction_rad))
              add_doubt(k, predicted, readings.time_s, fit.doubts);
          }
          end = step.filtered;
          colour.add(step);
          lost.add(step);
          note_forward(model, k, step, check, fit);
          report("filter", k);
        },
        [&](std::size_t k, const auto& step, const auto& later) {
          note_backward(model, k, step, later, fit);
          report("smoother", size - k);
        });
  };
  run_tasks(size,
            {there_and_back, [&] { filter_calibrated(model, settled.prior, known, fit.series); }});
  doubt_smoothed(model, readings, end, unseen, fit);
  fit.track.lost = lost.share();
  fit.consistency = check.judge();
  take_constants(end, settled, fit);
  fit.turns = turns_in(model, end);
  const std::size_t half = size / 2;
  const double wider =
      colour.factor(fit.series.angle_std_rad[half] * fit.series.angle_std_rad[half]);
  fit.turns.std *= wider;
  for (std::vector<double>* std : {&fit.series.angle_std_rad, &fit.series.filtered_angle_std_rad,
                                   &fit.series.speed_std_radps, &fit.series.accel_std_radps2})
    for (double& value : *std) value *= wider;
  fit.ekf_turns =
      (fit.series.filtered_angle_rad.back() - fit.series.filtered_angle_rad.front()) / rad_per_turn;
  return fit;
}

/// The constants of smooth_at_places() alone.
template <int S>
WheelFit constants_at_places(const WheelReadings& readings,
                             const Settled<S>& settled,
                             const WheelPath& about) {
  WheelFit fit;
  fit.track = {
      .beginning = settled.prior.beginning, .noise = settled.noise, .path = about, .tuned = true};
  auto state = prior_state<S>(settled.prior);
  LostShare lost(readings.gravity_mps2);
  const auto model = held_model<S>(readings, settled.noise, about);
  filter(model, {0, model.size()}, wheel_gate, state,
         [&](std::size_t, const auto& step) { lost.add(step); });
  fit.track.lost = lost.share();
  take_constants(state.x, settled, fit);
  return fit;
}

/// Gravity is the reference of scales and lever arms: if it is larger by a fraction, the scales are
/// smaller and the lever arms larger by that fraction, the angle unchanged. `believed` is the share
/// of the lever arms' information from their prior, which does not depend on gravity.
template <int S>
void add_gravity_uncertainty(const WheelReadings& readings,
                             const Eigen::MatrixXd& believed,
                             WheelFit& fit) {
  const double part = readings.gravity_std_mps2 / readings.gravity_mps2;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(fit.constants.size());
  for (int s = 0; s < S; ++s) {
    const int at = wheel::first_of(s) - wheel::first_of(0) + wheel::scale;
    change.segment<2>(at) = -part * (fit.constants.segment<2>(at).array() + 1.0);
  }
  const Places places = fit.constants.tail<2 * S>();
  change.tail<2 * S>() = part * (places - believed * places);
  fit.constants_cov += change * change.transpose();
}

/// An accelerometer's nonlinearity κ at 1 g resembles errors of the encoder once a turn, of κ/√2 in
/// each component, and twice a turn, of half of that (docs/methods/encoder.md).
template <int S>
void add_nonlinearity(double nonlinearity, WheelFit& fit) {
  constexpr int first = wheel::encoder(S) - wheel::first_of(0) + 1;
  for (int n = 1; n <= wheel::encoder_orders; ++n)
    for (int i = 0; i < 2; ++i) {
      const int at = first + 2 * (n - 1) + i;
      fit.constants_cov(at, at) += 0.5 * square(nonlinearity / n);
    }
  WheelSeries& series = fit.series;
  for (std::vector<double>* std : {&series.angle_std_rad, &series.filtered_angle_std_rad})
    for (double& value : *std) add_in_square(value, nonlinearity);
  add_in_square(fit.turns.std, std::numbers::sqrt2 * nonlinearity / rad_per_turn);
}

/// The errors of the encoder with its rounding as in coherent_rounding_rad().
template <int S>
void add_rounding(const WheelReadings& readings, WheelFit& fit) {
  constexpr int first = wheel::encoder(S) - wheel::first_of(0);
  const EncoderReadings& encoder = *readings.encoder;
  std::vector<double> own_rad(encoder.angle_rad.size());
  for (std::size_t k = 0; k < own_rad.size(); ++k) {
    double shown = fit.series.angle_rad[k] - encoder.age_s[k] * fit.series.speed_radps[k] +
                   encoder.zero_rad + fit.constants(first);
    for (int n = 1; n <= wheel::encoder_orders; ++n)
      shown += encoder.direction *
               (std::cos(n * encoder.angle_rad[k]) * fit.constants(first + 2 * n - 1) +
                std::sin(n * encoder.angle_rad[k]) * fit.constants(first + 2 * n));
    own_rad[k] = encoder.direction * shown;
  }
  const auto more_rad = coherent_rounding_rad(encoder, readings.time_s, own_rad);
  for (int i = 0; i < wheel::encoder_states - 1; ++i)
    fit.constants_cov(first + 1 + i, first + 1 + i) +=
        square(more_rad[static_cast<std::size_t>(i)]);
}

/// Where the wheel rests, its angle is that of gravity with the errors of bias, scale and skew,
/// δφ = (cos φ δz_u − sin φ δz_v) / g. Motion averages them over a turn.
template <int S>
void widen_at_rest(const WheelReadings& readings, WheelFit& fit) {
  const auto by_constants = [&](std::size_t k) {
    Eigen::VectorXd by = Eigen::VectorXd::Zero(fit.constants.size());
    if (!readings.epochs[k].stands) return by;
    for (int s = 0; s < S; ++s) {
      const double phase =
          s > 0 ? readings.phase_rad + fit.constants(wheel::phase - wheel::first_of(0)) : 0.0;
      const double phi = fit.series.angle_rad[k] + phase;
      const double c = std::cos(phi) / S, sin_phi = std::sin(phi), cos_phi = std::cos(phi);
      const double d = -sin_phi / S, g = readings.gravity_mps2;
      const int at = wheel::first_of(s) - wheel::first_of(0);
      by.segment<2>(at + wheel::bias) << c / g, d / g;
      by.segment<2>(at + wheel::scale) << c * sin_phi, d * cos_phi;
      by(at + wheel::skew) = c * cos_phi + d * sin_phi;
    }
    return by;
  };
  const auto std_of = [&](const Eigen::VectorXd& by) {
    return std::sqrt(std::max(by.dot(fit.constants_widened * by), 0.0));
  };
  WheelSeries& series = fit.series;
  for (std::size_t k = 0; k < series.angle_rad.size(); ++k) {
    if (!readings.epochs[k].stands) continue;
    const double more_rad = std_of(by_constants(k));
    add_in_square(series.angle_std_rad[k], more_rad);
    add_in_square(series.filtered_angle_std_rad[k], more_rad);
  }
  add_in_square(fit.turns.std,
                std_of(by_constants(series.angle_rad.size() - 1) - by_constants(0)) / rad_per_turn);
}

template <int S>
WheelFit fit_sensors(WheelReadings& readings,
                     WheelTrack track,
                     const PlacesPrior& belief,
                     FitDepth depth,
                     const Progress& progress) {
  constexpr int ripple_at = wheel::ripple(S) - wheel::first_of(0);
  if (track.path.standing.segment<2 * wheel::ripple_orders>(ripple_at).isZero())
    readings.orders = orders_in<S>(readings, track.path);
  auto [each, coarse, coarse_track, settled] =
      settle_on_averages<S>(readings, track, belief, depth, progress);
  // A warm-up is not a random walk: it drifts fastest at the start, where the count of turns
  // begins.
  settled.noise.bias_walk_psd *= 3.0;
  const Calibrated<S> known = improve(coarse, settled, coarse_track);
  settled.prior.beginning = coarse_track.beginning;
  spread_variance(coarse, each, readings);
  readings.rolling_radius_m = coarse.rolling_radius_m;
  if (readings.encoder) readings.encoder->more = coarse.encoder->more;
  if (depth == FitDepth::track)
    return smooth_at_places(coarse, settled, coarse_track.path, known, progress);
  track = spread_track(coarse_track, coarse, readings);
  WheelFit fit;
  if (depth == FitDepth::constants) {
    fit = constants_at_places(coarse, settled, coarse_track.path);
  } else {
    settle_variance(held_model<S>(readings, settled.noise, track.path), settled.prior, readings);
    fit = smooth_at_places(readings, settled, track.path, known, progress);
  }
  readings.shakes = coarse.shakes;
  constexpr int count = wheel::standing(S);
  fit.constants_prior_cov =
      prior_state<S>(settled.prior).x.cov.template bottomRightCorner<count, count>();
  fit.constants_prior_cov.template bottomRightCorner<2 * S, 2 * S>() = belief.cov;
  add_held_figures(settled, coarse, coarse_track.path, readings, track.path, fit);
  add_gravity_uncertainty<S>(readings, settled.places_cov * positive_inverse(belief.cov), fit);
  if (depth == FitDepth::constants) {
    fit.track.path.moving = std::move(track.path.moving);
    return fit;
  }
  widen_at_rest<S>(readings, fit);
  if (readings.encoder) {
    add_nonlinearity<S>(readings.encoder->nonlinearity, fit);
    add_rounding<S>(readings, fit);
  }
  fit.turns_candidates = turns_candidates(fit);
  return fit;
}

}  // namespace

Uncertain combined(const Uncertain& a, const Uncertain& b) {
  const double of_a = 1.0 / square(a.std), of_b = 1.0 / square(b.std);
  return {(of_a * a.value + of_b * b.value) / (of_a + of_b), 1.0 / std::sqrt(of_a + of_b)};
}

void assume_rolling_radius(WheelReadings& readings) {
  constexpr double of_given = 0.03, vehicle_m = 0.4, smooth_m = 0.05;
  if (readings.given_rolling_radius_m) {
    const double given_m = *readings.given_rolling_radius_m;
    readings.rolling_radius_m = {given_m, of_given * given_m};
    return;
  }
  readings.rolling_radius_m =
      readings.shakes ? Uncertain{vehicle_m / 2.0, vehicle_m / std::numbers::sqrt3 / 2.0}
                      : Uncertain{0.0, smooth_m};
  if (readings.found_rolling_radius_m)
    readings.rolling_radius_m =
        combined(readings.rolling_radius_m, *readings.found_rolling_radius_m);
}

double rolling_prior_std_m(const WheelReadings& readings, bool shakes_known) {
  constexpr double unknown_m = 0.2;
  if (readings.given_rolling_radius_m || readings.found_rolling_radius_m)
    return readings.rolling_radius_m.std;
  return shakes_known && !readings.shakes ? 0.0 : unknown_m;
}

WheelFit fit_wheel(WheelReadings& readings,
                   WheelTrack track,
                   const PlacesPrior& places_prior,
                   FitDepth depth,
                   const Progress& progress) {
  PM_EXPECTS(!readings.sensors.empty() && readings.sensors.size() <= 2);
  PM_EXPECTS(readings.epochs.size() >= 2 && track.path.moving.size() == readings.epochs.size());
  if (readings.sensors.size() == 1)
    return fit_sensors<1>(readings, std::move(track), places_prior, depth, progress);
  return fit_sensors<2>(readings, std::move(track), places_prior, depth, progress);
}

}  // namespace proofmass::estimate

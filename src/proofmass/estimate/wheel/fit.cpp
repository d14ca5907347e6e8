#include "proofmass/estimate/wheel/fit.hpp"

#include "proofmass/core/contract.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/colour.hpp"
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

/// Between the first epoch and the last, from the state after the last.
template <int S>
Uncertain turns_in(const WheelModel<S>& model, const Gaussian<wheel::states(S)>& end) {
  Mat<wheel::states(S)> first = end.mean;
  first(wheel::angle) = end.mean(wheel::start);
  const auto from = model.motion(first), to = model.motion(end.mean);
  Mat<wheel::states(S)> slope = to.by_angle - from.by_angle;
  slope(wheel::angle) = to.by_angle(wheel::angle);
  slope(wheel::start) = -from.by_angle(wheel::angle);
  return {(to.angle - from.angle) / rad_per_turn,
          std::sqrt(std::max(slope.dot(end.cov * slope), 0.0)) / rad_per_turn};
}

/// The extended filter as it would run on calibrated sensors: the initial motion unknown, the
/// constants with the estimates of the whole recording at its first epoch and the uncertainty at
/// its last.
template <int S>
void filter_calibrated(const WheelModel<S>& model,
                       const WheelPrior& prior,
                       const Gaussian<wheel::states(S)>& known,
                       WheelSeries& series) {
  constexpr int count = wheel::standing(S);
  auto state = prior_state<S>(prior);
  state.x.mean.template tail<count>() = known.mean.template tail<count>();
  state.x.cov.template bottomRightCorner<count, count>() =
      known.cov.template bottomRightCorner<count, count>();
  filter(model, 0, model.size(), wheel_gate, state, [&](std::size_t k, const auto& step) {
    const auto now = model.motion(step.filtered.mean);
    series.filtered_angle_rad[k] = now.angle;
    series.filtered_angle_std_rad[k] =
        std::sqrt(std::max(now.by_angle.dot(step.filtered.cov * now.by_angle), 0.0));
  });
}

/// Ambiguous intervals less than half a second apart are merged.
void add_doubt(std::size_t k,
               const Gaussian<wheel::moving>& predicted,
               const std::vector<double>& time_s,
               std::vector<WheelDoubt>& doubts) {
  constexpr double apart_s = 0.5;
  const auto variance = [](const Gaussian<wheel::moving>& state) {
    return state.cov(wheel::angle, wheel::angle);
  };
  if (doubts.empty() || time_s[k] - time_s[doubts.back().last] > apart_s)
    doubts.push_back({.first = k});
  WheelDoubt& doubt = doubts.back();
  doubt.last = k;
  if (variance(predicted) <= variance(doubt.predicted)) return;
  doubt.widest = k;
  doubt.predicted = predicted;
}

/// Results of filter and smoother with the lever arms held at their estimates.
template <int S>
WheelFit smooth_at_places(const WheelReadings& readings,
                          const Settled<S>& settled,
                          const WheelPath& about,
                          const Progress& progress) {
  const auto model = held_model<S>(readings, settled.noise, about);
  const std::size_t size = model.size();
  WheelFit fit;
  resize(fit.series, size);
  fit.series.time_s = readings.time_s;
  fit.track = {settled.prior.beginning, settled.noise, about, 0.0};
  const auto prior = prior_state<S>(settled.prior);
  Gaussian<wheel::states(S)> end = prior.x;
  Mat<wheel::states(S)> first_mean = end.mean;
  ConsistencyCheck check({.channels = std::vector<std::string>(channels_of(model)),
                          .rate_hz = readings.rate_hz(),
                          .gate = wheel_gate.limit});
  AngleColour<S> colour;
  LostShare lost(readings.gravity_mps2);
  const auto report = [&](std::string_view stage, std::size_t done) {
    if (progress && done % 65536 == 0)
      progress(stage, static_cast<double>(done) / static_cast<double>(size));
  };
  smooth(
      model, prior, wheel_gate,
      [&](std::size_t k, const auto& step) {
        if (k > 0 && readings.time_s[k] > readings.time_s.front() + 1.0) {
          const auto transition = model.transition(end.mean, k);
          const auto before = end.cov.template topLeftCorner<wheel::moving, wheel::moving>();
          const Gaussian<wheel::moving> predicted{
              transition.mean, transition.F * before * transition.F.transpose() + transition.Q};
          if (predicted.cov(wheel::angle, wheel::angle) > square(lost_prediction_rad))
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
        if (k == 0) first_mean = later.mean(step.filtered);
        report("smoother", size - k);
      });
  filter_calibrated(model, settled.prior, {first_mean, end.cov}, fit.series);
  fit.track.lost = lost.share();
  fit.consistency = check.judge();
  constexpr int count = wheel::standing(S);
  fit.constants = end.mean.template tail<count>();
  const auto by = settled.widened.asDiagonal();
  fit.constants_cov = by * end.cov.template bottomRightCorner<count, count>() * by;
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

void add_in_square(double& std, double more) {
  std = std::hypot(std, more);
}

/// The smoothed motion and the constants of one run.
struct Run {
  std::vector<double> angle_rad, speed_radps, accel_radps2;
  Eigen::VectorXd constants{};
  double turns = 0.0;
};

template <int S>
Run run_at(const WheelModel<S>& model, const WheelPrior& prior) {
  const std::size_t size = model.size();
  Run run{std::vector<double>(size), std::vector<double>(size), std::vector<double>(size)};
  Gaussian<wheel::states(S)> end = prior_state<S>(prior).x;
  smooth(
      model, prior_state<S>(prior), wheel_gate,
      [&](std::size_t, const auto& step) { end = step.filtered; },
      [&](std::size_t k, const auto& step, const auto& later) {
        const auto now = model.motion(later.mean(step.filtered));
        run.angle_rad[k] = now.angle;
        run.speed_radps[k] = now.speed;
        run.accel_radps2[k] = now.accel;
      });
  run.constants = end.mean.template tail<wheel::standing(S)>();
  run.turns = turns_in(model, end).value;
  return run;
}

/// Contribution of the parameters that the passes hold: the lever arms, the delay of the sensors'
/// filters and the rolling radius; the last two are not reliably determined by any likelihood. The
/// smoother is repeated with the parameter changed by a share of its standard deviation, and the
/// differences are extrapolated linearly.
template <int S>
class HeldFigures {
 public:
  HeldFigures(const WheelReadings& readings, const Settled<S>& settled, const WheelPath& about)
      : readings_(readings),
        settled_(settled),
        about_(about),
        levers_(levers_of(about, readings)),
        base_(run_at(model(), settled.prior)),
        base_places_(places_of(model())) {}

  /// Returns false if a run's angle slips relative to the fit's, however small the step: the
  /// differences are then meaningless, and the fit invalid.
  [[nodiscard]] bool add_to(WheelFit& fit) const {
    return add_places(fit) && add(&WheelModel<S>::delay_s, readings_.delay_s.std, fit) &&
           add(&WheelModel<S>::rolling_radius_m, readings_.rolling_radius_m.std, fit);
  }

 private:
  /// Along each principal direction of their covariance, by less than a standard deviation: if the
  /// recording hardly determines the lever arms, that is not a small step.
  [[nodiscard]] bool add_places(WheelFit& fit) const {
    constexpr double longest_step_m = 2e-3;
    const SymmetricEigen axes = symmetric_eigen(settled_.places_cov);
    for (Eigen::Index i = 0; i < axes.values.size(); ++i) {
      const double std_m = std::sqrt(std::max(axes.values(i), 1e-16));
      const auto moved = [&](double share) {
        WheelPrior prior = settled_.prior;
        *prior.places += share * std_m * axes.vectors.col(i);
        return run_at(model(), prior);
      };
      if (!add(moved, std::min(1.0, longest_step_m / std_m), fit)) return false;
    }
    return true;
  }

  /// The lever arms are estimated anew with the changed parameter.
  [[nodiscard]] bool add(double WheelModel<S>::* figure, double std, WheelFit& fit) const {
    if (!(std > 0.0)) return true;
    const auto moved = [&](double share) {
      auto other = model();
      other.*figure += share * std;
      WheelPrior prior = settled_.prior;
      *prior.places += places_of(other) - base_places_;
      return run_at(other, prior);
    };
    return add(moved, 1.0, fit);
  }

  [[nodiscard]] WheelModel<S> model() const {
    return held_model<S>(readings_, settled_.noise, about_);
  }
  [[nodiscard]] Places places_of(const WheelModel<S>& model) const {
    return places_by_levers(model, levers_, settled_.prior, settled_.belief).mean;
  }

  /// Whether the run's angle slips.
  [[nodiscard]] bool slips(const Run& run) const {
    constexpr double slip_rad = 0.5;
    return !std::ranges::equal(run.angle_rad, base_.angle_rad,
                               [](double a, double b) { return std::abs(a - b) < slip_rad; });
  }

  /// A run that slips is tried again with a smaller share.
  template <class RunAt>
  [[nodiscard]] bool add(const RunAt& moved, double share, WheelFit& fit) const {
    Run run = moved(share);
    for (int again = 0; slips(run) && again < 3; ++again) run = moved(share *= 0.1);
    if (slips(run)) return false;
    const double reach = 1.0 / share;
    WheelSeries& series = fit.series;
    std::size_t at = 0;
    for (std::size_t k = 0; k < series.time_s.size(); ++k) {
      const auto& times = readings_.time_s;
      while (at + 2 < times.size() && times[at + 1] <= series.time_s[k]) ++at;
      const double part =
          std::clamp((series.time_s[k] - times[at]) / (times[at + 1] - times[at]), 0.0, 1.0);
      const auto off = [&](std::vector<double> Run::* of) {
        return reach * std::lerp((run.*of)[at] - (base_.*of)[at],
                                 (run.*of)[at + 1] - (base_.*of)[at + 1], part);
      };
      const double angle = off(&Run::angle_rad);
      add_in_square(series.angle_std_rad[k], angle);
      add_in_square(series.filtered_angle_std_rad[k], angle);
      add_in_square(series.speed_std_radps[k], off(&Run::speed_radps));
      add_in_square(series.accel_std_radps2[k], off(&Run::accel_radps2));
    }
    const Eigen::VectorXd change = reach * (run.constants - base_.constants);
    fit.constants_cov += change * change.transpose();
    add_in_square(fit.turns.std, reach * (run.turns - base_.turns));
    return true;
  }

  const WheelReadings& readings_;
  const Settled<S>& settled_;
  const WheelPath& about_;
  WheelLevers levers_;
  Run base_;
  Places base_places_;
};

/// Adds the contribution of the held parameters, from runs on the averaged measurements, since
/// differences are smooth, or on all of them if those slip. If these slip too, the recording does
/// not determine the constants, and the angle has the uncertainty of the delay.
template <int S>
void add_held_figures(const Settled<S>& settled,
                      const WheelReadings& averaged,
                      const WheelPath& averaged_path,
                      const WheelReadings& readings,
                      const WheelPath& path,
                      WheelFit& fit) {
  WheelFit with = fit;
  bool added = HeldFigures<S>(averaged, settled, averaged_path).add_to(with);
  if (!added && averaged.instants.size() < readings.instants.size()) {
    with = fit;
    added = HeldFigures<S>(readings, settled, path).add_to(with);
  }
  if (!added) {
    with = std::move(fit);
    with.constants_cov += with.constants_prior_cov;
    const std::vector<double>& speed_radps = with.series.speed_radps;
    const double late_s = readings.delay_s.std;
    for (std::size_t k = 0; k < speed_radps.size(); ++k) {
      add_in_square(with.series.angle_std_rad[k], late_s * speed_radps[k]);
      add_in_square(with.series.filtered_angle_std_rad[k], late_s * speed_radps[k]);
    }
    add_in_square(with.turns.std,
                  late_s * (speed_radps.back() - speed_radps.front()) / rad_per_turn);
  }
  fit = std::move(with);
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

/// Number of measurements that may be averaged before the wheel turns by a twentieth of a radian.
std::size_t readings_to_average(const WheelReadings& readings, const WheelTrack& track) {
  double fastest = 0.0;
  for (const Mat<wheel::moving>& at : track.path.moving)
    fastest = std::max(fastest, std::abs(at(wheel::speed)));
  // A short recording keeps at least 50 averages.
  const double most = std::clamp(static_cast<double>(readings.instants.size()) / 50.0, 1.0, 64.0);
  return static_cast<std::size_t>(std::clamp(0.05 * readings.rate_hz() / fastest, 1.0, most));
}

/// A track of the averaged measurements, on the time line of all of them.
WheelTrack spread_track(const WheelTrack& track,
                        const WheelReadings& averaged,
                        const WheelReadings& readings) {
  WheelTrack out = track;
  out.path.moving.clear();
  std::size_t at = 0;
  for (const double t : readings.time_s) {
    while (at + 1 < averaged.time_s.size() && averaged.time_s[at + 1] <= t) ++at;
    Mat<wheel::moving> moving = track.path.moving[at];
    moving(wheel::angle) += (t - averaged.time_s[at]) * moving(wheel::speed);
    out.path.moving.push_back(moving);
  }
  return out;
}

/// Assigns each measurement the estimated variance of its average, times the averaging factor.
void spread_variance(const WheelReadings& averaged, std::size_t each, WheelReadings& readings) {
  for (std::size_t s = 0; s < readings.sensors.size(); ++s) {
    readings.sensors[s].speed_variance =
        static_cast<double>(each) * averaged.sensors[s].speed_variance;
    for (std::size_t k = 0; k < readings.instants.size(); ++k) {
      const std::int64_t row = readings.instants[k].row[s];
      const std::int64_t block = averaged.instants[k / each].row[s];
      if (row == WheelInstant::no_row || block == WheelInstant::no_row) continue;
      readings.sensors[s].variance_m2ps4[static_cast<std::size_t>(row)] =
          static_cast<double>(each) *
          averaged.sensors[s].variance_m2ps4[static_cast<std::size_t>(block)];
    }
  }
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
  const std::size_t each = readings_to_average(readings, track);
  WheelReadings coarse = averaged(readings, each);
  WheelTrack coarse_track = spread_track(track, readings, coarse);
  const int rounds = S == 1 && depth == FitDepth::whole ? 4 : 2;
  Settled<S> settled = settle_rounds<S>(coarse, coarse_track, belief, rounds, progress);
  // A warm-up is not a random walk: it drifts fastest at the start, where the count of turns
  // begins.
  settled.noise.bias_walk_psd *= 3.0;
  improve(coarse, settled, coarse_track);
  settled.prior.beginning = coarse_track.beginning;
  spread_variance(coarse, each, readings);
  readings.rolling_radius_m = coarse.rolling_radius_m;
  readings.shakes = coarse.shakes;
  if (readings.encoder) readings.encoder->more_variance_rad2 = coarse.encoder->more_variance_rad2;
  if (depth == FitDepth::track)
    return smooth_at_places(coarse, settled, coarse_track.path, progress);
  track = spread_track(coarse_track, coarse, readings);
  settle_variance(held_model<S>(readings, settled.noise, track.path), settled.prior, readings);
  WheelFit fit = smooth_at_places(readings, settled, track.path, progress);
  constexpr int count = wheel::standing(S);
  fit.constants_prior_cov =
      prior_state<S>(settled.prior).x.cov.template bottomRightCorner<count, count>();
  fit.constants_prior_cov.template bottomRightCorner<2 * S, 2 * S>() = belief.cov;
  add_held_figures(settled, coarse, coarse_track.path, readings, track.path, fit);
  add_gravity_uncertainty<S>(readings, settled.places_cov * positive_inverse(belief.cov), fit);
  if (readings.encoder) add_nonlinearity<S>(readings.encoder->nonlinearity, fit);
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

WheelFit fit_wheel(WheelReadings& readings,
                   WheelTrack track,
                   const PlacesPrior& places_prior,
                   FitDepth depth,
                   const Progress& progress) {
  PM_EXPECTS(!readings.sensors.empty() && readings.sensors.size() <= 2);
  PM_EXPECTS(readings.instants.size() >= 2 && track.path.moving.size() == readings.instants.size());
  if (readings.sensors.size() == 1)
    return fit_sensors<1>(readings, std::move(track), places_prior, depth, progress);
  return fit_sensors<2>(readings, std::move(track), places_prior, depth, progress);
}

}  // namespace proofmass::estimate

#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "proofmass/estimate/wheel/fit.hpp"

// Filter passes over a wheel's measurements, shared by all steps of the fit.
namespace proofmass::estimate {

inline constexpr Gate wheel_gate{.huber = 3.0, .limit = 12.0, .patience = 40};

/// Lever arms of the sensors, (u, v) of each, m.
using Places = Eigen::VectorXd;

/// Prior, before the data.
struct WheelPrior {
  Beginning beginning;
  ConstantsPrior spread;
  std::optional<Places> places{};       ///< held there
  std::optional<PlacesPrior> belief{};  ///< of lever arms that are estimated; else spread.place_m
};

template <int S>
WheelModel<S> wheel_model(const WheelReadings& readings, const WheelNoise& noise) {
  WheelModel<S> model;
  model.gravity_mps2 = readings.gravity_mps2;
  model.rolling_radius_m = readings.rolling_radius_m.value;
  model.phase_rad = readings.phase_rad;
  model.delay_s = readings.delay_s.value;
  model.orders = readings.orders;
  model.noise = noise;
  model.epochs = &readings.epochs;
  model.time_s = &readings.time_s;
  if (readings.encoder) model.encoder = &*readings.encoder;
  for (std::size_t s = 0; s < readings.sensors.size(); ++s) {
    model.readings[s] = &readings.sensors[s];
    model.with_gyro = model.with_gyro || !readings.sensors[s].speed_radps.empty();
  }
  return model;
}

/// Resets the sensors' constants to their prior.
template <int S>
void reset_constants(const WheelPrior& prior, Gaussian<wheel::states(S)>& x) {
  constexpr int count = wheel::standing(S), places = wheel::places(S);
  x.mean.template tail<count>().setZero();
  x.cov.template bottomRows<count>().setZero();
  x.cov.template rightCols<count>().setZero();
  auto variance = x.cov.diagonal();
  const ConstantsPrior& spread = prior.spread;
  for (int s = 0; s < S; ++s) {
    const int at = wheel::first_of(s);
    variance.template segment<2>(at + wheel::bias).setConstant(spread.bias_mps2 * spread.bias_mps2);
    variance.template segment<2>(at + wheel::scale).setConstant(spread.scale * spread.scale);
    variance(at + wheel::skew) = spread.skew_rad * spread.skew_rad;
  }
  if (S == 2) variance(wheel::phase) = spread.phase_rad * spread.phase_rad;
  variance.template segment<2 * wheel::ripple_orders>(wheel::ripple(S))
      .setConstant(spread.ripple * spread.ripple);
  for (int s = 0; s < S; ++s) {
    const int at = wheel::gyro(S) + wheel::gyro_states * s;
    variance(at + wheel::gyro_bias) = spread.gyro_bias_radps * spread.gyro_bias_radps;
    variance(at + wheel::gyro_scale) = spread.gyro_scale * spread.gyro_scale;
    variance(at + wheel::gyro_tilt) = spread.axle_slope * spread.axle_slope;
    x.mean(at + wheel::gyro_tilt) = spread.axle_slopes[static_cast<std::size_t>(s)];
  }
  variance(wheel::rolling(S)) = spread.rolling_m * spread.rolling_m;
  constexpr int encoder = wheel::encoder(S);
  variance(encoder) = spread.encoder_offset_rad * spread.encoder_offset_rad;
  for (int i = 1; i < wheel::encoder_states; ++i) {
    const Uncertain& error = spread.encoder_errors_rad[static_cast<std::size_t>(i - 1)];
    x.mean(encoder + i) = error.value;
    variance(encoder + i) = error.std * error.std;
  }
  if (prior.places)
    x.mean.template segment<2 * S>(places) = *prior.places;
  else if (prior.belief) {
    x.mean.template segment<2 * S>(places) = prior.belief->mean;
    x.cov.template bottomRightCorner<2 * S, 2 * S>() = prior.belief->cov;
  } else
    variance.template segment<2 * S>(places).setConstant(spread.place_m * spread.place_m);
}

/// The state before the first measurement. The start angle is in it twice, with one variance.
template <int S>
FilterState<wheel::states(S)> prior_state(const WheelPrior& prior) {
  FilterState<wheel::states(S)> state;
  auto& [x, P] = state.x;
  reset_constants<S>(prior, state.x);
  x(wheel::angle) = x(wheel::start) = prior.beginning.angle_rad;
  x(wheel::speed) = prior.beginning.speed_radps;
  for (const int i : {wheel::angle, wheel::start})
    for (const int j : {wheel::angle, wheel::start})
      P(i, j) = std::pow(prior.beginning.angle_std_rad, 2);
  P(wheel::speed, wheel::speed) = std::pow(prior.beginning.speed_std_radps, 2);
  P(wheel::accel, wheel::accel) = 25.0;
  P(wheel::jerk, wheel::jerk) = 25.0;
  return state;
}

/// Prediction quality of a forward run, comparable between runs with different noise parameters:
/// mean of min(y²/c², 1) over the innovations y, c = 0.3 g. Near 0 with the correct phase, above a
/// half once it is lost.
class LostShare {
 public:
  explicit LostShare(double gravity_mps2) : c2_(std::pow(0.3 * gravity_mps2, 2)) {}

  template <class Step>
  void add(const Step& step) {
    for (int i = 0; i < step.count; ++i) {
      const double y = step.updates[static_cast<std::size_t>(i)].innovation;
      sum_ += y * y < c2_ ? y * y / c2_ : 1.0;
      ++readings_;
    }
  }
  /// 1 without measurements.
  [[nodiscard]] double share() const { return readings_ > 0 ? share_of(readings_) : 1.0; }
  /// Lower bound of share() after further innovations, `readings` in all.
  [[nodiscard]] double share_of(std::size_t readings) const {
    return sum_ / static_cast<double>(readings);
  }
  [[nodiscard]] std::size_t readings() const { return readings_; }

 private:
  double c2_, sum_ = 0.0;
  std::size_t readings_ = 0;
};

/// Huber's ρ of ν standard deviations, at most that of the gate's limit.
[[nodiscard]] inline double surprise(double off) {
  constexpr double huber = wheel_gate.huber;
  if (off <= huber) return off * off;
  return 2.0 * huber * std::min(off, wheel_gate.limit) - huber * huber;
}

/// Log-likelihood of epochs [first, last) from their innovations, with Huber's ρ; −∞ if it is not
/// finite.
template <int S>
double log_likelihood_of(const WheelModel<S>& model,
                         FilterState<wheel::states(S)> state,
                         std::size_t first,
                         std::size_t last) {
  double log_likelihood = 0.0;
  filter(model, {first, last}, wheel_gate, state, [&](std::size_t, const auto& step) {
    for (int i = 0; i < step.count; ++i) {
      const auto& u = step.updates[static_cast<std::size_t>(i)];
      log_likelihood -=
          0.5 * (std::log(2.0 * std::numbers::pi * u.expected) + surprise(std::sqrt(u.nis())));
    }
  });
  return std::isfinite(log_likelihood) ? log_likelihood : -std::numeric_limits<double>::infinity();
}

/// A smoothed trajectory, the state after its last epoch, the smoothed constants at the first, and
/// LostShare of its innovations.
template <int S>
struct Traced {
  WheelPath path;
  Gaussian<wheel::states(S)> end;
  Mat<wheel::standing(S)> first;
  double lost = 1.0;
};

template <int S>
Traced<S> trace_path(const WheelModel<S>& model, const FilterState<wheel::states(S)>& prior) {
  using Model = WheelModel<S>;
  Traced<S> traced;
  traced.end = prior.x;
  std::vector<Mat<wheel::moving>>& moving = traced.path.moving;
  moving.resize(model.size());
  LostShare lost(model.gravity_mps2);
  smooth_means(
      model, prior, wheel_gate,
      [&](std::size_t, const StepOf<Model>& step) {
        traced.end = step.filtered;
        lost.add(step);
      },
      [&](std::size_t k, const StepOf<Model>& step, const BackwardScore<Model::states>& later) {
        const auto mean = later.mean(step.filtered).eval();
        moving[k] = mean.template head<wheel::moving>();
        if (k == 0) traced.first = mean.template tail<wheel::standing(S)>();
      });
  traced.path.standing = traced.end.mean.template tail<wheel::standing(S)>();
  traced.lost = lost.share();
  return traced;
}

/// Sets each measurement's variance from the neighbouring innovations.
template <int S>
void settle_variance(const WheelModel<S>& model, const WheelPrior& prior, WheelReadings& readings);

/// A part of the recording to tune on: all of it or, if it is long, the interval of 12 000 epochs
/// with the largest speed change, with the filter's state at its beginning.
template <int S>
struct Excerpt {
  std::size_t first = 0, last = 0;
  FilterState<wheel::states(S)> state;
};

template <int S>
[[nodiscard]] Excerpt<S> excerpt_to_tune(const WheelModel<S>& model, const WheelPrior& prior);

struct TunedNoise {
  WheelNoise noise;
  double log_likelihood = 0.0;
};

/// Maximum-likelihood motion noise on the excerpt, from the model's, which may be `tuned` already:
/// each parameter in turn by steps of a shrinking factor.
template <int S>
[[nodiscard]] TunedNoise tune_noise(WheelModel<S> model, const Excerpt<S>& excerpt, bool tuned);

/// The levers of a path on the measurements' time line.
[[nodiscard]] WheelLevers levers_of(const WheelPath& path, const WheelReadings& readings);

struct FoundPlaces {
  Places mean;
  Eigen::MatrixXd cov;
  double log_likelihood = 0.0;
  /// Innovations in standard deviations, NaN where rejected; set by places_by_levers() only.
  std::vector<float> innovations{};
};

/// Maximum-likelihood lever arms, with all else integrated out by the filter. Ripple within a turn
/// informs a lever arm only as far as the white jerk and snap model holds, so this is an initial
/// value, not a measure of certainty.
template <int S>
[[nodiscard]] FoundPlaces likeliest_places(const WheelModel<S>& model,
                                           const Excerpt<S>& excerpt,
                                           const WheelPrior& prior,
                                           const PlacesPrior& belief);

/// Lever arms as additional states, about a path: as far as the change of the mean force with speed
/// shows them.
template <int S>
[[nodiscard]] FoundPlaces places_by_levers(WheelModel<S> model,
                                           const WheelLevers& levers,
                                           WheelPrior prior,
                                           const PlacesPrior& belief);

/// Inflation factor of the standard deviations of all static states if the innovations are
/// coloured: P⁻¹-weighted scores in blocks of a fortieth, a twentieth and a tenth of the recording,
/// the shortest of a second at least; the maximum of these. At least 1.
template <int S>
[[nodiscard]] Eigen::VectorXd widening(WheelModel<S> model,
                                       const WheelLevers& levers,
                                       const std::vector<double>& time_s,
                                       WheelPrior prior,
                                       const PlacesPrior& belief);

}  // namespace proofmass::estimate

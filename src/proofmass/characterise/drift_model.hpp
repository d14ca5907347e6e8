#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// Models of the bias of a sensor at rest, and their fitted values.
namespace proofmass::characterise {

/// The deterministic part, t since power-on:
///
///     y(t) = a2 + a1 (1 − e^(−t/T)) + a1' (1 − e^(−t/T')) + a3 t + Σ s_j [t ≥ t_j]
///
/// or, if another shape is as likely as the exponential, a2 + a1 g(t/T) of drift/shapes.hpp; for
/// the sine T is the period and a1' the amplitude of the cosine.
enum class DriftShape {
  constant,               ///< a2
  line,                   ///< a2, a3
  steps,                  ///< a2, s_j
  exponential,            ///< a2, a1, T
  exponential_and_line,   ///< a2, a1, T, a3
  two_exponentials,       ///< a2, a1, T, a1', T'; T is that of the larger amplitude
  square_root,            ///< a2, a1
  logarithm,              ///< a2, a1, T
  hyperbola,              ///< a2, a1, T
  stretched_exponential,  ///< a2, a1, T
  sine,                   ///< a2, a1, a1', T
};

/// "constant", "line", "steps", "exponential", "exponential_and_line", "two_exponentials",
/// "square_root", "logarithm", "hyperbola", "stretched_exponential", "sine".
[[nodiscard]] std::string_view name_of(DriftShape shape);

[[nodiscard]] constexpr bool has_line(DriftShape shape) {
  return shape == DriftShape::line || shape == DriftShape::exponential_and_line;
}

/// A value, its standard deviation and its central 95 % interval; a missing end is not bounded by
/// the data.
struct Interval95 {
  double value = 0.0;
  double std = 0.0;
  std::optional<double> lower_95, upper_95;
};

struct DriftStep {
  double t_s = 0.0;
  Uncertain size;
};

/// A candidate shape, with the noise refitted.
struct DriftCandidate {
  DriftShape shape = DriftShape::constant;
  int parameters = 0;  ///< for shape and noise
  double log_likelihood = 0.0;
  double information_criterion = 0.0;  ///< Schwarz: −2 ln L + k ln n; the smallest is preferred
  std::optional<double> time_constant_s;
  std::size_t steps = 0;
};

/// Noise of the block means in the fit; each 0 if not needed.
struct DriftNoise {
  double white = 0.0;        ///< N in u/√Hz
  double flicker = 0.0;      ///< B in u
  double random_walk = 0.0;  ///< K in u/√s
  double markov = 0.0;       ///< q in u/√s, of first-order Markov noise
  double markov_time_constant_s = 0.0;
  [[nodiscard]] double markov_std() const;  ///< q √(T/2) in u
};

/// Profile likelihood of the time constant: twice the loss in log-likelihood from the maximum, with
/// all else refitted. 3.84 bounds the 95 % interval.
struct ProfilePoint {
  double time_constant_s = 0.0;
  double deviance = 0.0;
};

/// The deterministic part with the covariance of its parameters.
struct DriftCurve {
  DriftShape shape = DriftShape::constant;
  double a2 = 0.0, a1 = 0.0, time_constant_s = 0.0;
  double second_a1 = 0.0, second_time_constant_s = 0.0;
  double slope_per_s = 0.0;
  std::vector<DriftStep> steps;
  /// Covariance of those of [a2; a1; ln T; a1'; ln T'; a3; s_1 …] that the shape has, in this
  /// order; for the sine of [a2; a1; a1'; ln T].
  Eigen::MatrixXd covariance;

  [[nodiscard]] double value(double t_s) const;
  /// Standard deviation of the curve, without measurement noise.
  [[nodiscard]] double std(double t_s) const;
  /// ∂y/∂ of each entry of the covariance at t.
  [[nodiscard]] Eigen::VectorXd gradient(double t_s) const;
};

/// State of curve and drift at one time.
struct DriftState {
  double t_s = 0.0;
  Eigen::Vector3d slow_noise = Eigen::Vector3d::Zero();  ///< random walk since 0, flicker, Markov
  Eigen::MatrixXd covariance;  ///< of the entries of DriftCurve::covariance, then of the drift
};

/// A curve consistent with the recording, with its drift; `weight` by Akaike's criterion, the sum
/// over all possibilities is 1.
struct DriftPossibility {
  DriftCurve curve;
  DriftNoise noise;
  DriftState end;
  double weight = 1.0;
};

/// Reason for the absence of a time constant.
enum class DriftReason {
  identified,
  no_warm_up,             ///< the noise explains the recording as well as an exponential
  hidden_by_noise,        ///< amplitude not above the random walk or Markov noise
  steps,                  ///< steps explain the drift better
  line,                   ///< a straight line explains it as well: T is not determined
  longer_than_record,     ///< T is not bounded within the record
  shorter_than_resolved,  ///< T at or below what the blocks resolve
  begun_later,  ///< an exponential that would have decayed long ago, had it begun at power-on
  shape_undetermined,  ///< a warm-up, but another shape fits it as well as the exponential
  oscillation,         ///< a slow sine explains it better than any warm-up
  unexplained          ///< the residual is not noise: another cause changes the bias
};

/// Result of the fit. If no exponential is identified, the curve is the best shape without one, or
/// the best of all if the shape is not determined, and a1 and T are absent.
struct DriftFit {
  DriftCurve curve;
  DriftNoise noise;
  bool identified = false;
  DriftReason why = DriftReason::no_warm_up;
  std::string reason;  ///< a sentence for people, without units: values are in the fields

  /// If the shape is not determined, all shapes that fit as well, the most likely first. With the
  /// random walk that white noise may hide.
  std::vector<DriftPossibility> possibilities;
  /// If identified in white noise, the curve with that random walk: for forecasts.
  std::optional<DriftPossibility> hidden_walk;

  Interval95 a2;                              ///< bias at power-on, over all possibilities
  std::optional<Interval95> a1;               ///< if identified
  std::optional<Interval95> time_constant_s;  ///< if identified
  std::optional<Interval95> second_a1, second_time_constant_s, slope_per_s;

  /// The best-fitting exponential, identified or not, and its gain over the best fit without one:
  /// for display, not for use.
  double best_time_constant_s = 0.0;
  double constant_deviance = 0.0, constant_p = 1.0;  ///< exponential against constant
  double line_deviance = 0.0, line_p = 1.0;          ///< exponential against straight line
  /// 95 % upper limit of the amplitude of a warm-up with T a fifth of the record.
  double undetected_below = 0.0;
  /// One-sided bounds of T if it is not identified.
  std::optional<double> time_constant_above_s, time_constant_below_s;

  std::vector<ProfilePoint> profile;
  std::vector<DriftCandidate> candidates;  ///< best first

  /// State of the bias at the end of the recording.
  DriftState end;
  double block_s = 0.0;  ///< averaging time of the fitted means
};

/// Weighted mean and standard deviation over the possibilities, one interval each, and the interval
/// that contains all of theirs.
[[nodiscard]] Interval95 covering(View<Interval95> intervals, View<DriftPossibility> possibilities);

/// The bias at a later time.
struct DriftForecast {
  double t_s = 0.0;
  Interval95 bias;    ///< curve and drift
  Interval95 change;  ///< since the end of the recording
};

/// y(t) and its 95 % band from the uncertainty of the curve, the drift so far and the drift until
/// then. If the shape is not determined: the mean over the possibilities, and a band that contains
/// all their bands. Errors: not_observable (no warm-up is identified; the message states why),
/// invalid_argument (t_s is before the recording's end).
[[nodiscard]] Result<DriftForecast> forecast(const DriftFit& fit, double t_s);

/// ½ b t² with the band of b.
[[nodiscard]] Interval95 position_error(const Interval95& bias, double t_s);

}  // namespace proofmass::characterise

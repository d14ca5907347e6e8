#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

// What the bias of a sensor at rest can do, and what was found of it.
namespace proofmass::characterise {

/// The deterministic part, t since switching on:
///
///     y(t) = a2 + a1 (1 − e^(−t/T)) + a1' (1 − e^(−t/T')) + a3 t + Σ s_j [t ≥ t_j]
///
/// or, where another shape than the exponential is as likely, a2 + a1 g(t/T) of drift_shapes.hpp;
/// of the sine T is the period and a1' the amplitude of the cosine.
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

/// A value, its standard deviation and its central 95 % interval; an end that the data do not
/// bound is missing.
struct Interval95 {
  double value = 0.0;
  double std = 0.0;
  std::optional<double> lower_95, upper_95;
};

struct DriftStep {
  double t_s = 0.0;
  Uncertain size;
};

/// A shape that was tried, with the noise refitted beside it.
struct DriftCandidate {
  DriftShape shape = DriftShape::constant;
  int parameters = 0;  ///< of shape and noise
  double log_likelihood = 0.0;
  double information_criterion = 0.0;  ///< Schwarz: −2 ln L + k ln n; the least is preferred
  std::optional<double> time_constant_s;
  std::size_t steps = 0;
};

/// The noise of the block means that the fit took into account; none where not needed.
struct DriftNoise {
  double white = 0.0;        ///< N in u/√Hz
  double flicker = 0.0;      ///< B in u
  double random_walk = 0.0;  ///< K in u/√s
  double markov = 0.0;       ///< q in u/√s, of first-order Markov noise
  double markov_time_constant_s = 0.0;
  [[nodiscard]] double markov_std() const;  ///< q √(T/2) in u
};

/// How likely the time constant is: twice the loss in log-likelihood from the best one, all else
/// fitted anew. 3.84 bounds the 95 % interval.
struct ProfilePoint {
  double time_constant_s = 0.0;
  double deviance = 0.0;
};

/// The deterministic part with the covariance of what it is made of.
struct DriftCurve {
  DriftShape shape = DriftShape::constant;
  double a2 = 0.0, a1 = 0.0, time_constant_s = 0.0;
  double second_a1 = 0.0, second_time_constant_s = 0.0;
  double slope_per_s = 0.0;
  std::vector<DriftStep> steps;
  /// Of [a2; a1; ln T; a1'; ln T'; a3; s_1 …], those that the shape has, in this order; of the sine
  /// [a2; a1; a1'; ln T].
  Eigen::MatrixXd covariance;

  [[nodiscard]] double value(double t_s) const;
  /// Of the curve, not of a reading: without noise.
  [[nodiscard]] double std(double t_s) const;
  /// ∂y/∂ of each entry of the covariance at t.
  [[nodiscard]] Eigen::VectorXd gradient(double t_s) const;
};

/// The curve and what wanders beside it, at one time.
struct DriftState {
  double t_s = 0.0;
  Eigen::Vector3d wander = Eigen::Vector3d::Zero();  ///< random walk since 0, flicker, Markov
  Eigen::MatrixXd covariance;  ///< of the entries of DriftCurve::covariance, then of the wander
};

/// A curve that the recording allows, with what wanders beside it; `weight` by Akaike's criterion,
/// of all that it allows 1.
struct DriftPossibility {
  DriftCurve curve;
  DriftNoise noise;
  DriftState end;
  double weight = 1.0;
};

/// Why there is no time constant.
enum class DriftReason {
  identified,
  no_warm_up,             ///< nothing an exponential explains that the noise does not
  hidden_by_noise,        ///< amplitude not above the random walk or Markov noise
  steps,                  ///< steps explain the drift better
  line,                   ///< a straight line explains it as well: T cannot be told
  longer_than_record,     ///< T is not bounded within the record
  shorter_than_resolved,  ///< T at or below what the blocks resolve
  begun_later,            ///< an exponential that would be long over, had it begun at switching on
  shape_undetermined,     ///< a warm-up, but another shape fits it as well as the exponential
  swing,                  ///< a slow sine explains it better than any warm-up
  unexplained             ///< what is left is no noise: something else moves the bias
};

/// What was found. Where no exponential is identified, the curve is the best of the shapes without
/// one, or of all where the shape is not determined, and a1 and T are missing.
struct DriftFit {
  DriftCurve curve;
  DriftNoise noise;
  bool identified = false;
  DriftReason why = DriftReason::no_warm_up;
  std::string reason;  ///< a sentence for people, without unit: figures are in the fields

  /// Where the shape is not determined, all that fit as well, the likeliest first.
  std::vector<DriftPossibility> possibilities;

  Interval95 a2;                              ///< bias at switching on, over all possibilities
  std::optional<Interval95> a1;               ///< where identified
  std::optional<Interval95> time_constant_s;  ///< where identified
  std::optional<Interval95> second_a1, second_time_constant_s, slope_per_s;

  /// The exponential that fits best, identified or not, with what it gains over the best fit
  /// without one: for people to look at, not to use.
  double best_time_constant_s = 0.0;
  double constant_deviance = 0.0, constant_p = 1.0;  ///< exponential against constant
  double line_deviance = 0.0, line_p = 1.0;          ///< exponential against straight line
  /// With 95 % confidence there is no warm-up of this amplitude with T a fifth of the record.
  double undetected_below = 0.0;
  /// T is within these where it is not identified but bounded from one side.
  std::optional<double> time_constant_above_s, time_constant_below_s;

  std::vector<ProfilePoint> profile;
  std::vector<DriftCandidate> candidates;  ///< best first

  /// Where the bias stands at the end of the recording.
  DriftState end;
  double block_s = 0.0;  ///< of the means that the fit is of
};

/// Mean and standard deviation over the possibilities, one interval each, and the interval that
/// holds all of theirs.
[[nodiscard]] Interval95 covering(View<Interval95> intervals, View<DriftPossibility> possibilities);

/// The bias at a later time.
struct DriftForecast {
  double t_s = 0.0;
  Interval95 bias;    ///< curve and wander
  Interval95 change;  ///< since the end of the recording
};

/// y(t) and the 95 % band that curve, wander so far and the wander until then leave. Where the
/// shape is not determined: the mean over the possibilities, and a band that holds the bands of
/// all. Errors: not_observable (no warm-up is identified; the message says why), invalid_argument
/// (t_s is before the recording's end).
[[nodiscard]] Result<DriftForecast> forecast(const DriftFit& fit, double t_s);

/// ½ b t² with the band of b.
[[nodiscard]] Interval95 position_error(const Interval95& bias, double t_s);

}  // namespace proofmass::characterise

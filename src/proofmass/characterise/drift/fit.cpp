#include "proofmass/characterise/drift/fit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

#include "proofmass/characterise/drift/profile.hpp"
#include "proofmass/characterise/drift/selection.hpp"
#include "proofmass/characterise/drift/shapes.hpp"
#include "proofmass/characterise/drift/state.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/signal/whiteness.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Interval95 interval(double value, double std, double dof) {
  constexpr double two_sided = 0.975;
  const double reach = student_t_quantile(two_sided, dof) * std;
  return {value, std, value - reach, value + reach};
}

// Interval of a time constant from its logarithm.
Interval95 log_interval(double value, double std_of_log, double dof) {
  const Interval95 of_log = interval(std::log(value), std_of_log, dof);
  return {value, value * std_of_log, std::exp(*of_log.lower_95), std::exp(*of_log.upper_95)};
}

double undetected_below(const DriftEvidence& evidence, const DriftFitAtShape& constant) {
  constexpr double share = 0.2, two_sided = 1.959963984540054;
  const MatrixXd others = linear_columns(evidence, constant.at);
  OrdinateMeans means{MatrixXd(others.rows(), others.cols() + 1), {}, evidence.missing()};
  means.fitted << evidence.rise(share * evidence.duration_s()).tail(others.rows()), others;
  const OrdinateFit fit =
      evaluate_ordinates(evidence.contrasts(), constant.noise.P, means, constant.fit.strength);
  return std::abs(fit.coefficients(0)) + two_sided * std::sqrt(fit.covariance(0, 0));
}

// "logarithm", "square root and logarithm", "square root, logarithm and sine".
std::string rivals_of(const DriftFit& fit) {
  std::vector<std::string> names;
  for (const DriftPossibility& one : fit.possibilities) {
    if (one.curve.shape == DriftShape::exponential) continue;
    names.emplace_back(name_of(one.curve.shape));
    std::ranges::replace(names.back(), '_', ' ');
  }
  if (names.size() < 2) return names.empty() ? "" : names.front();
  const std::string last = std::move(names.back());
  names.pop_back();
  return fmt::format("{} and {}", fmt::join(names, ", "), last);
}

std::string times_of(const DriftFit& fit) {
  if (fit.time_constant_above_s) return fmt::format("above {:.3g} s", *fit.time_constant_above_s);
  return "not bounded";
}

std::string reason_for(const DriftFit& fit,
                       const DriftEvidence& evidence,
                       const DriftNoise& noise) {
  const double record_s = evidence.duration_s();
  switch (fit.why) {
    case DriftReason::identified:
      return {};
    case DriftReason::no_warm_up:
      return fmt::format(
          "no warm-up found: an exponential explains no more than noise (p = "
          "{:.2g})",
          fit.constant_p);
    case DriftReason::hidden_by_noise:
      return fmt::format(
          "amplitude not above the {}: slow noise of the bias explains the drift without a warm-up "
          "(p "
          "= {:.2g})",
          noise.random_walk > 0.0 ? "random walk"
          : noise.markov > 0.0    ? "Markov noise"
                                  : "flicker",
          fit.constant_p);
    case DriftReason::steps:
      return fmt::format("steps instead of an exponential: {} in {:.3g} s", fit.curve.steps.size(),
                         record_s);
    case DriftReason::line:
      return fmt::format(
          "a straight line explains the drift as well: the time constant is {}, the "
          "recording only {:.3g} s long: record for longer",
          times_of(fit), record_s);
    case DriftReason::longer_than_record:
      return fmt::format(
          "time constant not bounded within the record of {:.3g} s: it is {}: record "
          "for longer",
          record_s, times_of(fit));
    case DriftReason::unexplained:
      return "the bias changes in a way that is neither noise nor an exponential: the whitened "
             "residuals "
             "are not white";
    case DriftReason::begun_later:
      return fmt::format(
          "a drift with a time constant of {:.3g} s, {:.3g} s after power-on, is not a warm-up: "
          "it would have settled long before",
          fit.best_time_constant_s, evidence.start_s());
    case DriftReason::shape_undetermined:
      return fmt::format(
          "a warm-up; its shape cannot be determined from this recording: a curve of another shape "
          "than the exponential fits as well or better ({})",
          rivals_of(fit));
    case DriftReason::oscillation:
      return fmt::format(
          "no warm-up but a slow oscillation: a sine with a period of {:.3g} s, possibly due to "
          "temperature, explains the drift better than any warm-up",
          fit.curve.time_constant_s);
    case DriftReason::shorter_than_resolved:
      return fmt::format(
          "settled within {:.3g} s, which is too short for blocks of {:.3g} s: "
          "analyse only the beginning",
          fit.best_time_constant_s * 3.0, evidence.block_s());
  }
  return {};
}

class DriftVerdict {
 public:
  DriftVerdict(const DriftEvidence& evidence, const DriftSelection& trials)
      : evidence_(evidence),
        trials_(trials),
        exponential_(trials.best(true)),
        other_(trials.best(false)),
        profile_(evidence, exponential_) {}

  [[nodiscard]] FittedDrift run() {
    DriftFit& fit = out_.fit;
    fit.block_s = evidence_.block_s();
    fit.candidates = trials_.candidates();
    fit.best_time_constant_s = std::exp(exponential_.at.log_times.front());
    test();
    const PlacedCurve warm = place(evidence_, exponential_);
    const Interval95 T = profile_.time_constant(std::sqrt(warm.curve.covariance(2, 2)));
    if (!T.upper_95 || *T.upper_95 > evidence_.duration_s()) fit.time_constant_above_s = T.lower_95;
    if (!T.lower_95) fit.time_constant_below_s = T.upper_95;
    fit.profile = profile_.points(T);
    fit.undetected_below = undetected_below(evidence_, trials_.of(DriftShape::constant));
    fit.why = why(T);
    if (fit.why == DriftReason::shorter_than_resolved) fit.time_constant_below_s = T.upper_95;
    const std::vector<const DriftFitAtShape*> as_good = trials_.as_good();
    const bool open =
        fit.why == DriftReason::shape_undetermined || fit.why == DriftReason::oscillation;
    if ((fit.why == DriftReason::identified && !explained(exponential_)) ||
        (open && !explained(*as_good.front())))
      fit.why = DriftReason::unexplained;
    fit.identified = fit.why == DriftReason::identified;
    const bool none = !fit.identified && !(open && fit.why != DriftReason::unexplained);
    const DriftFitAtShape& chosen = none             ? other_
                                    : fit.identified ? exponential_
                                                     : *as_good.front();
    const PlacedCurve placed = fit.identified ? warm : place(evidence_, chosen);
    fit.curve = placed.curve;
    fit.end = placed.end;
    fit.noise = noise_of(chosen);
    const double dof = profile_.amplitude_dof();
    fit.a2 = interval(fit.curve.a2, std::sqrt(fit.curve.covariance(0, 0)), dof);
    if (!none && !fit.identified) allow(as_good, dof);
    if (fit.identified) {
      fit.hidden_walk = possibility(exponential_, 1.0);
      intervals(T);
    }
    if (has_line(fit.curve.shape)) {
      const Index place = fit.curve.shape == DriftShape::line ? 1 : 3;
      fit.slope_per_s =
          interval(fit.curve.slope_per_s, std::sqrt(fit.curve.covariance(place, place)), dof);
    }
    fit.reason = reason_for(fit, evidence_, fit.noise);
    filter(chosen);
    return std::move(out_);
  }

 private:
  void test() {
    DriftFit& fit = out_.fit;
    const DriftFitAtShape& plain = trials_.of(DriftShape::exponential);
    const GainTest constant = trials_.test(plain, DriftShape::constant);
    const GainTest line = trials_.test(plain, DriftShape::line);
    fit.constant_deviance = constant.deviance;
    fit.constant_p = constant.p;
    fit.line_deviance = line.deviance;
    fit.line_p = line.p;
  }

  // All shapes that fit as well, and the level at power-on for each.
  void allow(const std::vector<const DriftFitAtShape*>& as_good, double dof) {
    DriftFit& fit = out_.fit;
    std::vector<Interval95> levels;
    double sum = 0.0;
    for (const DriftFitAtShape* trial : as_good) {
      const double weight = std::exp(0.5 * (as_good.front()->akaike() - trial->akaike()));
      sum += weight;
      const DriftCurve& curve = fit.possibilities.emplace_back(possibility(*trial, weight)).curve;
      levels.push_back(interval(curve.a2, std::sqrt(curve.covariance(0, 0)), dof));
    }
    for (DriftPossibility& one : fit.possibilities) one.weight /= sum;
    fit.a2 = covering(levels, fit.possibilities);
  }

  [[nodiscard]] DriftPossibility possibility(const DriftFitAtShape& trial, double weight) const {
    const DriftFitAtShape walked = trials_.with_hidden_walk(trial);
    const PlacedCurve placed = place(evidence_, walked);
    return {placed.curve, noise_of(walked), placed.end, weight};
  }

  // Clearly better by both criteria.
  [[nodiscard]] static bool beats(const DriftFitAtShape& a, const DriftFitAtShape& b) {
    return std::min(b.akaike() - a.akaike(),
                    b.candidate.information_criterion - a.candidate.information_criterion) >=
           DriftSelection::clear_margin;
  }

  // Whether a non-exponential shape is clearly better.
  [[nodiscard]] bool outdone() const {
    return std::ranges::any_of(trials_.rivals(), [&](const DriftFitAtShape* rival) {
      return beats(*rival, exponential_);
    });
  }

  // Verdict on an otherwise identified exponential by comparison with other shapes. It must be
  // clearly better than each by both criteria: by Schwarz's too, where it has more parameters,
  // which adapt to a random walk.
  [[nodiscard]] DriftReason by_shape() const {
    const std::vector<const DriftFitAtShape*> rivals = trials_.rivals();
    const auto beaten = [&](const DriftFitAtShape* rival) { return beats(exponential_, *rival); };
    if (std::ranges::all_of(rivals, beaten)) return DriftReason::identified;
    // A sine alone is not a warm-up.
    const std::vector<const DriftFitAtShape*> as_good = trials_.as_good();
    return as_good.size() == 1 && as_good.front()->at.shape == DriftShape::sine
               ? DriftReason::oscillation
               : DriftReason::shape_undetermined;
  }

  // The exponential in addition to a line must be significant.
  [[nodiscard]] bool significant() const {
    if (exponential_.at.shape == DriftShape::exponential_and_line)
      return trials_.test(exponential_, DriftShape::line).p < DriftSelection::level;
    return out_.fit.constant_p < DriftSelection::level;
  }

  [[nodiscard]] DriftReason why(const Interval95& T) const {
    const DriftFit& fit = out_.fit;
    double least = exponential_.candidate.information_criterion;
    for (const DriftFitAtShape* trial : trials_.rivals())
      least = std::min(least, trial->candidate.information_criterion);
    const bool best = least < other_.candidate.information_criterion;
    if (!best && other_.at.shape == DriftShape::steps) return DriftReason::steps;
    if (!best && other_.at.shape == DriftShape::line) return DriftReason::line;
    if (!significant())
      return trials_.plain_test(trials_.of(DriftShape::exponential)).p < DriftSelection::level
                 ? DriftReason::hidden_by_noise
                 : DriftReason::no_warm_up;
    // A shorter one is a few odd blocks at the beginning; in a short table it is not odd.
    constexpr double most_blocks = 10.0, share = 1.0 / 24.0, line_level = 0.05;
    constexpr double longest_ago = 10.0;  // no recording shows e^-10 of its amplitude
    const double fewest = std::min(most_blocks, share * static_cast<double>(evidence_.blocks()));
    if (evidence_.start_s() > longest_ago * T.value) return DriftReason::begun_later;
    if (!T.lower_95 || T.value < fewest * evidence_.block_s())
      return DriftReason::shorter_than_resolved;
    if (!T.upper_95 || *T.upper_95 > evidence_.duration_s() || T.value > evidence_.duration_s())
      return fit.line_p > line_level ? DriftReason::line
             : outdone()             ? by_shape()
                                     : DriftReason::longer_than_record;
    return best ? by_shape() : DriftReason::hidden_by_noise;
  }

  void intervals(const Interval95& T) {
    DriftFit& fit = out_.fit;
    const MatrixXd& C = fit.curve.covariance;
    fit.time_constant_s = T;
    fit.a1 = profile_.amplitude(std::sqrt(C(1, 1)));
    if (fit.curve.shape != DriftShape::two_exponentials) return;
    const double dof = profile_.amplitude_dof();
    fit.second_a1 = interval(fit.curve.second_a1, std::sqrt(C(3, 3)), dof);
    fit.second_time_constant_s =
        log_interval(fit.curve.second_time_constant_s, std::sqrt(C(4, 4)), dof);
  }

  // Whether the noise is consistent with the fitted model.
  [[nodiscard]] bool explained(const DriftFitAtShape& trial) {
    constexpr double impossible = 1e-6;
    filter(trial);
    const double block_s = evidence_.block_s();
    const auto fitted =
        static_cast<std::size_t>(trial.fit.coefficients.size() - evidence_.dummies().cols());
    const auto test = signal::test_whiteness(out_.whitened, {1.0 / block_s, block_s, fitted + 1});
    return !test || std::min(test->ljung_box_p, test->periodogram_p) >= impossible;
  }

  // The Wiener filter keeps all of the residual but its white share.
  void filter(const DriftFitAtShape& trial) {
    const MatrixXd columns = whole_columns(evidence_, trial.at);
    const Index rest = columns.rows() - 1, own = columns.cols() - evidence_.dummies().cols();
    const VectorXd residual = evidence_.ordinates() - columns * trial.fit.coefficients;
    const double white = trial.noise.strength(trial.fit, Term::white);
    VectorXd bias = residual;
    bias.tail(rest).array() *= 1.0 - white * white / trial.fit.density.array();
    bias += columns.leftCols(own) * trial.fit.coefficients.head(own);
    out_.bias = evidence_.series(bias);
    VectorXd whitened = VectorXd::Zero(residual.size());
    whitened.tail(rest) =
        residual.tail(rest).cwiseProduct(trial.fit.density.cwiseSqrt().cwiseInverse());
    out_.whitened = evidence_.series(whitened);
    for (const std::size_t k : evidence_.missing())
      out_.whitened[k] = std::numeric_limits<double>::quiet_NaN();
  }

  const DriftEvidence& evidence_;
  const DriftSelection& trials_;
  const DriftFitAtShape& exponential_;
  const DriftFitAtShape& other_;
  DriftProfile profile_;
  FittedDrift out_;
};

}  // namespace

FittedDrift fit_drift(const DriftEvidence& evidence) {
  const DriftSelection trials(evidence);
  return DriftVerdict(evidence, trials).run();
}

}  // namespace proofmass::characterise

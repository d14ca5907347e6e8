#include "proofmass/characterise/drift_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>

#include "proofmass/characterise/drift_profile.hpp"
#include "proofmass/characterise/drift_state.hpp"
#include "proofmass/characterise/drift_trial.hpp"
#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/linalg.hpp"
#include "proofmass/signal/whiteness.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double level = 0.01;  // of the test against no exponential

// Two time constants nearer than this cannot be told from one.
constexpr double least_ratio = 2.0;

constexpr std::array<DriftShape, 4> first_shapes{DriftShape::constant, DriftShape::line,
                                                 DriftShape::steps, DriftShape::exponential};
constexpr std::array<DriftShape, 2> further_shapes{DriftShape::exponential_and_line,
                                                   DriftShape::two_exponentials};

bool has_exponential(const DriftTrial& trial) {
  return !trial.at.log_times.empty();
}

VectorXd data_of(const DriftEvidence& evidence) {
  return evidence.ordinates().tail(evidence.blocks() - 1);
}

struct Tested {
  double deviance = 0.0, p = 1.0;
};

// How far the whitened exponential travels over the unit sphere, what is fitted anyway projected
// out, as T runs through its range.
double path_length(const DriftEvidence& evidence, const MatrixXd& fitted, const VectorXd& density) {
  constexpr int places = 60;
  const TimeRange range = time_range(evidence);
  const VectorXd root = density.cwiseSqrt().cwiseInverse();
  const MatrixXd X = root.asDiagonal() * fitted;
  const MatrixXd inverse = X.cols() > 0 ? positive_inverse(X.transpose() * X) : MatrixXd(0, 0);
  double length = 0.0;
  VectorXd last;
  for (int k = 0; k < places; ++k) {
    const double T = range.lower_s *
                     std::pow(range.upper_s / range.lower_s, static_cast<double>(k) / (places - 1));
    VectorXd e = root.cwiseProduct(evidence.rise(T).tail(evidence.blocks() - 1));
    if (X.cols() > 0) e -= X * (inverse * (X.transpose() * e));
    e.normalize();
    if (k > 0) length += std::acos(std::clamp(std::abs(e.dot(last)), 0.0, 1.0));
    last = std::move(e);
  }
  return length;
}

// The exponential of a trial against the shape without it: what the best of several noises leaves
// to be gained.
Tested against(const DriftEvidence& evidence,
               const DriftTrial& trial,
               DriftShape without,
               const std::vector<const NoiseColumns*>& noises) {
  const ShapeAt null{without, {}, {}};
  const OrdinateMeans means{linear_columns(evidence, null), tangent_columns(evidence, trial.at)};
  double best = -std::numeric_limits<double>::infinity();
  for (const NoiseColumns* noise : noises)
    best = std::max(best, fit_ordinates(data_of(evidence), noise->P, means).log_likelihood);
  Tested tested;
  tested.deviance = std::max(0.0, 2.0 * (trial.fit.log_likelihood - best));
  const double L = path_length(evidence, means.fitted, trial.fit.density);
  tested.p = std::min(1.0, chi_square_p(tested.deviance, 1.0) +
                               L / std::numbers::pi * std::exp(-0.5 * tested.deviance));
  return tested;
}

// All shapes, fitted.
class Trials {
 public:
  explicit Trials(const DriftEvidence& evidence) : evidence_(evidence), choice_(evidence) {
    trials_.reserve(first_shapes.size() + further_shapes.size());
    for (const DriftShape shape : first_shapes) add(shape);
    // More than one exponential only where there is one.
    if (test(of(DriftShape::exponential), DriftShape::constant).p >= level) return;
    for (const DriftShape shape : further_shapes) add(shape);
  }

  [[nodiscard]] const DriftTrial& of(DriftShape shape) const {
    return *std::ranges::find(trials_, shape, [](const DriftTrial& t) { return t.at.shape; });
  }
  // The best of those with an exponential, or of those without. A shape that asks for more than
  // those before it has to show strong evidence of it: a criterion lower by 6 (R. E. Kass, A. E.
  // Raftery, J. Amer. Statist. Assoc. 90 (1995) 773).
  [[nodiscard]] const DriftTrial& best(bool exponential) const {
    constexpr double strong = 6.0;
    const DriftTrial* best = nullptr;
    for (const DriftTrial& trial : trials_) {
      if (has_exponential(trial) != exponential) continue;
      if (best == nullptr || criterion(trial) < criterion(*best) - strong) best = &trial;
    }
    return *best;
  }
  [[nodiscard]] static double criterion(const DriftTrial& trial) {
    return trial.candidate.information_criterion;
  }
  [[nodiscard]] Tested test(const DriftTrial& trial, DriftShape without) const {
    return against(evidence_, trial, without, {&choice_.base(), &trial.noise, &of(without).noise});
  }
  // With white noise alone, as a plain fit takes it to be.
  [[nodiscard]] Tested plain_test(const DriftTrial& trial) const {
    const NoiseColumns& white = choice_.white();
    DriftTrial plain = trial;
    plain.noise = white;
    plain.fit =
        fit_ordinates(data_of(evidence_), white.P,
                      {linear_columns(evidence_, trial.at), tangent_columns(evidence_, trial.at)});
    return against(evidence_, plain, DriftShape::constant, {&white});
  }
  [[nodiscard]] std::vector<DriftCandidate> candidates() const {
    std::vector<DriftCandidate> all;
    all.reserve(trials_.size());
    for (const DriftTrial& trial : trials_) all.push_back(trial.candidate);
    std::ranges::sort(all, {}, &DriftCandidate::information_criterion);
    return all;
  }

 private:
  void add(DriftShape shape) {
    DriftTrial trial = try_shape(evidence_, choice_, shape);
    // Without a step found it is the constant again; two that are as good as one say nothing more.
    if (shape == DriftShape::steps && trial.at.step_blocks.empty()) return;
    if (shape == DriftShape::two_exponentials &&
        std::abs(trial.at.log_times[0] - trial.at.log_times[1]) < std::log(least_ratio))
      return;
    trials_.push_back(std::move(trial));
  }

  const DriftEvidence& evidence_;
  NoiseChoice choice_;
  std::vector<DriftTrial> trials_;
};

Interval95 interval(double value, double std, double dof) {
  constexpr double two_sided = 0.975;
  const double reach = student_t_quantile(two_sided, dof) * std;
  return {value, std, value - reach, value + reach};
}

// Of a time constant by its logarithm.
Interval95 log_interval(double value, double std_of_log, double dof) {
  const Interval95 of_log = interval(std::log(value), std_of_log, dof);
  return {value, value * std_of_log, std::exp(*of_log.lower_95), std::exp(*of_log.upper_95)};
}

double undetected_below(const DriftEvidence& evidence, const DriftTrial& constant) {
  constexpr double share = 0.2, two_sided = 1.959963984540054;
  OrdinateMeans means{linear_columns(evidence, constant.at), {}};
  means.fitted.conservativeResize(Eigen::NoChange, means.fitted.cols() + 1);
  means.fitted.rightCols(1) =
      evidence.rise(share * evidence.duration_s()).tail(evidence.blocks() - 1);
  const OrdinateFit fit =
      evaluate_ordinates(data_of(evidence), constant.noise.P, means, constant.fit.strength);
  const Index last = means.fitted.cols() - 1;
  return std::abs(fit.coefficients(last)) + two_sided * std::sqrt(fit.covariance(last, last));
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
          "no warm-up seen: an exponential explains no more than noise does (p = "
          "{:.2g})",
          fit.constant_p);
    case DriftReason::hidden_by_noise:
      return fmt::format(
          "amplitude not above the {}: wander of the bias explains the drift without a warm-up (p "
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
      return "something moves the bias that is neither noise nor an exponential: what is left is "
             "not "
             "white once the noise is divided out";
    case DriftReason::shorter_than_resolved:
      return fmt::format(
          "settled within {:.3g} s, which is too short for blocks of {:.3g} s: "
          "analyse the beginning alone with --to",
          fit.best_time_constant_s * 3.0, evidence.block_s());
  }
  return {};
}

class Verdict95 {
 public:
  Verdict95(const DriftEvidence& evidence, const Trials& trials)
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
    if (fit.why == DriftReason::identified && !explained(exponential_))
      fit.why = DriftReason::unexplained;
    fit.identified = fit.why == DriftReason::identified;
    const DriftTrial& chosen = fit.identified ? exponential_ : other_;
    const PlacedCurve placed = fit.identified ? warm : place(evidence_, other_);
    fit.curve = placed.curve;
    fit.end = placed.end;
    fit.noise = noise_of(chosen);
    const double dof = profile_.amplitude_dof();
    fit.a2 = interval(fit.curve.a2, std::sqrt(fit.curve.covariance(0, 0)), dof);
    if (fit.identified) intervals(T);
    if (fit.curve.shape == DriftShape::line ||
        fit.curve.shape == DriftShape::exponential_and_line) {
      const Index place = fit.identified ? 3 : 1;
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
    const DriftTrial& plain = trials_.of(DriftShape::exponential);
    const Tested constant = trials_.test(plain, DriftShape::constant);
    const Tested line = trials_.test(plain, DriftShape::line);
    fit.constant_deviance = constant.deviance;
    fit.constant_p = constant.p;
    fit.line_deviance = line.deviance;
    fit.line_p = line.p;
  }

  // The exponential beside a line has to be needed beside it.
  [[nodiscard]] bool significant() const {
    if (exponential_.at.shape == DriftShape::exponential_and_line)
      return trials_.test(exponential_, DriftShape::line).p < level;
    return out_.fit.constant_p < level;
  }

  [[nodiscard]] DriftReason why(const Interval95& T) const {
    const DriftFit& fit = out_.fit;
    const bool best = Trials::criterion(exponential_) < Trials::criterion(other_);
    if (!best && other_.at.shape == DriftShape::steps) return DriftReason::steps;
    if (!best && other_.at.shape == DriftShape::line) return DriftReason::line;
    if (!significant())
      return trials_.plain_test(trials_.of(DriftShape::exponential)).p < level
                 ? DriftReason::hidden_by_noise
                 : DriftReason::no_warm_up;
    // What spans fewer is a few odd blocks at the beginning.
    constexpr double fewest_blocks = 10.0, line_level = 0.05;
    if (!T.lower_95 || T.value < fewest_blocks * evidence_.block_s())
      return DriftReason::shorter_than_resolved;
    if (!T.upper_95 || *T.upper_95 > evidence_.duration_s() || T.value > evidence_.duration_s())
      return fit.line_p > line_level ? DriftReason::line : DriftReason::longer_than_record;
    return best ? DriftReason::identified : DriftReason::hidden_by_noise;
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

  // Whether the noise can be what the fit took it for.
  [[nodiscard]] bool explained(const DriftTrial& trial) {
    constexpr double impossible = 1e-6;
    filter(trial);
    const double block_s = evidence_.block_s();
    const auto fitted =
        static_cast<std::size_t>(trial.fit.coefficients.size() - evidence_.dummies().cols());
    const auto test = signal::test_whiteness(out_.whitened, {1.0 / block_s, block_s, fitted + 1});
    return !test || std::min(test->ljung_box_p, test->periodogram_p) >= impossible;
  }

  // Of what is left the Wiener filter keeps all but the white share.
  void filter(const DriftTrial& trial) {
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
  const Trials& trials_;
  const DriftTrial& exponential_;
  const DriftTrial& other_;
  DriftProfile profile_;
  FittedDrift out_;
};

}  // namespace

FittedDrift fit_drift(const DriftEvidence& evidence) {
  const Trials trials(evidence);
  return Verdict95(evidence, trials).run();
}

}  // namespace proofmass::characterise

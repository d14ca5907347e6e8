#include "proofmass/estimate/motor/electrical.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/motor/angle_errors.hpp"

namespace proofmass::estimate::motor {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Order of the unknowns after those of Electrical.
constexpr Index half_backlash = electrical_count, first_error = half_backlash + 1;

// Brushes drop their voltage with the sign of the current, smoothly through zero: Vb tanh(i/s),
// with its derivative by ln s. The current is not smoothed first, which would not be linear.
struct BrushTerms {
  std::vector<double> drop, by_knee;
};

BrushTerms brush_terms(const Series& series, const ElectricalStart& start) {
  BrushTerms out;
  for (const double i : series.sampled_current_a) {
    const double sign = start.brush_knee_a > 0.0 ? std::tanh(i / start.brush_knee_a) : 0.0;
    out.drop.push_back(sign);
    out.by_knee.push_back(sign == 0.0 ? 0.0
                                      : -start.brush_drop_per_constant * i / start.brush_knee_a *
                                            (1.0 - sign * sign));
  }
  return out;
}

// What the unknowns of Electrical multiply in the motor's angle and speed.
struct Terms {
  MatrixXd angle, speed;
};

// Where the motor stands: the load rests, and the current has been negligible for longer than the
// motor coasts.
std::vector<bool> standing(const Series& series, const Motion& motion) {
  constexpr double share = 0.05, coasting_s = 0.05;  // of the largest current
  const double least_a = share * largest_magnitude(series.current_a);
  std::vector<bool> stands;
  double since_s = 0.0;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const bool idle = motion.contact[k] == 0 && std::abs(series.current_a[k]) < least_a;
    since_s = idle ? since_s + series.step_s : 0.0;
    stands.push_back(since_s > coasting_s);
  }
  return stands;
}

// The integral of a term of the back-EMF, which is zero where the motor stands: brushes take a
// voltage below their drop without a current.
std::vector<double> integral_in_motion(std::vector<double> term,
                                       const std::vector<bool>& stands,
                                       double step_s) {
  for (std::size_t k = 0; k < term.size(); ++k)
    if (stands[k]) term[k] = 0.0;
  return integral(term, step_s);
}

Terms terms_of(const Series& series, const Motion& motion, const ElectricalStart& start) {
  const BrushTerms brush = brush_terms(series, start);
  const std::vector<bool> stands = standing(series, motion);
  const std::vector<double> voltage = integral_in_motion(series.voltage_v, stands, series.step_s),
                            current = integral_in_motion(series.current_a, stands, series.step_s),
                            drop = integral_in_motion(brush.drop, stands, series.step_s),
                            by_knee = integral_in_motion(brush.by_knee, stands, series.step_s),
                            constant = integral_in_motion(std::vector<double>(series.size(), 1.0),
                                                          stands, series.step_s),
                            change = slopes(series.current_a, series.step_s, 3);
  const auto n = static_cast<Index>(series.size());
  Terms out{MatrixXd(n, electrical_count), MatrixXd(n, electrical_count)};
  for (Index k = 0; k < n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    out.angle.row(k) << voltage[at], -current[at], -series.current_a[at], -drop[at], -by_knee[at],
        -constant[at];
    out.speed.row(k) << series.voltage_v[at], -series.current_a[at], -change[at], -brush.drop[at],
        -brush.by_knee[at], -1.0;
  }
  return out;
}

// Current within which the drop changes its sign, as a share of the largest.
constexpr double usual_knee_share = 0.02, ln_knee_std = 1.2;

// Inductance and brush drop hardly show at some 100 Hz and are nuisances: small motors have L/R of
// 1 to 15 ms, and drops of up to some volts at 24 V. A drop of L i and half the backlash change
// with the direction alike, so the prior of L matters.
void set_priors(const Series& series,
                const Motion& motion,
                const ElectricalStart& start,
                LevelRegression& regression) {
  constexpr double anything = 1e3, inductance_s = 0.005, drop_share = 0.02, offset_share = 0.005;
  const double top_v = largest_magnitude(series.voltage_v),
               top_a = largest_magnitude(series.current_a);
  const double constant = motion.top_radps() / top_v;  // at least 1/K
  VectorXd& std = regression.prior_std;
  std(per_constant) = anything * constant;
  std(resistance) = anything * constant * top_v / top_a;
  regression.prior_mean(inductance) = inductance_s * start.resistance_per_constant;
  std(inductance) = std::max(inductance_s * start.resistance_per_constant, 1e-9);
  std(brush_drop) = drop_share * top_v * constant;
  if (start.brush_knee_a > 0.0)
    regression.prior_mean(brush_knee) = std::log(usual_knee_share * top_a / start.brush_knee_a);
  std(brush_knee) = ln_knee_std;
  std(offset) = offset_share * top_v * constant;
  std(half_backlash) = 0.05;
}

// Shifts the model's angle to the mean of the measured one, in each part between gaps.
void level_with(const Series& series, const Motion& motion, std::vector<double>& angle_rad) {
  for (std::size_t first = 0; first < series.size();) {
    std::size_t end = first;
    Moments offset;
    for (; end < series.size() && (end == first || series.bridged[end] == series.bridged[first]);
         ++end)
      if (motion.contact[end] != 0) offset.add(series.angle_rad[end] - angle_rad[end]);
    for (std::size_t k = first; k < end && offset.count > 0; ++k) angle_rad[k] += offset.mean;
    first = end;
  }
}

// The regression of the measured angle, linear about a start.
struct AngleRegression {
  AngleRegression(const Series& series, const Motion& motion, const ElectricalStart& start)
      : errors(series, motion), terms(terms_of(series, motion, start)) {
    const Index unknowns = first_error + errors.count();
    const auto used = static_cast<Index>(motion.contact.size()) -
                      std::ranges::count(motion.contact, std::int8_t{0});
    regression = {.columns = MatrixXd(unknowns + 1, used),
                  .starts = {0},
                  .prior_std = VectorXd::Zero(unknowns),
                  .prior_mean = VectorXd::Zero(unknowns)};
    set_priors(series, motion, start, regression);
    errors.set_priors(regression.prior_std.tail(errors.count()));
    Index row = 0;
    bool over_gap = false;  // the integrals over it are unknown
    for (std::size_t k = 0; k < series.size(); ++k) {
      over_gap = over_gap || series.bridged[k];
      if (motion.contact[k] == 0) continue;
      if (std::exchange(over_gap, false) && row > 0)
        regression.starts.push_back(static_cast<std::size_t>(row));
      auto column = regression.columns.col(row++);
      column.head(electrical_count) = terms.angle.row(static_cast<Index>(k)).transpose();
      column(half_backlash) = -motion.contact[k];
      errors.write(k, column.segment(first_error, errors.count()));
      column(unknowns) = series.angle_rad[k];
      regression.time_s.push_back(series.time_s(k));
    }
  }

  AngleErrors errors;
  Terms terms;
  LevelRegression regression;
};

// The knee of the highest likelihood on a logarithmic grid.
ElectricalStart with_likely_knee(const Series& series,
                                 const Motion& motion,
                                 const ElectricalStart& start) {
  constexpr std::array shares = {0.005, 0.01, 0.02, 0.04, 0.08, 0.16};
  ElectricalStart out = start;
  std::optional<double> ratio;  // of the noise: the first fit's
  double least = std::numeric_limits<double>::infinity();
  for (const double share : shares) {
    ElectricalStart tried = start;
    tried.brush_knee_a = share * largest_magnitude(series.sampled_current_a);
    const AngleRegression linear(series, motion, tried);
    if (!ratio) ratio = fit(linear.regression).ratio;
    const LevelFit found = fit_at(linear.regression, *ratio);
    tried.brush_drop_per_constant = found.value(brush_drop);
    if (found.cost < least) out = tried;
    least = std::min(least, found.cost);
  }
  return out;
}

ElectricalFit concluded(const Series& series,
                        const Motion& motion,
                        const AngleRegression& linear,
                        const LevelFit& found,
                        const ElectricalStart& start) {
  ElectricalFit out{
      .value = found.value.head(electrical_count),
      .covariance = found.covariance.topLeftCorner(electrical_count, electrical_count),
      .half_backlash_rad = found.value(half_backlash),
      .half_backlash_std_rad = std::sqrt(found.covariance(half_backlash, half_backlash)),
      .angle_noise_rad = found.white_std,
      .correlation = found.correlation,
      .speed_terms = linear.terms.speed,
      .next = {.resistance_per_constant = std::max(found.value(resistance), 0.0),
               .brush_drop_per_constant = found.value(brush_drop),
               .brush_knee_a = start.brush_knee_a}};
  const VectorXd angle = linear.terms.angle * out.value;
  for (std::size_t k = 0; k < series.size(); ++k)
    out.load_angle_rad.push_back(angle(static_cast<Index>(k)) -
                                 motion.contact[k] * out.half_backlash_rad);
  level_with(series, motion, out.load_angle_rad);
  const std::vector<double>& time_s = linear.regression.time_s;
  const std::vector<double> level = smoothed_level(linear.regression, found);
  for (std::size_t k = 0, last = 0; k < series.size(); ++k) {
    while (last + 1 < level.size() && time_s[last + 1] <= series.time_s(k)) ++last;
    const std::size_t next = std::min(last + 1, level.size() - 1);
    const double span_s = time_s[next] - time_s[last];
    const double share =
        span_s > 0.0 ? std::clamp((series.time_s(k) - time_s[last]) / span_s, 0.0, 1.0) : 0.0;
    out.motor_angle_rad.push_back(angle(static_cast<Index>(k)) +
                                  std::lerp(level[last], level[next], share));
  }
  return out;
}

}  // namespace

double resistance_per_constant(const Series& series, const Motion& motion) {
  double ii = 0.0, iw = 0.0, ww = 0.0, iu = 0.0, wu = 0.0;
  for (std::size_t k = 0; k < series.size(); ++k) {
    if (motion.contact[k] == 0) continue;
    const double i = series.current_a[k], w = motion.speed_radps[k], u = series.voltage_v[k];
    ii += i * i;
    iw += i * w;
    ww += w * w;
    iu += i * u;
    wu += w * u;
  }
  const double resistance = iu * ww - wu * iw, constant = wu * ii - iu * iw;
  return constant > 0.0 ? std::max(resistance / constant, 0.0) : 0.0;
}

ElectricalFit fit_electrical(const Series& series,
                             const Motion& motion,
                             const ElectricalStart& start) {
  ElectricalStart at = start;
  if (!(at.brush_knee_a > 0.0)) at = with_likely_knee(series, motion, at);
  // Newton's steps for the knee, on which the voltage depends nonlinearly; the noise by the first.
  constexpr int most_steps = 6;
  constexpr double longest_step = 0.5, close = 0.02;  // of ln s
  std::optional<double> ratio;
  for (int step = 0; step < most_steps; ++step) {
    const AngleRegression linear(series, motion, at);
    if (!ratio) ratio = fit(linear.regression).ratio;
    const LevelFit found = fit_at(linear.regression, *ratio);
    const double change = std::clamp(found.value(brush_knee), -longest_step, longest_step);
    if (std::abs(change) < close) break;
    at.brush_drop_per_constant = found.value(brush_drop);
    at.brush_knee_a *= std::exp(change);
  }
  const AngleRegression linear(series, motion, at);
  return concluded(series, motion, linear, fit(linear.regression), at);
}

}  // namespace proofmass::estimate::motor

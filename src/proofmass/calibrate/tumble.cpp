#include "proofmass/calibrate/tumble.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/calibrate/tumble/coefficients.hpp"
#include "proofmass/calibrate/tumble/design.hpp"
#include "proofmass/calibrate/tumble/findings.hpp"
#include "proofmass/calibrate/tumble/regression.hpp"
#include "proofmass/calibrate/tumble/words.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/number_words.hpp"
#include "proofmass/core/statistics.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::calibrate {
namespace {

std::string named(View<TumblePosition> positions, std::size_t k) {
  return positions[k].label.empty() ? fmt::format("position {}", k + 1) : positions[k].label;
}

Status check(View<TumblePosition> positions, const TumbleOptions& options) {
  PM_EXPECTS(options.gravity_mps2 > 0.0 && options.gravity_std_mps2 >= 0.0);
  PM_EXPECTS(options.indexing_std_rad.value_or(0.0) >= 0.0 && options.noise_dof >= 0.0);
  PM_EXPECTS(options.drift_std_mps2.value_or(0.0) >= 0.0);
  if (positions.size() < 2)
    return Error{Errc::too_few_samples,
                 fmt::format("{} positions: scale factor and bias need two, the input axis up and "
                             "down; four or more determine the rest",
                             positions.size())};
  constexpr std::size_t most = 5000;
  if (positions.size() > most)
    return Error{Errc::invalid_argument,
                 fmt::format("{} positions: expected {} at most; is this a recording of a table "
                             "that turns?",
                             positions.size(), most)};
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const TumblePosition& p = positions[k];
    if (!std::isfinite(p.angle_rad) || !std::isfinite(p.output) || !std::isfinite(p.mount_rad) ||
        !std::isfinite(p.output_std) || (p.time_s && !std::isfinite(*p.time_s)))
      return Error{Errc::not_finite,
                   named(positions, k) + ": angle, output, std or time is not a number"};
    if (p.output_std < 0.0)
      return Error{Errc::invalid_argument, named(positions, k) + ": its std is below 0"};
    if (p.plane != 1 && p.plane != 2)
      return Error{Errc::invalid_argument,
                   fmt::format("{}: plane {}: expected 1 or 2", named(positions, k), p.plane)};
  }
  return Done{};
}

TumbleErrors errors_of(View<TumblePosition> positions,
                       const TumbleOptions& options,
                       const TumbleDesign& design,
                       bool noise_known) {
  TumbleErrors errors;
  const auto n = static_cast<Eigen::Index>(positions.size());
  errors.noise_known = noise_known;
  errors.noise_dof = noise_known ? options.noise_dof : 0.0;
  errors.noise_std = Eigen::VectorXd::Ones(n);
  errors.lever = Eigen::VectorXd::Zero(n);
  errors.setting = design.setting;
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto row = static_cast<std::size_t>(k);
    if (noise_known) errors.noise_std(k) = positions[row].output_std;
    errors.lever(k) = std::cos(design.phi_rad[row]);  // times K1 g, inserted once it is estimated
  }
  return errors;
}

// Fits twice: first for K1 and the drift, then with the errors of indexing and drift, which K1
// converts to units of the output.
TumbleRegression regress(const TumbleDesign& design,
                         const Eigen::VectorXd& outputs,
                         TumbleErrors errors,
                         const TumbleOptions& options) {
  const double indexing = options.indexing_std_rad.value_or(assumed_indexing_std_rad);
  const double nonlinear = options.drift_std_mps2.value_or(assumed_drift_std_mps2);
  TumbleRegression found = regress_tumble(design.A, outputs, errors);
  // Without a known scatter, or with zero residuals, there is no standard deviation to increase.
  const double amplitude = std::abs(amplitude_of(design, found.beta));
  const bool exact = indexing <= 0.0 && nonlinear <= 0.0;
  if (exact || !found.has_scale || !(found.sigma > 0.0) || !(amplitude > 0.0)) return found;
  errors.lever *= amplitude;
  errors.indexing_std_rad = indexing;
  errors.indexing_assumed = !options.indexing_std_rad;
  errors.drift_std = nonlinear * amplitude / options.gravity_mps2;
  errors.drift_assumed = !options.drift_std_mps2;
  // A drift with a linear part also has a nonlinear one: for an exponential with a time constant of
  // a third of the test, amplitudes (cosine, sine) of 0.12 and 0.06 of its total change; for a step
  // in the middle 0.32.
  constexpr double curved = 0.25;
  const auto drift = design.find(TumbleTerm::drift);
  double by_line = 0.0;
  if (errors.drift_assumed && drift)
    by_line = curved * std::abs(found.beta(static_cast<Eigen::Index>(*drift)));
  errors.drift_std = std::hypot(errors.drift_std, by_line);
  errors.drift = drift_shapes(design, errors.drift_std > 0.0 ? by_line / errors.drift_std : 0.0);
  return regress_tumble(design.A, outputs, errors);
}

Status check_amplitude(const TumbleSolution& solution, double largest_output) {
  const TumbleDesign& design = solution.design;
  const auto sine = design.find(TumbleTerm::sine);
  if (!sine || !design.find(TumbleTerm::up_down))
    return Error{Errc::not_observable,
                 "scale factor and bias are not separable: the input axis has to point up in "
                 "one position and down in another"};
  const TumbleRegression& regression = solution.regression;
  const double amplitude = amplitude_of(design, regression.beta);
  const auto k = static_cast<Eigen::Index>(*sine);
  const double std = std::sqrt(regression.noise_covariance(k, k));
  double across = 0.0;  // amplitude of the cosine, large for the other axis in the plane
  for (std::size_t j = 0; j < design.columns.size(); ++j)
    if (design.columns[j].term == TumbleTerm::cosine)
      across = std::max(across, std::abs(regression.beta(static_cast<Eigen::Index>(j))));
  constexpr double least_stds = 5.0, rounding = 1e-12;
  if (std::abs(amplitude) <= std::max({rounding * largest_output, least_stds * std, across}))
    return Error{
        Errc::not_observable,
        fmt::format("the output does not follow sin(angle): its part with the sine is {} ± {}, "
                    "with the cosine {}; is this the input axis, and are the angles those of the "
                    "positions?",
                    compact(amplitude, 3), compact(std, 2), compact(across, 3))};
  return Done{};
}

// A larger value is the output's nominal zero, such as half the supply, not a bias.
constexpr double largest_bias_g = 2.0;

void add_zero_note(const TumbleOptions& options, TumbleFit& fit) {
  const TumbleCoefficient* bias = fit.find(TumbleQuantity::K0_up_down);
  if (options.output_unit == "m/s^2" || bias == nullptr || !bias->value) return;
  if (std::abs(*bias->value) > largest_bias_g * options.gravity_mps2)
    fit.notes.push_back(fmt::format(
        "the bias is counted from an output of 0{}{}: the nominal zero of the sensor is in it",
        options.output_unit.empty() ? "" : " ", options.output_unit));
}

void add_misalignment_note(TumbleFit& fit) {
  constexpr double much_rad = 0.05;
  const double ratio = fit.own_axis_ratio();
  const TumbleCoefficient* scale = fit.find(TumbleQuantity::K1);
  if (scale == nullptr || !scale->value || ratio < std::hypot(1.0, much_rad)) return;
  fit.notes.push_back(
      fmt::format("the axis is {:.1f}° from the nominal one, by the zero of the angles: K1 is the "
                  "component along that; along the axis itself the scale factor is {}",
                  std::acos(1.0 / ratio) / rad_per_deg, compact(ratio * *scale->value, 5)));
}

// A misfit not explained by a single position.
void add_unnamed_note(TumbleFit& fit) {
  constexpr double beyond_chance = 0.01;
  const bool named = std::any_of(fit.positions.begin(), fit.positions.end(),
                                 [](const TumbleResidual& r) { return r.suspect; });
  if (named || !fit.lack_of_fit || fit.lack_of_fit->p >= beyond_chance) return;
  fit.notes.push_back(fmt::format(
      "the residuals are significant (p = {:.2g}): an outlier, the angles of the table or a "
      "drift; {} cannot identify a single position",
      fit.lack_of_fit->p, fit.dof == 1 ? "one residual" : fmt::format("{} residuals", fit.dof)));
}

void add_notes(View<TumblePosition> positions, bool some_noise, TumbleFit& fit) {
  const auto add = [&](std::string note) { fit.notes.push_back(std::move(note)); };
  if (some_noise)
    add("the noise is stated for some positions only: it is ignored, the residuals are used");
  if (fit.scatter > 1.0)
    add(
        fmt::format("the residuals are {:.3g} times what the stated errors explain: the standard "
                    "deviations were increased by that",
                    fit.scatter));
  add_unnamed_note(fit);
  for (std::size_t k = 0; k < fit.positions.size(); ++k) {
    const TumbleResidual& r = fit.positions[k];
    if (r.suspect)
      add(
          fmt::format("{} at {}° contradicts the others by {:.3g} standard deviations: check "
                      "its angle and output; it remains in the fit",
                      named(positions, k), compact(positions[k].angle_rad / rad_per_deg, 4),
                      std::abs(*r.studentised)));
  }
  if (fit.lack_of_fit && fit.lack_of_fit->p < 0.01 && !fit.noise_known)
    add(
        fmt::format("the model does not fit to within the scatter of the repeated positions (F = "
                    "{:.3g}, p = {:.2g})",
                    fit.lack_of_fit->statistic, fit.lack_of_fit->p));
  for (const TumbleCoefficient& c : fit.coefficients) {
    if (c.quantity != TumbleQuantity::third_cosine || !c.value || !c.half_width_95) continue;
    if (std::abs(*c.value) > 1.7 * *c.half_width_95)
      add(
          fmt::format("cos 3φ, which the model does not have, is {} ± {} m/s²: a cubic "
                      "cross-axis term or an indexing error of twice a turn",
                      compact(*c.value, 3), compact(*c.std, 2)));
  }
}

}  // namespace

double TumbleFit::own_axis_ratio() const {
  double squares = 1.0;
  for (const TumbleQuantity quantity :
       {TumbleQuantity::misalignment, TumbleQuantity::misalignment_p})
    if (const TumbleCoefficient* delta = find(quantity); delta != nullptr && delta->value)
      squares += square(*delta->value);
  return std::sqrt(squares);
}

const TumbleCoefficient* TumbleFit::find(TumbleQuantity quantity, int plane) const {
  const auto place = place_of(quantity, plane);
  return place ? &coefficients[*place] : nullptr;
}

std::optional<std::size_t> TumbleFit::place_of(TumbleQuantity quantity, int plane) const {
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    const TumbleCoefficient& c = coefficients[k];
    if (c.quantity == quantity && (plane == 0 || c.plane == plane)) return k;
  }
  return std::nullopt;
}

Result<TumbleFit> fit_tumble(View<TumblePosition> positions, const TumbleOptions& options) {
  if (const Status good = check(positions, options); !good) return good.error();
  const auto stated = static_cast<std::size_t>(
      std::count_if(positions.begin(), positions.end(),
                    [](const TumblePosition& p) { return p.output_std > 0.0; }));
  TumbleFit fit;
  fit.noise_known = stated == positions.size();
  const TumbleDesign design = design_tumble(positions, options.phase_rad, fit.noise_known);
  const auto n = static_cast<Eigen::Index>(positions.size());
  Eigen::VectorXd outputs(n);
  for (Eigen::Index k = 0; k < n; ++k) outputs(k) = positions[static_cast<std::size_t>(k)].output;
  const double largest = outputs.cwiseAbs().maxCoeff(), offset = outputs.mean();
  outputs.array() -= offset;
  const TumbleRegression regression =
      regress(design, outputs, errors_of(positions, options, design, fit.noise_known), options);
  const TumbleSolution solution{design, regression, options, offset, outputs};
  if (const Status seen = check_amplitude(solution, largest); !seen) return seen.error();
  fit.parameters = design.columns.size();
  fit.dof = positions.size() - fit.parameters;
  fit.residual_rms = std::sqrt(regression.rss / static_cast<double>(n));
  if (fit.dof > 0) fit.residual_std = std::sqrt(regression.rss / static_cast<double>(fit.dof));
  if (fit.noise_known) fit.scatter = regression.sigma;
  find_coefficients(solution, fit);
  find_residuals(solution, positions, fit);
  fit.lack_of_fit = find_lack_of_fit(solution, positions, outputs);
  fit.drift = find_drift(solution, positions, fit);
  fit.indexing = indexing_words(solution, fit);
  add_assumptions(solution, fit);
  add_notes(positions, stated > 0 && !fit.noise_known, fit);
  add_zero_note(options, fit);
  add_misalignment_note(fit);
  return fit;
}

}  // namespace proofmass::calibrate

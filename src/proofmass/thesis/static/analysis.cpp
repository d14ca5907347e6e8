#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "proofmass/core/in_parallel.hpp"
#include "proofmass/fit/nonlinear_least_squares.hpp"
#include "proofmass/thesis/means.hpp"
#include "proofmass/thesis/static/bias_tracks.hpp"
#include "proofmass/thesis/static_bias.hpp"

namespace proofmass::thesis {
namespace {

using characterise::DriftAnalysis;
using Series = std::vector<double>;

/// Samples with their times.
struct Picked {
  double rate_hz;
  double start_s;  ///< since power-on
  View<double> values_mps2;
  [[nodiscard]] double t_s(std::size_t k) const {
    return start_s + static_cast<double>(k) / rate_hz;
  }
};

Picked picked_of(const StaticRecord& record, const StaticAxis& axis) {
  if (axis.picked_mps2.empty()) return {record.rate_hz, record.since_switch_on_s, axis.accel_mps2};
  const auto behind_each = static_cast<double>(record.decimation);
  const double middle_s = 0.5 * (behind_each - 1.0) / (record.rate_hz * behind_each);
  return {record.rate_hz, record.since_switch_on_s - middle_s, axis.picked_mps2};
}

double curve_at(double t_s, View<double> p) {  // a1, a2, T
  return p[1] - p[0] * std::expm1(-t_s / p[2]);
}

// The samples that are there.
struct Points {
  Series t_s, y_mps2;
};

Points points_of(const Picked& picked) {
  Points points;
  for (std::size_t k = 0; k < picked.values_mps2.size(); ++k) {
    if (!std::isfinite(picked.values_mps2[k])) continue;
    points.t_s.push_back(picked.t_s(k));
    points.y_mps2.push_back(picked.values_mps2[k]);
  }
  return points;
}

fit::LeastSquaresProblem problem_of(const Points& points, const DriftAnalysis& drift) {
  const Series& t_s = points.t_s;
  const double first = drift.block_bias.front(), last = drift.block_bias.back();
  return {.residuals =
              [&](View<double> p, std::span<double> r) {
                for (std::size_t k = 0; k < r.size(); ++k)
                  r[k] = curve_at(t_s[k], p) - points.y_mps2[k];
              },
          .residual_count = t_s.size(),
          .start = {last - first, first, drift.fit.best_time_constant_s},
          .lower = {-HUGE_VAL, -HUGE_VAL, 1.0 / drift.rate_hz},
          .upper = {HUGE_VAL, HUGE_VAL, 100.0 * drift.duration_s},
          .jacobian =
              [&](View<double> p, Eigen::Ref<Eigen::MatrixXd> J) {
                for (std::size_t k = 0; k < t_s.size(); ++k) {
                  const double decay = std::exp(-t_s[k] / p[2]);
                  const auto row = static_cast<Eigen::Index>(k);
                  J(row, 0) = 1.0 - decay;
                  J(row, 1) = 1.0;
                  J(row, 2) = -p[0] * decay * t_s[k] / (p[2] * p[2]);
                }
              }};
}

Series residuals_of(const Picked& picked, View<double> p) {
  Series residuals(picked.values_mps2.begin(), picked.values_mps2.end());
  for (std::size_t k = 0; k < residuals.size(); ++k) residuals[k] -= curve_at(picked.t_s(k), p);
  return residuals;
}

std::optional<signal::WhitenessTest> whiteness_of(const Series& residuals, double rate_hz) {
  const auto test = signal::test_whiteness(
      residuals, {.rate_hz = rate_hz, .scale_s = 1.0 / rate_hz, .fitted_parameters = 3});
  return test ? std::optional(*test) : std::nullopt;
}

std::optional<PlainFit> plain_fit(const Picked& picked, const DriftAnalysis& drift) {
  constexpr std::size_t few = 2000;
  const Points points = points_of(picked);
  auto problem = problem_of(points, drift);
  problem.start[2] = std::clamp(problem.start[2], problem.lower[2], problem.upper[2]);
  const auto fit = fit::fit_least_squares(problem, {.search_again = false});
  if (!fit || !fit->converged || fit->at_bound[2]) return std::nullopt;
  const auto figure = [&](std::size_t i) { return Uncertain{fit->parameters[i], fit->std[i]}; };
  const Series residuals = residuals_of(picked, fit->parameters);
  const std::size_t stride = std::max<std::size_t>(1, residuals.size() / few);
  Series thinned;
  for (std::size_t k = 0; k < residuals.size(); k += stride) thinned.push_back(residuals[k]);
  return PlainFit{
      .a1_mps2 = figure(0),
      .a2_mps2 = figure(1),
      .time_constant_s = figure(2),
      .residuals = whiteness_of(residuals, picked.rate_hz),
      .few_residuals = whiteness_of(thinned, picked.rate_hz / static_cast<double>(stride))};
}

AxisTest analyse_axis(const StaticRecord& record,
                      const StaticAxis& axis,
                      const Progress& report_progress) {
  AxisTest test;
  auto drift =
      characterise::analyse_drift(axis.accel_mps2, {.rate_hz = record.rate_hz,
                                                    .since_switch_on_s = record.since_switch_on_s,
                                                    .progress = report_progress});
  if (!drift) {
    test.refused = drift.error();
    return test;
  }
  test.drift = std::move(drift).value();
  test.plain = plain_fit(picked_of(record, axis), *test.drift);
  test.tracks = bias_tracks(record, axis, *test.drift, test.plain);
  return test;
}

Series residuals_about(const characterise::DriftCurve& curve, const Picked& samples) {
  Series residuals(samples.values_mps2.begin(), samples.values_mps2.end());
  for (std::size_t k = 0; k < residuals.size(); ++k) residuals[k] -= curve.value(samples.t_s(k));
  return residuals;
}

std::optional<characterise::NoiseAnalysis> noise_of(View<double> residuals, double rate_hz) {
  auto noise = characterise::analyse_noise(residuals, {.rate_hz = rate_hz});
  if (!noise) return std::nullopt;
  return std::move(noise).value();
}

DecimationNoise decimation_noise(const StaticRecord& record,
                                 const StaticAxis& axis,
                                 const DriftAnalysis& drift) {
  DecimationNoise noise;
  const auto& curve = drift.fit.curve;
  const Series means =
      residuals_about(curve, {record.rate_hz, record.since_switch_on_s, axis.accel_mps2});
  noise.means = noise_of(means, record.rate_hz);
  const auto in_a_second = static_cast<std::size_t>(std::max(1.0, std::round(record.rate_hz)));
  noise.slow =
      noise_of(means_over(means, in_a_second), record.rate_hz / static_cast<double>(in_a_second));
  if (!noise.slow || noise.slow->model.ordinates == 0) noise.slow = noise.means;  // a short record
  if (!axis.picked_mps2.empty())
    noise.picked = noise_of(residuals_about(curve, picked_of(record, axis)), record.rate_hz);
  return noise;
}

}  // namespace

Result<StaticTest> analyse_static(StaticRecord record, const Progress& progress) {
  if (record.axes.empty())
    return Error{Errc::too_few_samples, "no axis was recorded"}.at(record.source);
  StaticTest test{.record = std::move(record), .axes = {}, .noise = {}};
  const std::vector<StaticAxis>& axes = test.record.axes;
  test.axes.resize(axes.size());
  in_parallel(axes.size(), progress, [&](std::size_t k, const Progress& report_progress) {
    test.axes[k] = analyse_axis(test.record, axes[k], report_progress);
  });
  const auto known =
      std::ranges::find_if(test.axes, [](const AxisTest& axis) { return axis.drift.has_value(); });
  if (known == test.axes.end())
    return test.axes.front().refused->at(axes.front().name).at(test.record.source);
  const auto first = static_cast<std::size_t>(known - test.axes.begin());
  test.noise = decimation_noise(test.record, axes[first], *known->drift);
  return test;
}

}  // namespace proofmass::thesis

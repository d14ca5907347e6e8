#include "proofmass/calibrate/supply.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/core/chi_square.hpp"
#include "proofmass/core/contract.hpp"
#include "proofmass/core/number_words.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double rounding = 1e-12;

struct LinePoint {
  double x, y, x_std, y_std;
};

struct Sums {
  double weight = 0.0, x0 = 0.0, y0 = 0.0, xx = 0.0, xy = 0.0;
};

Sums sums_of(const std::vector<LinePoint>& points, const std::vector<double>& weights) {
  Sums s;
  for (std::size_t k = 0; k < points.size(); ++k) s.weight += weights[k];
  for (std::size_t k = 0; k < points.size(); ++k) {
    s.x0 += weights[k] * points[k].x / s.weight;
    s.y0 += weights[k] * points[k].y / s.weight;
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    s.xx += weights[k] * (points[k].x - s.x0) * (points[k].x - s.x0);
    s.xy += weights[k] * (points[k].x - s.x0) * (points[k].y - s.y0);
  }
  return s;
}

// Weights depend on the slope, through the uncertainty of x: a few iterations suffice.
SupplyLine fitted(const std::vector<LinePoint>& points) {
  constexpr int rounds = 5;
  const bool stated = std::ranges::all_of(
      points, [](const LinePoint& p) { return p.y_std > 0.0 || p.x_std > 0.0; });
  std::vector<double> weights(points.size(), 1.0);
  Sums s = sums_of(points, weights);
  for (int round = 0; stated && round < rounds; ++round) {
    const double slope = s.xy / s.xx;
    for (std::size_t k = 0; k < points.size(); ++k)
      weights[k] =
          1.0 / std::max(std::pow(points[k].y_std, 2) + std::pow(slope * points[k].x_std, 2),
                         std::pow(rounding * (std::abs(points[k].y) + rounding), 2));
    s = sums_of(points, weights);
  }
  SupplyLine line{.x0 = s.x0, .level = {s.y0, 0.0}, .slope = {s.xy / s.xx, 0.0}, .misfit_p = {}};
  double rss = 0.0, size = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double residual = points[k].y - s.y0 - line.slope.value * (points[k].x - s.x0);
    rss += weights[k] * residual * residual;
    size = std::max(size, std::abs(points[k].y));
  }
  const auto dof = static_cast<double>(points.size()) - 2.0;
  if (stated && dof > 0.0) line.misfit_p = chi_square_p(rss, dof);
  const bool by_residuals = !stated || (line.misfit_p && *line.misfit_p < 0.05);
  line.std_known = !by_residuals || dof > 0.0;
  if (!line.std_known) return line;
  if (by_residuals) line.dof = dof;
  const double factor = by_residuals ? rss / dof : 1.0;
  // Residuals of exact numbers are rounding, which does not imply certainty.
  const double least = rounding * (size + rounding);
  const double n = static_cast<double>(points.size());
  line.level.std = std::max(std::sqrt(factor / s.weight), least / std::sqrt(n));
  line.slope.std = std::max(std::sqrt(factor / s.xx), least / std::sqrt(s.xx * n / s.weight));
  return line;
}

Uncertain at(const SupplyLine& line, double x) {
  const double away = x - line.x0;
  return {line.level.value + line.slope.value * away,
          std::hypot(line.level.std, line.slope.std * away)};
}

std::optional<double> p_of(double departure, double std, const SupplyLine& line) {
  if (!line.std_known || !(std > 0.0)) return std::nullopt;
  const double t = departure / std;
  return line.dof > 0.0 ? student_t_p(t, line.dof) : chi_square_p(t * t, 1.0);
}

// As many decimals as the first two digits of the standard deviation need.
std::string figure(double value, double std, bool known, double factor) {
  value *= factor;
  std *= factor;
  if (!known || !(std > 0.0)) return compact(value, 4);
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(std))), 0, 6);
  return fmt::format("{} ± {}", fixed(value, decimals), fixed(std, decimals));
}

std::string words_of(const SupplyAxis& axis, char name, const std::string& reading_unit) {
  const bool volts = reading_unit == "V";
  const std::string unit = volts ? "mV/V" : reading_unit + "/V";
  const double factor = volts ? 1e3 : 1.0;
  const std::string facts =
      fmt::format("scale as V^{}, zero moves {} {} where {} {} {} expected",
                  figure(axis.exponent.value, axis.exponent.std, axis.log_scale.std_known, 1.0),
                  figure(axis.fraction.value, axis.fraction.std, axis.zero.std_known, factor), unit,
                  compact(factor * axis.expected_fraction, 4), unit, volts ? "was" : "were");
  if (!axis.ratiometric)
    return fmt::format("{}: {}; whether it follows its supply is undetermined", name, facts);
  if (*axis.ratiometric) return fmt::format("{} follows its supply: {}", name, facts);
  const auto still = [](const Uncertain& slope, const SupplyLine& line) {
    const auto p = p_of(slope.value, slope.std, line);
    return p && *p >= 0.025;
  };
  if (still(axis.exponent, axis.log_scale) && still(axis.fraction, axis.zero))
    return fmt::format("{} does not move with its supply: {}", name, facts);
  const bool scale_wrong = *axis.scale_p < 0.025, zero_wrong = *axis.zero_p < 0.025;
  return fmt::format("{}'s {} not follow its supply: {}", name,
                     scale_wrong && zero_wrong ? "scale and zero do"
                     : scale_wrong             ? "scale does"
                                               : "zero does",
                     facts);
}

SupplyAxis axis_of(const std::vector<LinePoint>& scales,
                   const std::vector<LinePoint>& zeros,
                   double sign,
                   double reference_v) {
  SupplyAxis axis;
  axis.sign = sign;
  axis.log_scale = fitted(scales);
  axis.zero = fitted(zeros);
  const Uncertain log_ref = at(axis.log_scale, std::log(reference_v));
  const double scale = sign * std::exp(log_ref.value);
  axis.scale_ref = {scale, std::abs(scale) * log_ref.std};
  axis.exponent = axis.log_scale.slope;
  axis.zero_ref = at(axis.zero, reference_v);
  axis.fraction = axis.zero.slope;
  axis.constant = at(axis.zero, 0.0);
  axis.expected_fraction = axis.zero_ref.value / reference_v;
  axis.scale_p = p_of(axis.exponent.value - 1.0, axis.exponent.std, axis.log_scale);
  axis.zero_p = p_of(axis.constant.value, axis.constant.std, axis.zero);
  constexpr double each_of_two = 0.025;
  if (axis.scale_p && axis.zero_p)
    axis.ratiometric = *axis.scale_p >= each_of_two && *axis.zero_p >= each_of_two;
  return axis;
}

bool finite(const Uncertain& figure) {
  return std::isfinite(figure.value) && std::isfinite(figure.std) && figure.std >= 0.0;
}

Status check_points(View<SupplyPoint> points, const SupplyOptions& options) {
  if (points.size() < 2)
    return Error{Errc::too_few_samples,
                 "what the supply does takes calibrations at two supplies or more"};
  if (options.reference_v && !(*options.reference_v > 0.0 && std::isfinite(*options.reference_v)))
    return Error{Errc::invalid_argument, "expected a reference supply above 0 V"};
  for (const SupplyPoint& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if ((point.bias[axis] && !finite(*point.bias[axis])) ||
          (point.scale[axis] && !finite(*point.scale[axis])))
        return Error{Errc::not_finite, "a bias or scale is not a finite number"};
    if (!finite(point.supply_v)) return Error{Errc::not_finite, "a supply is not a finite number"};
    if (point.supply_v.value <= 0.0)
      return Error{Errc::invalid_argument,
                   fmt::format("expected supplies above 0 V, not {} V", point.supply_v.value)};
  }
  return Done{};
}

// nullopt if the axis was not calibrated twice.
Result<std::optional<SupplyAxis>> find_axis(View<SupplyPoint> points,
                                            std::size_t axis,
                                            double reference_v) {
  std::vector<LinePoint> scales, zeros;
  double sign = 0.0;
  for (const SupplyPoint& point : points) {
    if (!point.bias[axis] || !point.scale[axis]) continue;
    const auto& [V, V_std] = point.supply_v;
    const Uncertain& scale = *point.scale[axis];
    const double its_sign = scale.value > 0.0 ? 1.0 : -1.0;
    if (scale.value == 0.0 || (sign != 0.0 && sign != its_sign))
      return Error{Errc::invalid_argument,
                   fmt::format("{}: its scale is 0 or changes sign with the supply", "xyz"[axis])};
    sign = its_sign;
    scales.push_back({std::log(V), std::log(std::abs(scale.value)), V_std / V,
                      scale.std / std::abs(scale.value)});
    zeros.push_back({V, point.bias[axis]->value, V_std, point.bias[axis]->std});
  }
  const auto by_x = [](const LinePoint& a, const LinePoint& b) { return a.x < b.x; };
  if (zeros.size() < 2) return std::optional<SupplyAxis>();
  const auto [low, high] = std::ranges::minmax_element(zeros, by_x);
  if (high->x - low->x <= 3.0 * std::hypot(low->x_std, high->x_std))
    return Error{Errc::not_observable,
                 fmt::format("{}: its supplies differ by {:.3g} V, which is within their "
                             "uncertainty: use supplies further apart",
                             "xyz"[axis], high -> x - low -> x)};
  return std::optional(axis_of(scales, zeros, sign, reference_v));
}

void add_notes(View<SupplyPoint> points, SupplyDependence& found) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char name = "xyz"[axis];
    if (!found.axes[axis]) {
      found.notes.push_back(fmt::format("{}: it was not calibrated at two supplies", name));
      continue;
    }
    for (const SupplyLine* line : {&found.axes[axis]->log_scale, &found.axes[axis]->zero})
      if (line->misfit_p && *line->misfit_p < 0.05)
        found.notes.push_back(
            fmt::format("{}: its {} deviates from the line by more than its uncertainty explains "
                        "(p = {:.2g}): the "
                        "uncertainties are derived from the residuals",
                        name, line == &found.axes[axis]->zero ? "zero" : "scale", *line->misfit_p));
  }
  if (points.size() == 2)
    found.notes.push_back(
        "two supplies leave no redundancy: a line passes through any two points, so linearity is "
        "not tested; add a third supply in between");
}

}  // namespace

Result<SupplyDependence> fit_supply(View<SupplyPoint> points, const SupplyOptions& options) {
  if (const Status good = check_points(points, options); !good) return good.error();
  SupplyDependence found;
  found.lowest_v = found.highest_v = points[0].supply_v.value;
  double sum = 0.0;
  for (const SupplyPoint& point : points) {
    found.lowest_v = std::min(found.lowest_v, point.supply_v.value);
    found.highest_v = std::max(found.highest_v, point.supply_v.value);
    sum += point.supply_v.value;
  }
  found.reference_v = options.reference_v.value_or(sum / static_cast<double>(points.size()));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto one = find_axis(points, axis, found.reference_v);
    if (!one) return one.error();
    found.axes[axis] = *one;
    if (*one) found.axes[axis]->words = words_of(**one, "xyz"[axis], options.reading_unit);
  }
  add_notes(points, found);
  return found;
}

AtSupply at_supply(const SupplyDependence& found, std::size_t axis, double supply_v) {
  PM_EXPECTS(axis < 3);
  AtSupply out;
  if (!found.axes[axis]) {
    out.reason = fmt::format("{} was not calibrated at two supplies", "xyz"[axis]);
    return out;
  }
  const double slack = rounding * found.highest_v;
  if (!(supply_v >= found.lowest_v - slack && supply_v <= found.highest_v + slack)) {
    out.reason =
        fmt::format("{} V is outside the supplies of the calibrations, {:.4g} V to {:.4g} V",
                    compact(supply_v, 4), found.lowest_v, found.highest_v);
    return out;
  }
  const SupplyAxis& it = *found.axes[axis];
  const Uncertain log_scale = at(it.log_scale, std::log(supply_v));
  const double scale = it.sign * std::exp(log_scale.value);
  out.scale = Uncertain{scale, std::abs(scale) * log_scale.std};
  out.bias = at(it.zero, supply_v);
  if (!it.log_scale.std_known || !it.zero.std_known)
    out.reason = "two calibrations without uncertainties do not determine its uncertainty";
  return out;
}

}  // namespace proofmass::calibrate

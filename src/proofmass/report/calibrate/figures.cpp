#include "proofmass/report/calibrate/figures.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/report/calibrate/wording.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using calibrate::PoseResidual;

double place(std::size_t k) {
  return static_cast<double>(k + 1);
}

// Stepped, since the durations of the means may differ from position to position.
Band noise_band(const CalibrateReport& report) {
  Band band{.label = "± 2 standard deviations of the noise",
            .x = {},
            .lower = {},
            .upper = {},
            .ink = Ink::grey};
  for (std::size_t k = 0; k < report.fit.poses.size(); ++k) {
    const double half = 2.0 * report.fit.poses[k].predicted_std_mps2 / mg;
    if (!(half > 0.0)) continue;
    for (const double side : {-0.5, 0.5}) {
      band.x.push_back(place(k) + side);
      band.upper.push_back(half);
      band.lower.push_back(-half);
    }
  }
  return band;
}

// Half height of the plot, from the positions that are not suspect.
double reach(const CalibrateReport& report) {
  double most = 0.0;
  for (const PoseResidual& pose : report.fit.poses) {
    if (pose.suspect) continue;
    most =
        std::max({most, std::abs(pose.residual_mps2),
                  std::abs(pose.leave_one_out_mps2.value_or(0.0)), 2.0 * pose.predicted_std_mps2});
  }
  return most > 0.0 ? 1.15 * most / mg : 1.0;
}

// Two discs side by side: directions with +z up on the left, those with −z up on the right, each
// seen along −z with x to the right and y upwards. Equal areas: r = √(1 − |z|).
// Source: J. P. Snyder, Map Projections: A Working Manual, USGS Professional Paper 1395 (1987), 24.
constexpr double disc_center = 1.21;

struct MapPlace {
  double x, y;
};

MapPlace map_place(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d u = direction.normalized();
  const double flat = std::hypot(u.x(), u.y());
  const double r = flat > 0.0 ? std::sqrt(std::max(0.0, 1.0 - std::abs(u.z()))) / flat : 0.0;
  return {(u.z() < 0.0 ? disc_center : -disc_center) + r * u.x(), r * u.y()};
}

void add_point(const Eigen::Vector3d& up, Curve& curve) {
  const auto [x, y] = map_place(up);
  curve.x.push_back(x);
  curve.y.push_back(y);
}

// Circles at this angle from the z axis, one in each disc.
void add_circles(double from_z_deg, Mark mark, Figure& figure) {
  const double r = std::sqrt(1.0 - std::cos(from_z_deg * rad_per_deg));
  for (const double center : {-disc_center, disc_center}) {
    Curve circle{.label = {}, .x = {}, .y = {}, .ink = Ink::grey, .mark = mark};
    for (int angle = 0; angle <= 360; angle += 4) {
      circle.x.push_back(center + r * std::cos(angle * rad_per_deg));
      circle.y.push_back(r * std::sin(angle * rad_per_deg));
    }
    figure.curves.push_back(std::move(circle));
  }
}

void add_axis_names(Figure& figure) {
  constexpr double outside = 1.1;
  const auto add = [&](const char* text, double x, double y) {
    figure.callouts.push_back({.text = text, .x = x, .y = y, .bare = true});
  };
  for (const double center : {-disc_center, disc_center}) {
    add("+x", center + outside, 0.0);
    add("−x", center - outside, 0.0);
    add("+y", center, outside);
    add("−y", center, -outside);
    add(center < 0.0 ? "+z up" : "−z up", center - 0.85, outside - 0.25);
  }
}

constexpr Ink axis_inks[] = {Ink::blue, Ink::orange, Ink::green};
constexpr const char* axis_names[] = {"x", "y", "z"};

// One axis: its calibrations as points, and the fitted line.
template <class Point, class Line>
void add_axis(const CalibrateReport& report,
              std::size_t axis,
              const Point& point,
              const Line& line,
              Figure& figure) {
  Curve points{
      .label = axis_names[axis], .x = {}, .y = {}, .ink = axis_inks[axis], .mark = Mark::points};
  for (const SuppliedFit& one : report.supplies) {
    const std::optional<double> value = point(one);
    if (!value) continue;
    points.x.push_back(one.supply_v);
    points.y.push_back(*value);
  }
  Curve curve{.label = {}, .x = {}, .y = {}, .ink = axis_inks[axis], .mark = Mark::line};
  constexpr int steps = 40;
  const calibrate::SupplyDependence& found = *report.supply;
  for (int k = 0; k <= steps; ++k) {
    const double v = found.lowest_v + (found.highest_v - found.lowest_v) * k / steps;
    const std::optional<double> value = line(calibrate::at_supply(found, axis, v));
    if (!value) continue;
    curve.x.push_back(v);
    curve.y.push_back(*value);
  }
  figure.curves.push_back(std::move(curve));
  figure.curves.push_back(std::move(points));
}

}  // namespace

Figure residual_figure(const CalibrateReport& report) {
  const std::size_t n = report.fit.poses.size();
  const double limit = reach(report);
  Figure figure{.title = "Residual of each position",
                .description =
                    "Norm of the calibrated force less gravity: residuals of the fit, and "
                    "leave-one-out residuals.",
                .x = {.label = "Position", .min = 0.5, .max = static_cast<double>(n) + 0.5},
                .y = {.label = "Residual (mg)", .min = -limit, .max = limit},
                .levels = {{"", 0.0}}};
  if (Band band = noise_band(report); !band.x.empty()) figure.bands.push_back(std::move(band));
  Curve others{
      .label = "leave-one-out", .x = {}, .y = {}, .ink = Ink::orange, .mark = Mark::points};
  Curve own{.label = "residual", .x = {}, .y = {}, .ink = Ink::blue, .mark = Mark::points};
  for (std::size_t k = 0; k < n; ++k) {
    const PoseResidual& pose = report.fit.poses[k];
    if (pose.suspect) {
      const double off = pose.leave_one_out_mps2.value_or(pose.residual_mps2) / mg;
      figure.callouts.push_back({.text = fmt::format("{}: {}", k + 1, mg_words(off * mg)),
                                 .x = place(k),
                                 .y = std::clamp(off, -0.93 * limit, 0.93 * limit),
                                 .ink = Ink::red,
                                 .below = off > 0.0,
                                 .left = k > n / 2});
      continue;
    }
    own.x.push_back(place(k));
    own.y.push_back(pose.residual_mps2 / mg);
    if (!pose.leave_one_out_mps2) continue;
    others.x.push_back(place(k));
    others.y.push_back(*pose.leave_one_out_mps2 / mg);
  }
  for (const std::size_t k : report.fit.doubtful) {
    figure.callouts.push_back({.text = fmt::format("{}?", k + 1),
                               .x = place(k),
                               .y = report.fit.poses[k].residual_mps2 / mg,
                               .ink = Ink::red});
  }
  if (!others.x.empty()) figure.curves.push_back(std::move(others));
  figure.curves.push_back(std::move(own));
  return figure;
}

Figure direction_figure(const CalibrateReport& report) {
  Figure figure{.title = "Upward directions in the sensor's axes",
                .description =
                    "Left: +z up, right: −z up, in an equal-area projection. The rim is z "
                    "horizontal, the inner circle 45° from z.",
                .x = {.label = "", .scale = AxisScale::bare, .min = -2.45, .max = 2.45},
                .y = {.label = "", .scale = AxisScale::bare, .min = -1.2, .max = 1.2},
                .height = 396.0};
  add_circles(90.0, Mark::line, figure);
  add_circles(45.0, Mark::thin, figure);
  add_axis_names(figure);
  Curve used{.label = "positions", .x = {}, .y = {}, .ink = Ink::blue, .mark = Mark::points};
  Curve bad{
      .label = "contradict the others", .x = {}, .y = {}, .ink = Ink::red, .mark = Mark::points};
  for (const PoseResidual& pose : report.fit.poses)
    if (pose.force_mps2.norm() > 0.0) add_point(pose.force_mps2, pose.suspect ? bad : used);
  figure.curves.push_back(std::move(used));
  if (!bad.x.empty()) figure.curves.push_back(std::move(bad));
  if (!report.fit.next_pose || !stds_known(report)) return figure;
  const auto [x, y] = map_place(report.fit.next_pose->up);
  figure.callouts.push_back(
      {.text = "next position", .x = x, .y = y, .ink = Ink::orange, .below = true});
  return figure;
}

Figure supply_bias_figure(const CalibrateReport& report) {
  const bool voltage = report.unit.quantity == Quantity::voltage;
  const double factor = voltage ? 1e3 : 1.0;
  Figure bias{.title = "Bias against the supply",
              .description =
                  "Change from the bias at the reference supply: each calibration, and "
                  "the line fitted to them.",
              .x = {.label = "Supply (V)"},
              .y = {.label = fmt::format("Change of bias ({})",
                                         voltage ? "mV" : print_unit(report.unit.symbol))}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<calibrate::SupplyAxis>& found = report.supply->axes[axis];
    if (!found) continue;
    const auto change = [&](const std::optional<Uncertain>& figure) {
      return figure ? std::optional(factor * (figure->value - found->zero_ref.value))
                    : std::nullopt;
    };
    add_axis(
        report, axis, [&](const SuppliedFit& one) { return change(one.fit.bias[axis]); },
        [&](const calibrate::AtSupply& at) { return change(at.bias); }, bias);
  }
  return bias;
}

Figure supply_scale_figure(const CalibrateReport& report) {
  Figure scale{.title = "Scale against the supply",
               .description =
                   "Change from the scale at the reference supply: each calibration, "
                   "and the power of the supply fitted to them.",
               .x = {.label = "Supply (V)"},
               .y = {.label = "Change of scale (%)"}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<calibrate::SupplyAxis>& found = report.supply->axes[axis];
    if (!found) continue;
    const auto change = [&](const std::optional<Uncertain>& figure) {
      return figure ? std::optional(100.0 * (figure->value / found->scale_ref.value - 1.0))
                    : std::nullopt;
    };
    add_axis(
        report, axis, [&](const SuppliedFit& one) { return change(one.fit.scale[axis]); },
        [&](const calibrate::AtSupply& at) { return change(at.scale); }, scale);
  }
  return scale;
}

}  // namespace proofmass::report

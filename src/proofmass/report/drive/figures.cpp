#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "proofmass/core/units.hpp"
#include "proofmass/report/drive/report.hpp"

namespace proofmass::report {
namespace {

using estimate::DriveSeries;

constexpr std::size_t drawn_points = 1500, drawn_ellipses = 12, ellipse_points = 48;
constexpr double plot_width = 808.0;  // of the plot's box, of 900 units with its margins
constexpr double least_height = 180.0, most_height = 760.0;
constexpr double chi2_2_95 = 5.991464547;  // 95 % quantile, two degrees of freedom

// The 95 % ellipse about a point of the path, from the covariance's principal axes.
Curve ellipse(const DriveSeries& series, std::size_t k) {
  const double a = series.x_std_m[k] * series.x_std_m[k];
  const double b = series.y_std_m[k] * series.y_std_m[k], c = series.xy_cov_m2[k];
  const double middle = 0.5 * (a + b), half = std::hypot(0.5 * (a - b), c);
  const double turn = 0.5 * std::atan2(2.0 * c, a - b);
  const double major = std::sqrt(chi2_2_95 * std::max(0.0, middle + half));
  const double minor = std::sqrt(chi2_2_95 * std::max(0.0, middle - half));
  Curve curve{.label = {}, .x = {}, .y = {}, .ink = Ink::orange, .mark = Mark::thin};
  for (std::size_t i = 0; i <= ellipse_points; ++i) {
    const double t = 2.0 * std::numbers::pi * static_cast<double>(i) / ellipse_points;
    const double u = major * std::cos(t), v = minor * std::sin(t);
    curve.x.push_back(series.x_m[k] + u * std::cos(turn) - v * std::sin(turn));
    curve.y.push_back(series.y_m[k] + u * std::sin(turn) + v * std::cos(turn));
  }
  return curve;
}

struct Limits {
  double low = INFINITY, high = -INFINITY;
  void hold(const std::vector<double>& values) {
    for (const double value : values) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  [[nodiscard]] double size() const { return high - low; }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

// Axes on which a metre is as long along x as along y.
void draw_to_scale(Figure& figure) {
  Limits x, y;
  for (const Curve& curve : figure.curves) {
    x.hold(curve.x);
    y.hold(curve.y);
  }
  if (!(x.high >= x.low)) return;
  const double wide_m = std::max({1.1 * x.size(), 1e-3, 1.1 * y.size() * plot_width / most_height});
  const double high_m = std::max(1.1 * y.size(), wide_m * least_height / plot_width);
  figure.height = plot_width * high_m / wide_m;
  figure.x.min = x.middle() - 0.5 * wide_m;
  figure.x.max = x.middle() + 0.5 * wide_m;
  figure.y.min = y.middle() - 0.5 * high_m;
  figure.y.max = y.middle() + 0.5 * high_m;
}

std::vector<double> moved(const std::vector<double>& values,
                          const std::vector<double>& deviations,
                          double deviation_factor,
                          double factor) {
  std::vector<double> out(values.size());
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = factor * (values[k] + deviation_factor * deviations[k]);
  return out;
}

Figure against_time(Figure figure,
                    const std::vector<double>& time_s,
                    const std::vector<double>& values,
                    const std::vector<double>& deviations,
                    double factor) {
  figure.x = {.label = "Time (s)"};
  figure.bands = {{"95 % band", time_s, moved(values, deviations, -normal_95, factor),
                   moved(values, deviations, normal_95, factor)}};
  figure.curves = {{"smoother", time_s, moved(values, deviations, 0.0, factor)}};
  return figure;
}

}  // namespace

Figure path_figure(const estimate::DriveSolution& solution) {
  const DriveSeries& series = solution.series;
  const bool east = solution.has_fixes;
  Figure figure{
      .title = "The path to scale",
      .description =
          "The path of the reference point seen from above, from the start at the origin, "
          "with 95 % ellipses of the position relative to the start.",
      .x = {.label = east ? "East (m)" : "Ahead at the start (m)"},
      .y = {.label = east ? "North (m)" : "To the left at the start (m)"}};
  Curve path{.label = "path", .x = {}, .y = {}};
  const std::size_t n = series.x_m.size();
  const std::size_t stride = std::max<std::size_t>(1, n / drawn_points);
  for (std::size_t k = 0; k < n; k += stride) {
    path.x.push_back(series.x_m[k]);
    path.y.push_back(series.y_m[k]);
  }
  // Ellipses at equal parts of the distance.
  double next_m = 0.0;
  const double part_m = n > 0 ? series.distance_m.back() / drawn_ellipses : 0.0;
  for (std::size_t k = 0; k < n && part_m > 0.0; ++k) {
    if (series.distance_m[k] < next_m && k + 1 < n) continue;
    figure.curves.push_back(ellipse(series, k));
    next_m = series.distance_m[k] + part_m;
  }
  if (!figure.curves.empty()) figure.curves.front().label = "95 % ellipse";
  if (n > 0) {
    path.x.push_back(series.x_m.back());
    path.y.push_back(series.y_m.back());
    figure.callouts = {{.text = "start", .x = series.x_m.front(), .y = series.y_m.front()},
                       {.text = "end", .x = series.x_m.back(), .y = series.y_m.back()}};
  }
  figure.curves.push_back(std::move(path));
  draw_to_scale(figure);
  return figure;
}

Figure heading_figure(const estimate::DriveSolution& solution) {
  const DriveSeries& series = solution.series;
  return against_time(
      {.title = "Heading",
       .description = solution.has_fixes ? "Heading from east, counter-clockwise."
                                         : "Heading relative to the start, a left turn positive.",
       .x = {},
       .y = {.label = "Heading (°)"}},
      series.time_s, series.heading_rad, series.heading_std_rad, deg_per_rad);
}

Figure drive_speed_figure(const estimate::DriveSolution& solution) {
  const DriveSeries& series = solution.series;
  return against_time({.title = "Speed",
                       .description = "Speed of the reference point, negative in reverse.",
                       .x = {},
                       .y = {.label = "Speed (m/s)"}},
                      series.time_s, series.speed_mps, series.speed_std_mps, 1.0);
}

}  // namespace proofmass::report
